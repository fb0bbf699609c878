#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenes/character/character.h"
#include "scenes/character/options.h"
#include "scenes/character/pieces.h"
#include "scenes/character/pose.h"
#include "scenes/character/report.h"
#include "scenes/character/weld.h"

// Makes one surface of the parts of a character: welded, mended where the options ask for it, and cut down to
// the chosen components. The raw vertices and raw triangles are those of all parts, one part after the other.
namespace cscd::scenes {

// All parts in the bind pose.
struct RawSurface {
  Pose bound;
  std::vector<Vec3> positions;              // [raw vertices]
  std::vector<RawTriangle> triangles;       // corners are raw vertices
  double diagonal = 0;                      // of the box around all triangles
  std::vector<std::int32_t> triangle_part;  // [triangles]
  std::vector<std::int32_t> first_vertex;   // [parts]; the raw vertex that is the part's vertex 0
};

// Collects the parts of a character in its bind pose. Throws InputError for a character without triangles,
// and for one whose triangles lie in a single point.
RawSurface raw_surface(const Character& character);

// The chosen surface, with its vertices numbered anew.
struct ChosenSurface {
  std::vector<std::int32_t> weld_group;  // [raw vertices]; the raw vertex that stands for its weld group
  std::vector<Piece> pieces;             // all components, chosen or not
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> raw_vertex;  // [vertices]
  // [triangles]; the raw triangle that a triangle was made of, kFilled for a triangle that fills a hole.
  std::vector<std::size_t> raw_triangle;
  static constexpr std::size_t kFilled = std::numeric_limits<std::size_t>::max();
};

// Says how many vertices are of no face. A moving surface is taken as it is, and there they are points, such
// as particles. Models hold many that mean nothing, so of those they are left out.
std::string note_on_points(std::size_t count);
std::string note_on_loose_vertices(std::size_t count);

// Welds the raw surface, fills holes, turns components that face inward and chooses components, all as the
// options say. Records each step in the report. Throws InputError for a weld tolerance and a component that
// the surface cannot use.
ChosenSurface choose_surface(const Character& character, const RawSurface& raw, const ImportOptions& options,
                             ImportReport& report);

}  // namespace cscd::scenes
