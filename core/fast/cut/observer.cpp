#include "core/fast/cut/observer.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "core/base/random.h"
#include "core/fast/cut/best_viewpoint.h"

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

// Chooses a few of the vertices, with weights that make them the wanted point in the reference pose.
FollowingPoint following(std::span<const Vec3> positions, std::vector<VertexId> vertices,
                         const Vec3& wanted) {
  const std::size_t count = std::min(FollowingPoint::kMost, vertices.size());
  std::mt19937 random(kPreparationSeed);
  FollowingPoint best;
  double least = std::numeric_limits<double>::infinity();
  for (int draw = 0; draw < 50; ++draw) {
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

}  // namespace

FollowingPoint observer_of(const TriangleMesh& mesh, std::span<const Vec3> reference,
                           std::span<const TriangleId> triangles) {
  std::vector<Face> faces;
  std::vector<VertexId> vertices;
  Vec3 normal = Vec3::Zero();
  for (const TriangleId t : triangles) {
    faces.push_back(face_of(mesh, reference, t));
    normal += faces.back().normal;
    vertices.insert(vertices.end(), mesh.corners(t).begin(), mesh.corners(t).end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());

  FollowingPoint best = following(reference, vertices, best_viewpoint(faces));
  const View among = view(faces, best.at(reference));
  // A cluster of a closed surface bends round its observer nearly always. The few that do not gained nothing
  // on characters in motion.
  if (mesh.closed_and_oriented() || among.seen >= kEnough || !(normal.norm() > 0)) return best;
  double most = among.clarity;
  FollowingPoint off = polygon(reference, vertices, normal.normalized());
  for (const float height : kHeights) {
    off.stand_off(height);
    const double clarity = view(faces, off.at(reference)).clarity;
    if (clarity <= most) continue;
    most = clarity;
    best = off;
  }
  return best;
}

}  // namespace cscd::fast
