#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"
#include "scenes/shape/parameters.h"

namespace cscd::scenes {

// How much each of at most four bones moves a vertex. Weights are not negative and sum to 1; unused places
// have bone -1 and weight 0 and come last.
struct JointWeights {
  static constexpr std::size_t most = 4;
  std::array<BoneId, most> bone{BoneId{-1}, BoneId{-1}, BoneId{-1}, BoneId{-1}};
  std::array<double, most> weight{};
};

// A skinned character at rest: a closed surface, outward oriented, with its skeleton.
struct Shape {
  std::vector<Vec3> positions;        // [vertices]
  std::vector<Triangle> triangles;    // [triangles]
  std::vector<JointWeights> weights;  // [vertices]
  Rig rig;
  std::vector<std::string> bone_names;  // [bones], no two alike: "left_forearm"
};

// One row of the list of shapes.
struct ShapeRow {
  std::string_view name;
  std::string_view description;
  std::span<const ParameterRow> parameters;
  Shape (*make)(const Parameters& parameters);  // of checked parameters
  // The same form and skeleton with so many times as many cells along every direction, rounded: about
  // factor^2 times the triangles.
  Parameters (*at_resolution)(const Parameters& parameters, double factor);
  // The surface settles in sweeps: far more of them the finer it is, so that what is finer than its scene
  // asks for is had by subdividing.
  bool settles = false;
};

// A count of cells at another resolution, as parameters hold it.
double scaled_count(int count, double factor, int least);

}  // namespace cscd::scenes
