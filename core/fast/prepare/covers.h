#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/numbers.h"
#include "core/base/thread_pool.h"
#include "core/fast/prepare/following_point.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// A cover divides triangles of the surface into disjoint clusters and gives every cluster one observer. A
// cover may leave triangles out. No cluster spans two connected components of the mesh (rule component,
// core/soundness.md).
struct Cover {
  std::vector<std::int32_t> cluster_of;   // [triangles]; kNone for a triangle that the cover leaves out
  std::vector<FollowingPoint> observers;  // [clusters]
};

// The covers that `drvbc_fast` looks from. They overlap, so that a triangle at a seam of one cover lies well
// inside a cluster of another. cut_surface.h says how each of them is made.
inline constexpr std::size_t kCovers = 3;
using Covers = std::array<Cover, kCovers>;

// Numbers the clusters from 0 in the order of their first triangles, and returns how many there are.
// `cluster_of` is [triangles], with kNone for a triangle without a cluster.
std::size_t renumber(std::vector<std::int32_t>& cluster_of);

// Makes a cover from the cluster of each triangle, `cluster_of` [triangles], with kNone for a triangle
// without a cluster, and numbers them anew. Places the observer
// of each cluster where it sees as much of the cluster as possible from behind in the reference pose.
Cover make_cover(const TriangleMesh& mesh, std::span<const Vec3> reference,
                 std::vector<std::int32_t> cluster_of, const ThreadPool& pool = ThreadPool());

// Merges each cluster that is too thin for its middle to lie well inside it with the neighbour along the
// longest seam, the thinnest cluster first. Only clusters with at most two neighbours are merged, because a
// cluster with more neighbours is no link of a limb.
void merge_thin_clusters(const TriangleMesh& mesh, std::vector<std::int32_t>& cluster_of);

// Returns for each triangle the nearest seam between two clusters, as a label, or kNone where every seam is
// farther away than a few rings of triangles.
std::vector<std::int32_t> nearest_seams(const TriangleMesh& mesh, std::span<const std::int32_t> cluster_of);

// Returns for each triangle whether it lies *inside* its cluster: whether the triangle and all triangles that
// share a vertex with it belong to that cluster.
std::vector<bool> inside(const TriangleMesh& mesh, std::span<const std::int32_t> cluster_of);

}  // namespace cscd::fast
