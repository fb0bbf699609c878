#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/crossing/overlaps.h"
#include "core/detect/contact.h"

namespace cscd {

// Which triangles face each other in the overlaps of a pose. A piece is a region, with the triangles that
// have a vertex in it or through which a curve that bounds it runs on its sheet; or what a curve runs through
// on a sheet where it bounds no region. Two pieces face each other if they lie on the two sheets of one
// curve. What touches between them is no news in a step that starts in the pose; what touches between two
// fingers that are both in a thigh is.
class OverlapPieces {
 public:
  static constexpr std::size_t kNone = ~std::size_t{0};

  OverlapPieces() = default;
  // `number`, [all.overlaps], names each overlap; those with the number kNone are left out.
  OverlapPieces(const TriangleMesh& mesh, const Overlaps& all, std::span<const std::size_t> number);

  bool empty() const { return triangles_.empty(); }
  // Returns the smallest number of an overlap in which the triangles face each other, or kNone.
  std::size_t find(TriangleId a, TriangleId b) const;
  // Returns the smallest number of an overlap in which some pair of triangles that carries the feature pair
  // does, or kNone.
  std::size_t find(const TriangleMesh& mesh, const FeaturePair& pair) const;

 private:
  struct Facing {
    std::uint64_t pieces;  // one in each half
    std::size_t number;
    auto operator<=>(const Facing&) const = default;
  };
  std::vector<std::uint64_t> triangles_;  // the triangle in the upper half, the piece in the lower; sorted
  std::vector<Facing> facing_;            // both ways; sorted
};

}  // namespace cscd
