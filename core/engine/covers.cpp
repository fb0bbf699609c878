#include "core/engine/covers.h"

#include <algorithm>
#include <map>
#include <queue>
#include <random>

namespace cscd::fast {
namespace {

constexpr std::size_t kViewedFrom = 16;  // vertices at most

Vec3 centroid(const TriangleMesh& mesh, std::span<const Vec3> positions, TriangleId triangle) {
  const Triangle& c = mesh.corners(triangle);
  return positions[+c[0]] / 3 + positions[+c[1]] / 3 + positions[+c[2]] / 3;
}

Vec3 mean(std::span<const Vec3> positions, std::span<const VertexId> vertices) {
  Vec3 sum = Vec3::Zero();
  for (const VertexId v : vertices) sum += positions[+v] / static_cast<double>(vertices.size());
  return sum;
}

// Few of the vertices whose mean is near that of all: the best of some draws.
std::vector<VertexId> thinned(std::vector<VertexId> vertices, std::span<const Vec3> positions) {
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  if (vertices.size() <= kViewedFrom) return vertices;
  const Vec3 wanted = mean(positions, vertices);
  std::mt19937 random(20140314);
  std::vector<VertexId> best;
  double nearest = 0;
  for (int draw = 0; draw < 200; ++draw) {
    for (std::size_t i = 0; i < kViewedFrom; ++i)
      std::swap(vertices[i], vertices[i + random() % (vertices.size() - i)]);
    const std::span<const VertexId> chosen = std::span(vertices).first(kViewedFrom);
    const double distance = (mean(positions, chosen) - wanted).norm();
    if (best.empty() || distance < nearest) {
      best.assign(chosen.begin(), chosen.end());
      nearest = distance;
    }
  }
  return best;
}

// Every triangle goes to the seed from which the way over centroids of neighbouring triangles is shortest.
std::vector<std::int32_t> nearest_seed(const TriangleMesh& mesh, std::span<const Vec3> positions,
                                       const std::vector<std::vector<TriangleId>>& seeds) {
  struct Reached {
    double distance;
    std::int32_t seed;
    TriangleId triangle;
    bool operator<(const Reached& other) const {  // the top of a queue is its largest
      return std::tie(other.distance, other.seed, other.triangle) < std::tie(distance, seed, triangle);
    }
  };
  std::priority_queue<Reached> front;
  for (std::size_t s = 0; s < seeds.size(); ++s)
    for (const TriangleId t : seeds[s]) front.push({0, static_cast<std::int32_t>(s), t});
  std::vector<std::int32_t> seed_of(mesh.triangle_count(), kNone);
  while (!front.empty()) {
    const auto [distance, seed, triangle] = front.top();
    front.pop();
    if (seed_of[+triangle] != kNone) continue;
    seed_of[+triangle] = seed;
    const Vec3 here = centroid(mesh, positions, triangle);
    for (const EdgeId e : mesh.edges_of(triangle))
      for (const TriangleId next : mesh.triangles_at(e))
        if (seed_of[+next] == kNone)
          front.push({distance + (centroid(mesh, positions, next) - here).norm(), seed, next});
  }
  return seed_of;
}

}  // namespace

Covers make_covers(const TriangleMesh& mesh, std::span<const Vec3> reference,
                   const radial::AtomicClusters& atomic) {
  Covers covers;
  Cover& bones = covers[0];
  bones.cluster_of = atomic.of_triangle;
  for (const radial::AtomicClusters::Cluster& cluster : atomic.clusters) {
    std::vector<VertexId> vertices;
    for (const TriangleId t : cluster.triangles)
      vertices.insert(vertices.end(), mesh.corners(t).begin(), mesh.corners(t).end());
    bones.viewed_from.push_back(thinned(std::move(vertices), reference));
  }

  struct Seam {
    std::vector<VertexId> vertices;
    std::vector<TriangleId> triangles;
  };
  std::map<std::pair<std::int32_t, std::int32_t>, Seam> seams;  // of each two clusters
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    const EdgeId edge{static_cast<std::int32_t>(e)};
    const std::span<const TriangleId> sides = mesh.triangles_at(edge);
    const std::int32_t a = bones.cluster_of[+sides.front()], b = bones.cluster_of[+sides.back()];
    if (a == b) continue;
    Seam& seam = seams[std::minmax(a, b)];
    seam.vertices.insert(seam.vertices.end(), mesh.ends(edge).begin(), mesh.ends(edge).end());
    seam.triangles.insert(seam.triangles.end(), {sides.front(), sides.back()});
  }
  Cover& joints = covers[1];
  std::vector<std::vector<TriangleId>> seeds;
  for (auto& [clusters, seam] : seams) {
    joints.viewed_from.push_back(thinned(std::move(seam.vertices), reference));
    seeds.push_back(std::move(seam.triangles));
  }
  joints.cluster_of = nearest_seed(mesh, reference, seeds);
  // A component without a seam is one cluster in both.
  std::map<std::int32_t, std::int32_t> whole;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (joints.cluster_of[t] != kNone) continue;
    const std::int32_t cluster = bones.cluster_of[t];
    const auto [entry, fresh] =
        whole.try_emplace(cluster, static_cast<std::int32_t>(joints.viewed_from.size()));
    if (fresh) joints.viewed_from.push_back(bones.viewed_from[static_cast<std::size_t>(cluster)]);
    joints.cluster_of[t] = entry->second;
  }
  return covers;
}

}  // namespace cscd::fast
