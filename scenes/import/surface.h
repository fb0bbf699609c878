#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "scenes/character/character.h"
#include "scenes/character/options.h"
#include "scenes/character/pieces.h"
#include "scenes/character/pose.h"
#include "scenes/character/report.h"
#include "scenes/character/weld.h"

// From the parts of a character to one surface: welded, mended where that was asked for, and cut down to the
// chosen components. Raw vertices are those of all parts one after the other.
namespace cscd::scenes {

// All parts in the bind pose.
struct RawSurface {
  Pose bound;
  std::vector<Vec3> positions;              // [raw vertices]
  std::vector<RawTriangle> triangles;       // corners are raw vertices
  double diagonal = 0;                      // of the box round all triangles
  std::vector<std::int32_t> triangle_part;  // [triangles]
  std::vector<std::int32_t> first_vertex;   // [parts]: the raw vertex that is the part's vertex 0
};

// Throws InputError for a character without triangles, or in one point.
RawSurface raw_surface(const Character& character);

// The chosen surface with vertices numbered anew.
struct ChosenSurface {
  std::vector<std::int32_t> weld_group;  // of each raw vertex, the raw vertex that stands for it
  std::vector<Piece> pieces;             // all components, chosen or not
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> raw_vertex;  // of each vertex
  // Of each triangle, the raw triangle it was made of; kFilled for one that fills a hole.
  std::vector<std::size_t> raw_triangle;
  static constexpr std::size_t kFilled = std::numeric_limits<std::size_t>::max();
};

// Welds, fills holes and turns components as the options say, and chooses; tells the report of all of it.
ChosenSurface choose_surface(const Character& character, const RawSurface& raw, const ImportOptions& options,
                             ImportReport& report);

}  // namespace cscd::scenes
