#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/engine/covers.h"
#include "core/geometry/lanes16.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Up to sixteen neighbouring triangles with up to sixteen vertices, so that all of them lie in few registers.
// All belong to one cluster in each cover, or to none.
struct Patch {
  std::array<std::int32_t, kLanes16> vertex;  // a short one repeats its last
  std::array<Places16, 3> corner;             // of each triangle: places in `vertex`
  std::array<std::int32_t, kCovers> cluster;  // in each cover
  std::array<Mask16, kCovers> inside;         // triangles whose corners' triangles all belong to that cluster
  Mask16 lanes;                               // those that are triangles
  // Not needed of most patches, and in a cache line of its own.
  alignas(64) std::array<TriangleId, kLanes16> triangle;  // a short one repeats its last
};

// A triangle's place among the patches, in one word, as every triangle keeps those of a dozen others.
struct Lane {
  std::uint32_t patch : 28;
  std::uint32_t lane : 4;
};

// Which triangles of another patch share each corner of each triangle of this one.
struct Adjacent {
  std::int32_t patch;
  std::array<std::array<Mask16, 3>, kLanes16> sharing;

  Mask16 lanes(std::size_t lane) const { return sharing[lane][0] | sharing[lane][1] | sharing[lane][2]; }
};

// The surface cut into patches, and a binary tree over them, built once in the reference pose. The children
// of a node stand side by side and after it.
struct PatchTree {
  struct Node {
    std::int32_t child;  // inner node: its left child, before the right one; leaf: ~patch
    bool is_leaf() const { return child < 0; }
    std::size_t patch() const { return static_cast<std::size_t>(~child); }
    std::size_t left() const { return static_cast<std::size_t>(child); }
    std::size_t right() const { return left() + 1; }
  };
  std::vector<Node> nodes;
  std::vector<Patch> patches;

  // The patches that touch a patch, itself among them, in compressed rows.
  std::vector<std::int32_t> adjacent_offset;
  std::vector<Adjacent> adjacent;
  // Null where the two do not touch.
  const Adjacent* adjacent_to(std::size_t p, std::size_t q) const {
    for (auto i = static_cast<std::size_t>(adjacent_offset[p]);
         i < static_cast<std::size_t>(adjacent_offset[p + 1]); ++i)
      if (static_cast<std::size_t>(adjacent[i].patch) == q) return &adjacent[i];
    return nullptr;
  }

  // Lanes of the triangles that share a vertex with a triangle, itself among them, in compressed rows.
  std::vector<std::int32_t> ring_offset;
  std::vector<Lane> ring;
  std::span<const Lane> ring_of(TriangleId triangle) const {
    const auto first = static_cast<std::size_t>(ring_offset[+triangle]);
    return std::span(ring).subspan(first, static_cast<std::size_t>(ring_offset[+triangle + 1]) - first);
  }
};

inline constexpr std::size_t kCutting = 2;  // covers by which patches are cut

// Cuts by the first two covers and makes the third.
PatchTree make_patches(const TriangleMesh& mesh, std::span<const Vec3> reference, Covers& covers);

}  // namespace cscd::fast
