#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"
#include "scenes/shape/parameters.h"

namespace cscd::scenes {

// The weights with which at most four bones move a vertex. Weights are not negative and sum to 1, or are all
// 0 without bones. Unused places come last and have bone -1 and weight 0.
struct JointWeights {
  static constexpr std::size_t most = 4;
  std::array<BoneId, most> bone{BoneId{-1}, BoneId{-1}, BoneId{-1}, BoneId{-1}};
  std::array<double, most> weight{};

  bool has_bones() const { return bone[0] != BoneId{-1}; }
};

// A character at rest: a consistently oriented surface with its skeleton. The surface of a shape with bones
// is closed and faces outward, except for cloth that the character wears. Skinning leaves the vertices of
// such cloth alone, as far as they have empty weights. A shape without bones has empty weights, and its
// surface may have a border.
struct Shape {
  std::vector<Vec3> positions;        // [vertices]
  std::vector<Triangle> triangles;    // [triangles]
  std::vector<JointWeights> weights;  // [vertices]
  Rig rig;
  std::vector<std::string> bone_names;  // [bones], all different, such as "left_forearm"
};

// One row of the list of shapes.
struct ShapeRow {
  std::string_view name;
  std::string_view description;
  std::span<const ParameterRow> parameters;
  Shape (*make)(const Parameters& parameters);  // takes what `checked` returns
  // Returns parameters for the same form and skeleton with `factor` times as many cells along every
  // direction, rounded. This gives about factor^2 times the triangles.
  Parameters (*at_resolution)(const Parameters& parameters, double factor);
  // True if the surface settles in sweeps. A finer surface needs far more sweeps, so a surface finer than
  // its scene asks for is made by subdividing.
  bool settles = false;
};

// count * factor, rounded and at least `least`: a count of cells at another resolution, as a parameter's
// value.
inline double scaled_count(int count, double factor, int least) {
  return std::max(static_cast<double>(least), std::round(count * factor));
}

}  // namespace cscd::scenes
