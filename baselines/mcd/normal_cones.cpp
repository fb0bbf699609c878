#include "baselines/mcd/normal_cones.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/bernstein.h"

namespace cscd::mcd {
namespace {

// Outside this range, squares of normals could overflow or lose more than a relative rounding.
constexpr double kSmallArea = 1e-120, kLargeArea = 1e120;

// Pays for every rounding between two vectors and the cosine of their angle: two lengths, a dot product, a
// division, and an axis whose length is not quite 1. Together these are about 16 u.
constexpr double kCosineSlack = 32 * kUnitRoundoff;

NormalCone cone(const Vec3& axis, double cosine) {
  if (!(cosine > 0)) return {};
  cosine = std::min(cosine, 1.0);
  return {axis, cosine, std::sqrt(1 - cosine * cosine + 4 * kUnitRoundoff) * (1 + 4 * kUnitRoundoff)};
}

// Returns a lower bound of the cosine of the angle between an axis and whatever `child` contains. That angle
// is at most the sum of the angle between both axes and the half angle of `child`.
double cosine_towards(const Vec3& axis, const NormalCone& child) {
  const double between = std::min(axis.dot(child.axis), 1.0) - kCosineSlack;
  if (!(between > 0)) return -1;
  const double sine = std::sqrt(1 - between * between + 4 * kUnitRoundoff) * (1 + 4 * kUnitRoundoff);
  return between * child.cosine - sine * child.sine - kCosineSlack;
}

}  // namespace

NormalCone cone_around(const std::array<Vec3, 3>& control, double area) {
  if (!(area >= kSmallArea && area <= kLargeArea)) return {};
  const double error = 64 * kUnitRoundoff * area;
  const Vec3 sum = control[0] + control[1] + control[2];
  const double length = sum.norm();
  if (!(length > error)) return {};
  const Vec3 axis = sum / length;
  double cosine = 1;
  for (const Vec3& normal : control)
    cosine = std::min(cosine, (normal.dot(axis) - error) / (normal.norm() + error) - kCosineSlack);
  return cone(axis, cosine);
}

NormalCone merged(const NormalCone& a, const NormalCone& b) {
  if (!a.in_half_space() || !b.in_half_space()) return {};
  // The new axis lies nearer to the wider cone. Using sines in place of angles, this is nearly
  // the smallest cone around both.
  const double apart = (a.axis - b.axis).norm();
  const double to_a = std::max(0.0, apart + a.sine - b.sine), to_b = std::max(0.0, apart + b.sine - a.sine);
  const Vec3 sum = to_a + to_b > 0 ? Vec3(to_a * a.axis + to_b * b.axis) : a.axis;
  const double length = sum.norm();
  if (!(length > 0)) return {};
  const Vec3 axis = sum / length;
  return cone(axis, std::min(cosine_towards(axis, a), cosine_towards(axis, b)));
}

NormalCones::NormalCones(const TriangleMesh& mesh, const Tree& tree, Pipeline pipeline)
    : mesh_(mesh), pipeline_(pipeline), node_(tree.node_count()) {
  std::size_t lane = kLanes;
  for (NodeIndex node = 0; node < static_cast<NodeIndex>(tree.node_count()); ++node) {
    if (!tree.is_leaf(node)) continue;
    if (lane == kLanes) {
      lanes_.emplace_back();
      lane = 0;
    }
    for (std::size_t l = lane; l < kLanes; ++l) {
      lanes_.back().node[l] = node;
      for (std::size_t k = 0; k < 3; ++k)
        lanes_.back().corner[k].set(l, mesh.corners(tree.triangle(node))[k]);
    }
    ++lane;
  }
}

void NormalCones::update(const Tree& tree, const Motion& motion) {
  if (pipeline_ == Pipeline::published)
    update_leaves_one_by_one(tree, motion);
  else
    update_leaves(motion);
  // Children have larger numbers than their parents, so this visits them first.
  for (auto node = static_cast<NodeIndex>(tree.node_count()) - 1; node >= 0; --node)
    if (!tree.is_leaf(node))
      node_[static_cast<std::size_t>(node)] = merged((*this)[tree.left(node)], (*this)[tree.right(node)]);
}

void NormalCones::update_leaves(const Motion& motion) {
  for (const LeafLanes& lanes : lanes_) {
    const auto& [first, second, third] = lanes.corner;
    const VectorLanes corner = gather(motion, first);
    const NormalLanes normal = cross(gather(motion, second) - corner, gather(motion, third) - corner);
    for (std::size_t l = 0; l < kLanes; ++l) {
      std::array<Vec3, 3> control;
      for (std::size_t i = 0; i < 3; ++i)
        control[i] = {normal.control[i][0][l], normal.control[i][1][l], normal.control[i][2][l]};
      node_[static_cast<std::size_t>(lanes.node[l])] = cone_around(control, normal.area[l]);
    }
  }
}

void NormalCones::update_leaves_one_by_one(const Tree& tree, const Motion& motion) {
  for (NodeIndex node = 0; node < static_cast<NodeIndex>(tree.node_count()); ++node) {
    if (!tree.is_leaf(node)) continue;
    const auto [p, q, r] = mesh_.corners(tree.triangle(node));
    const MovingPoint corner = motion[p], second = motion[q], third = motion[r];
    const MovingNormal normal = moving_cross({second.start - corner.start, second.end - corner.end},
                                             {third.start - corner.start, third.end - corner.end});
    node_[static_cast<std::size_t>(node)] =
        cone_around({normal.at[0], normal.at[1], normal.at[2]}, normal.area);
  }
}

}  // namespace cscd::mcd
