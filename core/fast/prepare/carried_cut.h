#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/fast/prepare/cut_surface.h"

namespace cscd::fast {

// What takes time to decide when a surface is cut. The rest of a CutSurface is made from it and the mesh.
struct DecidedCut {
  std::size_t covers_used;  // how many of the covers are looked from
  Covers covers;
  PatchList patches;
};

// Throws InputError, saying that a preparation has this fault.
[[noreturn]] void refuse_preparation(const std::string& fault);

// Throws InputError for what breaks a rule that the theorems rely on (core/soundness.md): each triangle is in
// one patch and one cluster of the first cover, no patch is in two clusters of a cover, no cluster is in two
// components, and observers follow vertices that there are. The numbers of clusters must be in range.
void check(const TriangleMesh& mesh, const DecidedCut& decided);

// Builds the tree, and what patches share. `decided` has been checked.
CutSurface finished(const TriangleMesh& mesh, std::span<const Vec3> reference, DecidedCut decided);

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
