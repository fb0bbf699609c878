#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "core/base/thread_pool.h"
#include "core/fast/prepare/covers.h"
#include "core/geometry/simd_floats.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// A patch is up to sixteen neighbouring triangles with up to sixteen vertices, so that all of them fit into
// few registers. All its triangles belong to one cluster in each cover, or to none.
struct alignas(64) Patch {
  std::array<std::int32_t, kLanes16> vertex;  // a patch with fewer vertices repeats its last one
  std::array<Places16, 3> corner;             // the corners of each triangle, as places in `vertex`
  std::array<std::int32_t, kCovers> cluster;  // its cluster in each cover, or kNone
  Mask16 lanes;                               // the lanes that hold a triangle

  // Returns the places of the corners of some of its triangles.
  Mask16 corners_of(unsigned triangles) const {
    unsigned places = 0;
    for_each_lane(triangles, [&](std::size_t lane) {
      for (const Places16& place : corner) places |= 1U << place[lane];
    });
    return static_cast<Mask16>(places);
  }
};
static_assert(sizeof(Patch) == 2 * 64);

// Says which triangles of another patch have each vertex of this patch.
struct SharedVertices {
  std::array<Mask16, kLanes16> at;  // [places of this patch]; triangles of the other patch at that vertex

  // Returns the triangles of the other patch that share a corner with one triangle of this patch.
  Mask16 beside(const Patch& patch, std::size_t lane) const {
    return static_cast<Mask16>(at[patch.corner[0][lane]] | at[patch.corner[1][lane]] |
                               at[patch.corner[2][lane]]);
  }

  // Returns the triangles of the other patch that have one of the vertices at some places. All places are
  // treated at once, because no processor foresees which of them are asked for.
  Mask16 lanes(Mask16 places) const {
    return any_of(select(((Rows{} + places) & kPlace) != 0, rows(), Rows{}));
  }
  // Returns the places of the vertices that some triangles of the other patch have.
  Mask16 places(Mask16 lanes) const { return any_of(select((rows() & lanes) != 0, kPlace, Rows{})); }

 private:
  using Rows = HalfOf<Mask16>;
  static constexpr Rows kPlace = {1,      1 << 1, 1 << 2,  1 << 3,  1 << 4,  1 << 5,  1 << 6,  1 << 7,
                                  1 << 8, 1 << 9, 1 << 10, 1 << 11, 1 << 12, 1 << 13, 1 << 14, 1 << 15};
  Rows rows() const { return loaded<Rows>(at.data()); }
  static Mask16 any_of(const Rows& rows) {
    using Eight = VectorOf<Mask16, 16>;
    const Eight eight = half_of<Eight, 0>(rows) | half_of<Eight, 1>(rows);
    std::uint64_t fours[2];
    std::memcpy(fours, &eight, sizeof fours);
    std::uint64_t any = fours[0] | fours[1];
    any |= any >> 32;
    return static_cast<Mask16>(any | any >> 16);
  }
};

// The surface cut into patches, and a binary tree over the patches, built once in the reference pose. The two
// children of a node stand side by side, after the node.
struct PatchTree {
  struct Node {
    std::int32_t child;  // an inner node's left child, with the right one behind it; ~patch for a leaf
    bool is_leaf() const { return child < 0; }
    std::size_t patch() const { return static_cast<std::size_t>(~child); }
    std::size_t left() const { return static_cast<std::size_t>(child); }
    std::size_t right() const { return left() + 1; }
  };
  std::vector<Node> nodes;
  std::vector<std::int32_t> leaf;   // [patches]: the leaf of each patch
  std::vector<std::int32_t> inner;  // the inner nodes, ascending, so that children come after their parents
  // [inner nodes]: the end of what lies below each, which follows it in `inner`
  std::vector<std::int32_t> inner_end;
  std::vector<Patch> patches;
  // [patches]: the triangles of each patch; a patch with fewer than sixteen repeats its last one. They are
  // kept apart from the patches, because an interval asks for the triangles of few patches.
  std::vector<std::array<TriangleId, kLanes16>> triangles;
  std::vector<std::int32_t> cell;  // [patches]: the number of its cell
  std::span<const TriangleId> triangles_of(std::size_t patch) const {
    return std::span(triangles[patch]).first(static_cast<std::size_t>(std::bit_width(patches[patch].lanes)));
  }

  // Visits the inner nodes, children before their parents. Walking through all nodes instead would cost a
  // branch a node that no processor foresees.
  template <class Take>  // (node, its entry), from any thread
  void for_each_inner_upwards(const ThreadPool& pool, const Take& take) const {
    const std::size_t count = inner.size(), ranges = pool.ranges_of(count, kInnerTogether);
    const auto visit = [&](std::size_t i) {
      take(static_cast<std::size_t>(inner[i]), nodes[static_cast<std::size_t>(inner[i])]);
    };
    if (ranges == 1) {
      for (std::size_t i = count; i-- > 0;) visit(i);
      return;
    }
    // The few nodes of a range below which there are nodes of other ranges wait for the end.
    pool.ranges(count, kInnerTogether, [&](std::size_t first, std::size_t last, std::size_t) {
      for (std::size_t i = last; i-- > first;)
        if (static_cast<std::size_t>(inner_end[i]) <= last) visit(i);
    });
    for (std::size_t part = ranges; part-- > 0;) {
      const std::size_t first = ThreadPool::range_begin(count, ranges, part),
                        last = ThreadPool::range_begin(count, ranges, part + 1);
      for (std::size_t i = last; i-- > first;)
        if (static_cast<std::size_t>(inner_end[i]) > last) visit(i);
    }
  }
  static constexpr std::size_t kInnerTogether = 512;  // inner nodes, some microseconds of work

  // [patches][covers]: the triangles that lie inside the patch's cluster, so that all triangles round their
  // corners belong to it.
  std::vector<std::array<Mask16, kCovers>> inside;

  // The patches that touch a patch, the patch itself among them, in compressed rows.
  std::vector<std::int32_t> adjacent_offset, adjacent;
  std::vector<SharedVertices> common;
  template <class Take>  // (patch, common)
  void for_each_adjacent(std::size_t p, const Take& take) const {
    const auto end = static_cast<std::size_t>(adjacent_offset[p + 1]);
    for (auto i = static_cast<std::size_t>(adjacent_offset[p]); i < end; ++i)
      take(static_cast<std::size_t>(adjacent[i]), common[i]);
  }
  // Returns what two patches have in common, or null where they do not touch.
  const SharedVertices* common_of(std::size_t p, std::size_t q) const {
    const auto end = static_cast<std::size_t>(adjacent_offset[p + 1]);
    for (auto i = static_cast<std::size_t>(adjacent_offset[p]); i < end; ++i)
      if (static_cast<std::size_t>(adjacent[i]) == q) return &common[i];
    return nullptr;
  }
};

// The cluster of each triangle in the first two covers, [triangles] each. The surface is cut along the seams
// of both.
struct CuttingClusters {
  std::span<const std::int32_t> first, second;
};

// Patches as sets of triangles, each triangle in one of them, at most sixteen triangles with at most as many
// vertices in a patch.
struct PatchList {
  std::vector<std::vector<TriangleId>> triangles;  // [patches]
  std::vector<std::int32_t> cell;                  // [patches]: the number of its cell
};

// Cuts the surface into patches.
//
// The surface is first cut into cells, and each cell into patches. A *cell* is a set of triangles that the
// certificates treat alike: the triangles of one first cluster and one second cluster that all lie inside the
// second cluster, or all do not. A set of fewer than `least_cell` triangles is no cell of its own: all such
// sets of a first cluster form one cell together. So no patch crosses a seam of the first clusters, and a
// patch crosses a seam of the second clusters only where that seam would make too small a cell.
PatchList cut_into_patches(const TriangleMesh& mesh, std::span<const Vec3> reference,
                           const CuttingClusters& clusters, std::size_t least_cell,
                           const ThreadPool& pool = ThreadPool());

// Returns the middle of each triangle, [triangles].
std::vector<Vec3> centroids(const TriangleMesh& mesh, std::span<const Vec3> reference);

// Builds the tree over patches, of which none crosses a seam of the first clusters, `cluster_of` [triangles].
// The patches of the tree belong to no cluster, and `inside` is empty: cut_surface.h enters both.
PatchTree make_tree(const TriangleMesh& mesh, std::span<const Vec3> reference, const PatchList& patches,
                    std::span<const std::int32_t> cluster_of);

}  // namespace cscd::fast
