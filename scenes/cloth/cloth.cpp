#include "scenes/cloth/cloth.h"

#include <algorithm>
#include <cmath>

namespace cscd::scenes {
namespace {

// Lengths in thicknesses. A vertex moves at most kLongestStep in a step, so that it cannot pass another one
// unseen. Pairs within 1 + kSlack are found at once, and they serve until a vertex has moved kSlack / 2
// against the mean of all vertices.
constexpr double kLongestStep = 0.45;
constexpr double kSlack = 0.5;
// In gaps: a vertex that is deeper than this inside a body is not found.
constexpr double kDeepest = 2;

double volume_of(const TriangleMesh& mesh, std::span<const Vec3> positions) {
  double six = 0;
  for (const Triangle& t : mesh.triangles())
    six += positions[+t[0]].dot(positions[+t[1]].cross(positions[+t[2]]));
  return six / 6;
}

VertexId opposite(const Triangle& corners, const Edge& edge) {
  return *std::ranges::find_if(corners, [&](VertexId v) { return v != edge[0] && v != edge[1]; });
}

}  // namespace

Cloth::Cloth(const TriangleMesh& mesh, std::span<const Vec3> rest, const ClothOptions& options)
    : mesh_(mesh), options_(options), rest_volume_(volume_of(mesh, rest)), near_points_(mesh) {
  const auto between = [&](VertexId a, VertexId b) {
    return Distance{static_cast<int>(a), static_cast<int>(b), (rest[+a] - rest[+b]).norm()};
  };
  for (std::size_t i = 0; i < mesh.edge_count(); ++i) {
    const EdgeId id{static_cast<int>(i)};
    const Edge& edge = mesh.ends(id);
    edges_.push_back(between(edge[0], edge[1]));
    const auto sides = mesh.triangles_at(id);
    if (sides.size() == 2)
      bends_.push_back(
          between(opposite(mesh.corners(sides[0]), edge), opposite(mesh.corners(sides[1]), edge)));
  }
}

void Cloth::step(std::vector<Vec3>& positions, double h, std::span<const Led> led,
                 std::span<const BallObstacle> balls, std::optional<double> volume,
                 const MovingSurface* body) {
  predict(positions, h, led);
  if (options_.thickness > 0) find_close_vertices(positions);
  restore(positions, edges_, options_.stretch_compliance / (h * h));
  restore(positions, bends_, options_.bend_compliance / (h * h));
  if (volume) restore_volume(positions, *volume, options_.volume_compliance / (h * h));
  keep_outside(positions, balls);
  if (body) keep_off(positions, *body);
  if (options_.thickness > 0) {
    push_apart(positions);
    limit_speed(positions);
  }
  left_ = positions;
}

// Moves the vertices by inertia, drag, viscosity and gravity, and the led ones to their places. The velocity
// of a vertex contains all of its motion in the last step.
void Cloth::predict(std::vector<Vec3>& positions, double h, std::span<const Led> led) {
  if (before_.empty()) before_ = left_ = positions;
  for (std::size_t v = 0; v < positions.size(); ++v) before_[v] += (1 - h) * (positions[v] - left_[v]);
  const double kept = last_h_ > 0 ? std::max(0.0, 1 - options_.drag * h) * h / last_h_ : 0;
  moved_.resize(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) moved_[v] = kept * (positions[v] - before_[v]);
  if (const double share = std::min(0.5, options_.viscosity * h); share > 0)
    for (const Distance& edge : edges_) {
      Vec3 &a = moved_[static_cast<std::size_t>(edge.a)], &b = moved_[static_cast<std::size_t>(edge.b)];
      const Vec3 exchanged = share * (b - a);
      a += exchanged;
      b -= exchanged;
    }
  before_ = positions;
  for (std::size_t v = 0; v < positions.size(); ++v) positions[v] += moved_[v] + h * h * options_.gravity;
  last_h_ = h;
  inverse_mass_.assign(positions.size(), 1.0);
  for (const Led& one : led) {
    positions[+one.vertex] = one.place;
    inverse_mass_[+one.vertex] = 0;
  }
  if (options_.thickness > 0) limit_speed(positions);
}

void Cloth::restore(std::vector<Vec3>& positions, const std::vector<Distance>& distances,
                    double softness) const {
  for (const Distance& distance : distances) {
    const auto a = static_cast<std::size_t>(distance.a), b = static_cast<std::size_t>(distance.b);
    const double mass = inverse_mass_[a] + inverse_mass_[b];
    const Vec3 between = positions[b] - positions[a];
    const double length = between.norm();
    if (mass == 0 || length == 0) continue;
    const Vec3 move = (length - distance.rest) / ((mass + softness) * length) * between;
    positions[a] += inverse_mass_[a] * move;
    positions[b] -= inverse_mass_[b] * move;
  }
}

void Cloth::restore_volume(std::vector<Vec3>& positions, double volume, double softness) {
  gradient_.assign(positions.size(), Vec3::Zero());
  for (const Triangle& t : mesh_.triangles())
    for (std::size_t k = 0; k < 3; ++k)
      gradient_[+t[k]] += positions[+t[(k + 1) % 3]].cross(positions[+t[(k + 2) % 3]]) / 6;
  double sum = softness;
  for (std::size_t v = 0; v < positions.size(); ++v) sum += inverse_mass_[v] * gradient_[v].squaredNorm();
  if (sum == 0) return;
  const double pressure = (volume - volume_of(mesh_, positions)) / sum;
  for (std::size_t v = 0; v < positions.size(); ++v)
    positions[v] += inverse_mass_[v] * pressure * gradient_[v];
}

// Finds the pairs anew if vertices have moved so far against each other that others may have come close.
void Cloth::find_close_vertices(const std::vector<Vec3>& positions) {
  if (!searched_.empty()) {
    Vec3 mean = Vec3::Zero();
    for (std::size_t v = 0; v < positions.size(); ++v) mean += positions[v] - searched_[v];
    mean /= static_cast<double>(positions.size());
    double farthest = 0;
    for (std::size_t v = 0; v < positions.size(); ++v)
      farthest = std::max(farthest, (positions[v] - searched_[v] - mean).squaredNorm());
    const double allowed = kSlack / 2 * options_.thickness;
    if (farthest <= allowed * allowed) return;
  }
  searched_ = positions;
  const auto found = near_points_.find(positions, (1 + kSlack) * options_.thickness);
  close_.assign(found.begin(), found.end());
}

// Moves close pairs of vertices to the thickness. Where a pair was too close at the start of the step
// already, that part of the move counts as no motion, so that it does not fling the two apart in the steps
// that follow.
void Cloth::push_apart(std::vector<Vec3>& positions) {
  const double limit = options_.thickness * options_.thickness;
  for (const auto& [first, second] : close_) {
    const auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(second);
    const Vec3 gap = positions[b] - positions[a];
    const double squared = gap.squaredNorm(), mass = inverse_mass_[a] + inverse_mass_[b];
    if (squared >= limit || squared == 0 || mass == 0) continue;
    const double distance = std::sqrt(squared), depth = options_.thickness - distance;
    const Vec3 normal = gap / distance;
    const Vec3 gap_before = before_[b] - before_[a];
    const Vec3 slid = gap - gap_before;
    const double old_depth = std::clamp(options_.thickness - gap_before.norm(), 0.0, depth);
    const Vec3 move = (depth * normal - rubbed(slid - slid.dot(normal) * normal, depth)) / mass;
    positions[a] -= inverse_mass_[a] * move;
    positions[b] += inverse_mass_[b] * move;
    const Vec3 motionless = old_depth / mass * normal;
    before_[a] -= inverse_mass_[a] * motionless;
    before_[b] += inverse_mass_[b] * motionless;
  }
}

void Cloth::keep_outside(std::vector<Vec3>& positions, std::span<const BallObstacle> balls) const {
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (inverse_mass_[v] == 0) continue;
    Vec3& place = positions[v];
    for (const BallObstacle& ball : balls) {
      const Vec3 from = place - ball.end;
      const double distance = from.norm(), depth = ball.radius - distance;
      if (depth <= 0 || distance == 0) continue;
      const Vec3 normal = from / distance;
      const Vec3 slid = (place - before_[v]) - (ball.end - ball.start);
      place += depth * normal - rubbed(slid - slid.dot(normal) * normal, depth);
    }
    if (!options_.floor) continue;
    const double depth = *options_.floor - place.z();
    if (depth <= 0) continue;
    Vec3 slid = place - before_[v];
    slid.z() = 0;
    place -= rubbed(slid, depth);
    place.z() += depth;
  }
}

void Cloth::keep_off(std::vector<Vec3>& positions, const MovingSurface& body) const {
  Vec3 low = positions.front(), high = positions.front();
  for (const Vec3& position : positions) {
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }
  body.near.place(body.end, low, high, kDeepest * body.gap);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (inverse_mass_[v] == 0) continue;
    const auto nearest = body.near.nearest(positions[v]);
    if (!nearest || nearest->distance >= body.gap) continue;
    const double depth = body.gap - nearest->distance;
    Vec3 carried = Vec3::Zero();
    const Triangle& corners = body.near.mesh().corners(nearest->triangle);
    for (std::size_t k = 0; k < 3; ++k)
      carried +=
          nearest->weights[static_cast<Eigen::Index>(k)] * (body.end[+corners[k]] - body.start[+corners[k]]);
    const Vec3 slid = (positions[v] - before_[v]) - carried;
    positions[v] +=
        depth * nearest->outward - rubbed(slid - slid.dot(nearest->outward) * nearest->outward, depth);
  }
}

void Cloth::limit_speed(std::vector<Vec3>& positions) const {
  const double most = kLongestStep * options_.thickness;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (inverse_mass_[v] == 0) continue;
    const Vec3 moved = positions[v] - before_[v];
    const double squared = moved.squaredNorm();
    if (squared > most * most) positions[v] = before_[v] + most / std::sqrt(squared) * moved;
  }
}

// The part of a slip that friction undoes.
Vec3 Cloth::rubbed(const Vec3& slip, double depth) const {
  const double length = slip.norm();
  if (length == 0) return Vec3::Zero();
  return std::min(1.0, options_.friction * depth / length) * slip;
}

}  // namespace cscd::scenes
