#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "core/detect/contact.h"
#include "core/detect/culler.h"

namespace cscd {

// The feature pairs that two different triangles carry: any vertex against the other triangle and any edge
// against any edge, unless they share a vertex. They stand at fifteen places, one bit each. Places 0 to 2 are
// the corners of the first triangle against the second, places 3 to 5 the corners of the second against the
// first, and place 6 + 3 i + k is edge i of the first against edge k of the second.
using CarriedPlaces = std::uint16_t;
inline constexpr CarriedPlaces kAllCarried = 0x7fff;
// Returns the places of the feature pairs that the two triangles carry: kAllCarried if they share no vertex.
CarriedPlaces carried_by(const Triangle& a, const Triangle& b);
// Returns the feature pair at one place, in [0, 15), of two triangles.
inline FeaturePair carried(const TriangleMesh& mesh, const TrianglePair& pair, std::size_t place) {
  if (place < 3) return FeaturePair::of(mesh.corners(pair.a)[place], pair.b);
  if (place < 6) return FeaturePair::of(mesh.corners(pair.b)[place - 3], pair.a);
  return FeaturePair::of(mesh.edges_of(pair.a)[(place - 6) / 3], mesh.edges_of(pair.b)[(place - 6) % 3]);
}

// Visits some of the feature pairs.
struct CarriedPairs {
  TrianglePair pair;
  CarriedPlaces places;
};
// Calls take(feature_pair) for each of them, in the order of their places.
template <class Take>
void for_each_carried(const TriangleMesh& mesh, const CarriedPairs& some, const Take& take) {
  for (unsigned rest = some.places; rest != 0; rest &= rest - 1)
    take(carried(mesh, some.pair, static_cast<std::size_t>(std::countr_zero(rest))));
}
// Visits all of them.
template <class Take>
void for_each_carried(const TriangleMesh& mesh, const TrianglePair& pair, const Take& take) {
  for_each_carried(mesh, CarriedPairs{pair, carried_by(mesh.corners(pair.a), mesh.corners(pair.b))}, take);
}

// For strategies that test a triangle pair for some of the feature pairs that it carries. A feature pair that
// is left out must be tested for another triangle pair that the same culler passes on, or in every interval
// (rule any-carrier, core/soundness.md).
class FeatureAssignment {
 public:
  virtual ~FeatureAssignment() = default;
  // Appends the triangle pairs of a block that have to be tested, with the feature pairs to test each for.
  virtual void append(std::span<const TrianglePair> block, std::vector<CarriedPairs>& out) const = 0;
  // The feature pairs that are tested in every interval.
  virtual std::span<const FeaturePair> always() const = 0;
};

}  // namespace cscd
