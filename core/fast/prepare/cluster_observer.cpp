#include "core/fast/prepare/cluster_observer.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/fast/clusters/best_viewpoint.h"

namespace cscd::fast {
namespace {

// A face is seen if the cosine between ray and normal is at least this.
constexpr double kSeen = 0.2;
// Of a face that is seen with a cosine of this or more, nothing better is to be had.
constexpr double kSeenWell = 0.8;
// An observer among the vertices is taken if it sees this share of the faces. It stays among them when they
// bend, where one that stands off is left behind.
constexpr double kEnough = 0.5;
// How far an observer may stand off, in units of the square root of its polygon's area. From farther away,
// cones of directions are too blunt to tell patches apart.
constexpr float kHeights[] = {-0.5F, -1, -2, -4};

// The best viewpoint of a cluster is found from at most this many of its faces, spread evenly.
constexpr std::size_t kManyFaces = 512;
// Vertices to follow are drawn from the half of a cluster's vertices that is nearest to the observer, but
// from no fewer than these.
constexpr std::size_t kFewestNear = 32;
// The number of times that vertices to follow are drawn.
constexpr int kDraws = 50;
// The same for a search in a hurry, its steps towards the best viewpoint, and the number of faces it looks
// at.
constexpr int kFewDraws = 8, kFewSteps = 60;
constexpr std::size_t kFewFaces = 128;

// Returns the half of the vertices that is nearest to the point.
std::vector<VertexId> nearest_half(std::span<const Vec3> positions, std::vector<VertexId> vertices,
                                   const Vec3& point) {
  const std::size_t near = std::max(kFewestNear, vertices.size() / 2);
  if (near >= vertices.size()) return vertices;
  std::ranges::nth_element(vertices, vertices.begin() + static_cast<std::ptrdiff_t>(near), {},
                           [&](VertexId v) { return (positions[+v] - point).squaredNorm(); });
  vertices.resize(near);
  return vertices;
}

// Chooses a few of the vertices, with weights that make them the wanted point in the reference pose.
FollowingPoint following(std::span<const Vec3> positions, std::vector<VertexId> vertices, const Vec3& wanted,
                         int draws) {
  const std::size_t count = std::min(FollowingPoint::kMost, vertices.size());
  std::mt19937 random(kPreparationSeed);
  FollowingPoint best;
  double least = std::numeric_limits<double>::infinity();
  for (int draw = 0; draw < draws; ++draw) {
    for (std::size_t i = 0; i < count; ++i)
      std::swap(vertices[i], vertices[i + random() % (vertices.size() - i)]);
    const double n = static_cast<double>(count);
    Vec3 mean = Vec3::Zero();
    for (std::size_t i = 0; i < count; ++i) mean += positions[+vertices[i]] / n;
    // This is the smallest change of equal weights that moves their mean to the wanted point.
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 x = positions[+vertices[i]] - mean;
      spread += x * x.transpose();
    }
    const double extent = spread.trace();
    spread += 1e-3 * extent * Eigen::Matrix3d::Identity();
    const Vec3 slope = spread.inverse() * (wanted - mean);
    if (!slope.allFinite()) continue;
    FollowingPoint point;
    Vec3 got = Vec3::Zero();
    double largest = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double weight = 1 / n + slope.dot(positions[+vertices[i]] - mean);
      point.add(vertices[i], static_cast<float>(weight));
      got += weight * positions[+vertices[i]];
      largest = std::max(largest, n * std::abs(weight));
    }
    if (!(largest <= FollowingPoint::kMostWeight)) continue;  // the point is too far from these vertices
    const double cost = largest + 10 * (got - wanted).norm() / std::sqrt(extent);
    if (!(cost < least)) continue;
    least = cost;
    best = point;
  }
  if (best.vertices().empty()) best.add(vertices.front(), 1);  // the cluster has no extent
  return best;
}

// Chooses the farthest vertex in each of sixteen directions round the normal: a polygon that carries it.
FollowingPoint polygon(std::span<const Vec3> positions, std::span<const VertexId> vertices,
                       const Vec3& normal) {
  Vec3 middle = Vec3::Zero();
  for (const VertexId v : vertices) middle += positions[+v] / static_cast<double>(vertices.size());
  const Vec3 x = normal.unitOrthogonal(), y = normal.cross(x);
  struct Farthest {
    double distance = 0;
    VertexId vertex{-1};
  } farthest[FollowingPoint::kMost];
  for (const VertexId v : vertices) {
    const Vec3 to = positions[+v] - middle;
    const double across = to.dot(x), up = to.dot(y), distance = std::hypot(across, up);
    const double turn = 0.5 + std::atan2(up, across) / (2 * std::numbers::pi);
    const auto sector = static_cast<std::size_t>(turn * static_cast<double>(FollowingPoint::kMost));
    Farthest& here = farthest[std::min(sector, FollowingPoint::kMost - 1)];
    if (distance > here.distance) here = {distance, v};
  }
  const auto corners = std::count_if(std::begin(farthest), std::end(farthest),
                                     [](const Farthest& f) { return f.distance > 0; });
  FollowingPoint point;
  for (const Farthest& f : farthest)
    if (f.distance > 0) point.add(f.vertex, 1 / static_cast<float>(corners));
  return point;
}

struct View {
  double seen = 0;     // the share of the faces that are seen
  double clarity = 0;  // how well, as a mean over all faces; 1 at most
};
View view(std::span<const Face> faces, const Vec3& from) {
  View out;
  const double each = 1 / static_cast<double>(faces.size());
  for (const Face& f : faces) {
    const Vec3 ray = f.centre - from;
    const double distance = ray.norm(), cosine = distance > 0 ? f.normal.dot(ray) / distance : 0;
    if (cosine < kSeen) continue;
    out.seen += each;
    out.clarity += each * std::min(1.0, cosine / kSeenWell);
  }
  return out;
}

// What an observer is chosen by.
struct Looked {
  std::vector<Face> faces;
  std::vector<VertexId> vertices;
  Vec3 normal = Vec3::Zero();  // the sum of all normals
};
Looked looked_at(const TriangleMesh& mesh, std::span<const Vec3> positions,
                 std::span<const TriangleId> triangles, std::size_t stride) {
  Looked all;
  std::vector<bool> met(mesh.vertex_count());
  for (std::size_t i = stride / 2; i < triangles.size(); i += stride) {
    const TriangleId t = triangles[i];
    all.faces.push_back(face_of(mesh, positions, t));
    all.normal += all.faces.back().normal;
    for (const VertexId v : mesh.corners(t)) {
      if (!met[+v]) all.vertices.push_back(v);
      met[+v] = true;
    }
  }
  return all;
}

// The same in a hurry: few of the triangles, spread over all of them.
Looked briefly_looked_at(const TriangleMesh& mesh, std::span<const Vec3> positions,
                         std::span<const TriangleId> triangles) {
  return looked_at(mesh, positions, triangles, (triangles.size() + kFewFaces - 1) / kFewFaces);
}

// Calls take(observer, its view) for observers at several heights behind the cluster.
template <class Take>
void for_each_stand_off(const Looked& all, std::span<const Vec3> positions, const Take& take) {
  if (!(all.normal.norm() > 0)) return;
  FollowingPoint off = polygon(positions, all.vertices, all.normal.normalized());
  for (const float height : kHeights) {
    off.stand_off(height);
    take(off, view(all.faces, off.at(positions)));
  }
}

}  // namespace

FollowingPoint observer_of(const TriangleMesh& mesh, std::span<const Vec3> reference,
                           std::span<const TriangleId> triangles) {
  const Looked all = looked_at(mesh, reference, triangles, 1);
  std::vector<Face> some;
  const std::size_t stride = (all.faces.size() + kManyFaces - 1) / kManyFaces;
  for (std::size_t i = 0; i < all.faces.size(); i += stride) some.push_back(all.faces[i]);
  const Vec3 wanted = best_viewpoint(some);
  // Where a limb bends, vertices far away move otherwise than what lies round the point.
  FollowingPoint best = following(
      reference, mesh.closed_and_oriented() ? nearest_half(reference, all.vertices, wanted) : all.vertices,
      wanted, kDraws);
  const View among = view(all.faces, best.at(reference));
  // A cluster of a closed surface bends round its observer nearly always. The few that do not gained nothing
  // on characters in motion.
  if (mesh.closed_and_oriented() || among.seen >= kEnough) return best;
  double most = among.clarity;
  for_each_stand_off(all, reference, [&](const FollowingPoint& off, const View& seen) {
    if (seen.clarity <= most) return;
    most = seen.clarity;
    best = off;
  });
  return best;
}

Sight brief_sight_of(const TriangleMesh& mesh, std::span<const Vec3> positions,
                     std::span<const TriangleId> triangles) {
  const Looked all = briefly_looked_at(mesh, positions, triangles);
  Sight best{following(positions, all.vertices, best_viewpoint(all.faces, kFewSteps), kFewDraws), 0};
  View most = view(all.faces, best.from.at(positions));
  for_each_stand_off(all, positions, [&](const FollowingPoint& off, const View& seen) {
    if (std::pair(seen.seen, seen.clarity) <= std::pair(most.seen, most.clarity)) return;
    most = seen;
    best.from = off;
  });
  best.seen = most.seen;
  return best;
}

double brief_share_seen(const TriangleMesh& mesh, std::span<const Vec3> positions,
                        std::span<const TriangleId> triangles, const FollowingPoint& from) {
  return view(briefly_looked_at(mesh, positions, triangles).faces, from.at(positions)).seen;
}

}  // namespace cscd::fast
