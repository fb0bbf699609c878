#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/fast/cut/decided_cut.h"

namespace cscd::fast {

// Returns a digest of each triangle, by which the triangle is known again on another surface: a digest of the
// places of its three corners in the reference pose, whichever corner comes first; [triangles].
std::vector<std::uint64_t> triangle_digests(const TriangleMesh& mesh, std::span<const Vec3> reference);

// A surface that was cut, as far as a changed surface asks about it. Triangles and vertices in `decided` are
// those of that surface; triangles and clusters are in range, and no patch is empty.
struct EarlierCut {
  DecidedCut decided;
  std::vector<std::uint64_t> digests;  // [triangles]
  // Where the vertices that an observer follows were in the reference pose; [covers][clusters][vertices].
  std::array<std::vector<std::vector<Vec3>>, kCovers> places;
};

struct CarriedCut {
  DecidedCut decided;
  std::size_t new_triangles;
};
// Takes the cut of a surface over to one that has changed in places: triangles were added, removed, or moved
// in the reference pose, numbered anew, or cut off from others. Patches whose triangles have all stayed are
// taken over, and what lies between them is cut anew. Throws InputError if less than half of the triangles
// were there before.
CarriedCut carried_over(const TriangleMesh& mesh, std::span<const Vec3> reference, const EarlierCut& earlier);

}  // namespace cscd::fast
