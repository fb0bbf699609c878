#include "core/fast/prepare/covers.h"

#include <algorithm>
#include <map>

#include "core/fast/clusters/seams.h"
#include "core/fast/prepare/cluster_observer.h"
#include "core/fast/prepare/rings.h"
#include "core/mesh/adjacency.h"

namespace cscd::fast {
namespace {

constexpr std::int32_t kReach = 6;  // so many rings of triangles about a seam belong to its cluster
// A seam's cluster reaches through this part of a cluster that is not deep. Between the clusters of two seams
// there have to be patches that belong to neither: a patch that belongs to one, at a border of the other,
// would leave the first a ring without its certificate.
constexpr std::int32_t kPartReached = 7, kWhole = 10;
constexpr std::int32_t kFar = kReach * kWhole / kPartReached + 1;  // from here on, all of kReach is reached
constexpr std::int32_t kThin = 4;  // a cluster without a triangle so many rings from its seams is merged

}  // namespace

std::size_t renumber(std::vector<std::int32_t>& cluster_of) {
  std::map<std::int32_t, std::int32_t> number;
  for (std::int32_t& c : cluster_of)
    if (c != kNone) c = number.try_emplace(c, static_cast<std::int32_t>(number.size())).first->second;
  return number.size();
}

Cover make_cover(const TriangleMesh& mesh, std::span<const Vec3> reference,
                 std::vector<std::int32_t> cluster_of, const ThreadPool& pool) {
  Cover cover{std::move(cluster_of), {}};
  std::vector<std::vector<TriangleId>> members(renumber(cover.cluster_of));
  for (std::size_t t = 0; t < cover.cluster_of.size(); ++t)
    if (cover.cluster_of[t] != kNone)
      members[static_cast<std::size_t>(cover.cluster_of[t])].push_back(
          TriangleId{static_cast<std::int32_t>(t)});
  cover.observers.resize(members.size());
  pool.parallel_for(members.size(), [&](std::size_t c, std::size_t) {
    cover.observers[c] = observer_of(mesh, reference, members[c]);
  });
  return cover;
}

namespace {

// The triangles on both sides of the seam between each two clusters.
using Seams = std::map<std::pair<std::int32_t, std::int32_t>, std::vector<TriangleId>>;
Seams seams_of(const TriangleMesh& mesh, std::span<const std::int32_t> cluster_of) {
  Seams seams;
  for_each_seam_edge(mesh, cluster_of, [&](TriangleId a, TriangleId b) {
    std::vector<TriangleId>& seam = seams[std::minmax(cluster_of[+a], cluster_of[+b])];
    seam.insert(seam.end(), {a, b});
  });
  return seams;
}

// Measures the depth of clusters: the number of rings of triangles between a cluster's seams and its
// innermost triangle. The triangles at the seams are ring 1. A depth of more than kThin is
// given as kThin + 1.
class DepthMeter {
 public:
  DepthMeter(const TriangleMesh& mesh, const std::vector<std::int32_t>& cluster_of)
      : mesh_(mesh), cluster_of_(cluster_of), distance_(cluster_of.size(), kNone) {}

  std::int32_t depth(std::int32_t cluster, const Seams& seams) {
    reached_.clear();
    for (const auto& [clusters, triangles] : seams)
      if (clusters.first == cluster || clusters.second == cluster)
        for (const TriangleId t : triangles) reach(t, cluster, 0);
    for (std::size_t next = 0; next < reached_.size(); ++next) {
      const std::int32_t distance = distance_[+reached_[next]] + 1;
      if (distance > kThin) break;
      for_each_neighbour(mesh_, reached_[next], [&](TriangleId t) { reach(t, cluster, distance); });
    }
    const std::int32_t deepest = reached_.empty() ? 0 : distance_[+reached_.back()] + 1;
    for (const TriangleId t : reached_) distance_[+t] = kNone;
    return deepest;
  }

 private:
  void reach(TriangleId t, std::int32_t cluster, std::int32_t distance) {
    if (cluster_of_[+t] != cluster || distance_[+t] != kNone) return;
    distance_[+t] = distance;
    reached_.push_back(t);
  }

  const TriangleMesh& mesh_;
  const std::vector<std::int32_t>& cluster_of_;
  std::vector<std::int32_t> distance_;  // [triangles]: from the cluster's seams; kNone between two calls
  std::vector<TriangleId> reached_;
};

// Two clusters to merge. The thinner the one, the better the merge; of equally thin clusters, the pair with
// the longer seam is merged first.
struct Merge {
  std::int32_t depth = kThin;
  std::size_t length = 0;
  std::int32_t from = kNone, into = kNone;
};
Merge best_merge(const Seams& seams, const std::map<std::int32_t, std::int32_t>& depth) {
  std::map<std::int32_t, int> neighbours;
  for (const auto& [clusters, triangles] : seams) ++neighbours[clusters.first], ++neighbours[clusters.second];
  Merge best;
  for (const auto& [clusters, triangles] : seams) {
    if (neighbours[clusters.first] > 2 || neighbours[clusters.second] > 2) continue;
    const std::int32_t thinner = std::min(depth.at(clusters.first), depth.at(clusters.second));
    if (std::pair(thinner, best.length) < std::pair(best.depth, triangles.size()))
      best = {thinner, triangles.size(), clusters.second, clusters.first};
  }
  return best;
}

// Removes the seam between the two clusters, and gives the other seams of `from` to `into`. The number of
// `into` must be the smaller one.
void merge(Seams& seams, std::int32_t from, std::int32_t into) {
  seams.erase({into, from});
  Seams merged;
  for (auto& [clusters, triangles] : seams) {
    const auto renamed = [&](std::int32_t c) { return c == from ? into : c; };
    std::vector<TriangleId>& all = merged[std::minmax(renamed(clusters.first), renamed(clusters.second))];
    if (all.empty())
      all = std::move(triangles);
    else
      all.insert(all.end(), triangles.begin(), triangles.end());
  }
  seams = std::move(merged);
}

}  // namespace

void merge_thin_clusters(const TriangleMesh& mesh, std::vector<std::int32_t>& cluster_of) {
  Seams seams = seams_of(mesh, cluster_of);
  DepthMeter meter(mesh, cluster_of);
  std::map<std::int32_t, std::int32_t> depth;
  for (const auto& [clusters, triangles] : seams)
    for (const std::int32_t c : {clusters.first, clusters.second})
      if (!depth.contains(c)) depth[c] = meter.depth(c, seams);
  while (true) {
    const Merge best = best_merge(seams, depth);
    if (best.from == kNone) return;
    std::replace(cluster_of.begin(), cluster_of.end(), best.from, best.into);
    merge(seams, best.from, best.into);
    depth[best.into] = meter.depth(best.into, seams);
  }
}

std::vector<bool> inside(const TriangleMesh& mesh, std::span<const std::int32_t> cluster_of) {
  std::vector<bool> at_seam(mesh.vertex_count());
  for (std::size_t v = 0; v < at_seam.size(); ++v) {
    const std::span<const TriangleId> around = mesh.triangles_at(VertexId{static_cast<std::int32_t>(v)});
    at_seam[v] = std::ranges::any_of(
        around, [&](TriangleId t) { return cluster_of[+t] != cluster_of[+around.front()]; });
  }
  std::vector<bool> all(cluster_of.size());
  for (std::size_t t = 0; t < all.size(); ++t)
    all[t] = cluster_of[t] != kNone &&
             std::ranges::none_of(mesh.triangles()[t], [&](VertexId v) { return at_seam[+v]; });
  return all;
}

std::vector<std::int32_t> nearest_seams(const TriangleMesh& mesh, std::span<const std::int32_t> cluster_of) {
  std::vector<std::vector<TriangleId>> seeds;
  for (auto& [clusters, triangles] : seams_of(mesh, cluster_of)) seeds.push_back(triangles);
  const Rings rings = rings_from(mesh, seeds, kFar);
  std::map<std::int32_t, std::int32_t> depth;  // of each cluster
  for (std::size_t t = 0; t < cluster_of.size(); ++t) {
    std::int32_t& deepest = depth[cluster_of[t]];
    deepest = std::max(deepest, rings.distance[t] == kNone ? kFar : rings.distance[t]);
  }
  std::vector<std::int32_t> nearest = rings.seed;
  for (std::size_t t = 0; t < nearest.size(); ++t)
    if (rings.distance[t] > std::min(kReach, depth[cluster_of[t]] * kPartReached / kWhole))
      nearest[t] = kNone;
  return nearest;
}

}  // namespace cscd::fast
