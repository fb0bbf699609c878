#include "bench/answer/joints.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "bench/inputs/ignore.h"

namespace cscd::bench {
namespace {

// The mean and the spread of the corners of triangles, each weighted by its triangle's area.
class Spread {
 public:
  void add(const Vec3& x, double weight) {
    weight_ += weight;
    sum_ += weight * x;
    squares_ += weight * x * x.transpose();
  }
  // Returns the circumference of the round limb that has the same spread. Across a round limb of radius r the
  // variance is r * r / 2 in both directions, and along the limb it is mostly larger: the middle one counts.
  double girth() const {
    if (!(weight_ > 0)) return 0;
    const Vec3 mean = sum_ / weight_;
    const Eigen::Matrix3d variance = squares_ / weight_ - mean * mean.transpose();
    const double middle = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(variance).eigenvalues()[1];
    return 2 * std::numbers::pi * std::sqrt(2 * std::max(0.0, middle));
  }

 private:
  double weight_ = 0;
  Vec3 sum_ = Vec3::Zero();
  Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();
};

}  // namespace

Joints::Joints(const Input& input, const SurfaceNames& names) {
  const TriangleMesh& mesh = input.mesh;
  const std::span<const Vec3> rest = input.rest();
  std::map<std::int32_t, std::string> place;  // by number; those of bones are not negative
  std::map<std::int32_t, Spread> spread;
  std::vector<std::int32_t> number;  // [triangles]
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const TriangleId triangle{static_cast<std::int32_t>(t)};
    number.push_back(names.place_number(triangle));
    place.try_emplace(number.back(), names.place_of(triangle));
    const Triangle& c = mesh.corners(triangle);
    const double area = (rest[+c[1]] - rest[+c[0]]).cross(rest[+c[2]] - rest[+c[0]]).norm() / 2;
    for (const VertexId corner : c) spread[number.back()].add(rest[+corner], area / 3);
  }
  for (const auto& [n, name] : place) {
    const double girth = spread[n].girth();
    const auto [known, added] = girth_.try_emplace(name, girth);
    if (!added) known->second = std::min(known->second, girth);
  }
  const auto join = [&](std::int32_t a, std::int32_t b) {
    joined_.emplace(place[a], place[b]);
    joined_.emplace(place[b], place[a]);
  };
  const std::vector<std::set<std::int32_t>> near = bones_within(input.clip->header().bone_parent, 1);
  if (near.size() == 1) return;  // one node moves the whole surface, and has no joint
  for (const auto& [bone, name] : place)
    if (bone >= 0 && static_cast<std::size_t>(bone) < near.size())
      for (const std::int32_t other : near[static_cast<std::size_t>(bone)])
        if (place.contains(other)) join(bone, other);
  if (!near.empty()) return;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const std::span<const TriangleId> around = mesh.triangles_at(VertexId{static_cast<std::int32_t>(v)});
    for (const TriangleId t : around)
      for (const TriangleId other : around)
        if (number[+t] != number[+other]) join(number[+t], number[+other]);
  }
}

bool Joints::join(const NamePair& both) const {
  return joined_.contains(both);
}

bool Joints::fold(const OverlapEvent& event) const {
  if (!join(event.names)) return false;
  const double girth = std::min(girth_.at(event.names.first), girth_.at(event.names.second));
  return (is_known(event.depth) ? event.depth.lower : event.depth.upper) < kShare * girth;
}

}  // namespace cscd::bench
