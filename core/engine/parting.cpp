#include "core/engine/parting.h"

#include <bit>

namespace cscd::fast {
namespace {

Viewpoint corner_of(const PlaneOf& triangle, std::size_t k) {
  const std::size_t place = triangle.patch.corner[k][triangle.lane];
  Viewpoint corner{};
  for (std::size_t end = 0; end < 2; ++end)
    for (std::size_t i = 0; i < 3; ++i) corner.at[end][i] = triangle.planes.vertices.at[end][i][place];
  return corner;
}

// Signs of the vertices of a patch towards the plane of one triangle.
Signs sides_of(const PatchLanes& vertices, const PlaneOf& of, float error) {
  PatchNormals same;
  for (std::size_t n = 0; n < 3; ++n)
    for (std::size_t i = 0; i < 3; ++i)
      same.control[n][i] = all_lanes(of.planes.normals.control[n][i][of.lane]);
  for (std::size_t e = 0; e < 2; ++e) same.longest[e] = all_lanes(of.planes.normals.longest[e][of.lane]);
  return orientation(same, vertices, corner_of(of, 0), error);
}

// Triangles in `mask` with a corner in `some` and no corner that is in neither.
Mask16 made_of(const Patch& patch, Mask16 mask, unsigned some, unsigned shared) {
  unsigned found = 0;
  for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
    const unsigned corners =
        1U << patch.corner[0][lane] | 1U << patch.corner[1][lane] | 1U << patch.corner[2][lane];
    found |= static_cast<unsigned>((corners & ~(some | shared)) == 0 && (corners & some) != 0) << lane;
  }
  return static_cast<Mask16>(found);
}

unsigned places_in(const Patch& patch, const PlaneOf& other) {
  unsigned places = 0;
  for (const Places16& place : other.patch.corner)
    for (std::size_t l = 0; l < kLanes16; ++l)
      places |= static_cast<unsigned>(patch.vertex[l] == other.patch.vertex[place[other.lane]]) << l;
  return places;
}

}  // namespace

PatchPlanes planes_of(std::span<const LocalPositions::Record> records, const Patch& patch) {
  PatchPlanes planes{load(records, patch.vertex), {}, {}};
  find_normals(planes.vertices, patch, planes.normals, planes.corner);
  return planes;
}

Mask16 not_parted(const PatchPlanes& planes, const Patch& patch, Mask16 mask, const PlaneOf& other,
                  const Common* common, float error) {
  const unsigned shared = common == nullptr ? 0 : places_in(patch, other);
  const Signs sides = sides_of(planes.vertices, other, error);
  mask &= static_cast<Mask16>(~made_of(patch, mask, sides.positive, shared));
  mask &= static_cast<Mask16>(~made_of(patch, mask, sides.negative, shared));
  if (mask == 0) return mask;

  unsigned above = 0xffff, below = 0xffff, any = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Signs signs = orientation(planes.normals, planes.corner, corner_of(other, k), error);
    const unsigned has = common == nullptr ? 0 : common->at[other.patch.corner[k][other.lane]];
    above &= signs.positive | has;
    below &= signs.negative | has;
    any |= static_cast<unsigned>(signs.positive | signs.negative);
  }
  return static_cast<Mask16>(mask & ~((above | below) & any));
}

}  // namespace cscd::fast
