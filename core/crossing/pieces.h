#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/crossing/overlaps.h"
#include "core/detect/contact.h"

namespace cscd {

// The triangles of the pieces that lie in each other in a pose: those that the curves of an overlap run
// through, and those that have a vertex in one of its regions. What touches between two triangles of one
// overlap is no news in a step that starts in the pose.
class OverlapPieces {
 public:
  static constexpr std::size_t kNone = ~std::size_t{0};

  OverlapPieces() = default;
  // `number`, [all.overlaps], names each overlap by a number below 2^32; those with the number kNone are left
  // out.
  OverlapPieces(const TriangleMesh& mesh, const Overlaps& all, std::span<const std::size_t> number);

  bool empty() const { return triangles_.empty(); }
  // Returns the smallest number that both triangles belong to, or kNone.
  std::size_t find(TriangleId a, TriangleId b) const;
  // Returns the smallest number to which some pair of triangles that carries the feature pair belongs, or
  // kNone.
  std::size_t find(const TriangleMesh& mesh, const FeaturePair& pair) const;

 private:
  std::vector<std::uint64_t> triangles_;  // the triangle in the upper half, the number in the lower; sorted
};

}  // namespace cscd
