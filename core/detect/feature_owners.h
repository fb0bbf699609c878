#pragma once

#include <cstdint>
#include <vector>

#include "core/detect/carried_pairs.h"

namespace cscd {

// Every vertex and every edge of a mesh is owned by one of the triangles that have it. A feature pair then
// has one pair of triangles that *owns* it: that of the owners of both features, where a face owns itself.
// Where every pair of triangles that is not passed on carries no contact, it is enough to test each pair of
// triangles for the feature pairs that it owns (rule any-carrier, core/soundness.md).
//
// Few triangles own vertices, and about half of all own edges, so that many pairs of triangles own nothing.
class FeatureOwners {
 public:
  explicit FeatureOwners(const TriangleMesh& mesh);

  // Returns the places of the feature pairs that two different triangles own, if they carry them.
  CarriedPlaces owned_by(const TrianglePair& pair) const {
    const unsigned a = owned_[+pair.a], b = owned_[+pair.b], edges = b >> 3;
    const unsigned first = a & 8 ? edges : 0, second = a & 16 ? edges : 0, third = a & 32 ? edges : 0;
    return static_cast<CarriedPlaces>((a & 7) | (b & 7) << 3 | first << 6 | second << 9 | third << 12);
  }

 private:
  // [triangles]: bit k says that the triangle owns its corner k, and bit 3 + k that it owns its edge k.
  std::vector<std::uint8_t> owned_;
};

}  // namespace cscd
