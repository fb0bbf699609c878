#include "core/fast/certify/parting.h"

#include "core/fast/classify/patch_lanes.h"

namespace cscd::fast {
namespace {

// Sixteen triangles, one a lane.
struct TriangleLanes {
  VectorLanes16 corner[3];
  Mask16 shared[3];  // lanes in which the other triangle has this corner too
};

TriangleLanes load(std::span<const LocalPositions::Record> records, const PairLanes::Vertices& own,
                   const PairLanes::Vertices& other) {
  TriangleLanes triangles;
  for (std::size_t k = 0; k < 3; ++k) {
    triangles.corner[k] = load(records, own[k]);
    triangles.shared[k] = equal(own[k], other[0]) | equal(own[k], other[1]) | equal(own[k], other[2]);
  }
  return triangles;
}

// Returns the lanes in which the plane of the first triangle has all of the second on one side.
Mask16 parted_by_plane(const TriangleLanes& of, const TriangleLanes& other, float error) {
  const VectorLanes16 a = of.corner[1] - of.corner[0], b = of.corner[2] - of.corner[0];
  Float16 normal[3][3];
  cross(a, b, normal);
  const Rounding16 rounding = rounding_of(largest_component(a), largest_component(b), error);
  unsigned above = 0xffff, below = 0xffff, any = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const TripleProducts16 products =
        triple_products(normal, other.corner[k] - of.corner[0], rounding, error);
    const unsigned positive = products.positive(), negative = products.negative();
    above &= positive | other.shared[k];
    below &= negative | other.shared[k];
    any |= positive | negative;  // shared corners lie in the plane and do not count
  }
  return static_cast<Mask16>((above | below) & any);
}

}  // namespace

Mask16 not_parted(std::span<const LocalPositions::Record> records, const PairLanes& pairs, float error) {
  const TriangleLanes first = load(records, pairs.first, pairs.second);
  const TriangleLanes second = load(records, pairs.second, pairs.first);
  return static_cast<Mask16>(
      ~(parted_by_plane(first, second, error) | parted_by_plane(second, first, error)));
}

}  // namespace cscd::fast
