#include "core/radial/orientation.h"

#include <algorithm>
#include <cmath>
#include <limits>

// Idea: towards a point q the orientation of a triangle is the sign of normal(t) . (p(t) - q(t)) for any one
// corner p, a cubic in t whose Bernstein coefficients prove a sign when they exceed their forward error bound
// (trap 4).
//
// Towards a segment the viewing position q(u) slides with the projection u of each point, clamped to [0, 1].
// The dot product is linear in u, and u is monotone in the projection, which over a triangle is extreme at a
// corner. So with [low, high] enclosing the clamped projections of all three corners over the interval, one
// sign at both q(low) and q(high) holds at every viewing position in use (trap 2). Two cubics, instead of the
// paper's rational function of degree five at one arbitrary vertex.
//
// A sign is a proof; `uncertain` is not. About 40 operations a triangle and point observer, vectorised.
namespace cscd::radial {
namespace {

constexpr double kErrorFactor = 72 * kUnitRoundoff;  // see triple_product
constexpr double kTiny = 1e-280, kHuge = 1e300;

Orientation from_sign(int sign) {
  return sign > 0 ? Orientation::positive : sign < 0 ? Orientation::negative : Orientation::uncertain;
}

MovingVector between(const MovingPoint& from, const MovingPoint& to) {
  return {to.start - from.start, to.end - from.end};
}

// Towards the moving point q, itself known up to `slack` in each coordinate.
Orientation towards_point(const MovingPoint (&corner)[3], const MovingPoint& q, double slack) {
  return from_sign(certain_sign(triple_product(between(corner[0], corner[1]), between(corner[0], corner[2]),
                                               between(q, corner[0]), slack)));
}

struct Range {
  double low, high;
};

// Encloses the clamped projection parameters of a triangle's corners on the moving segment.
Range viewing_range(const MovingPoint (&corner)[3], const MovingPoint& head, const MovingPoint& tail) {
  const MovingVector d = between(head, tail);
  const double length[3] = {d.start.squaredNorm(), d.start.dot(d.end), d.end.squaredNorm()};
  const double shortest = std::min({length[0], length[1], length[2]});
  const double longest = std::max({length[0], length[1], length[2]});
  if (!(shortest > 0)) return {0, 1};
  double low = std::numeric_limits<double>::infinity(), high = -low, reach = 0;
  for (const MovingPoint& p : corner) {
    const MovingVector w = between(head, p);
    const double along[3] = {w.start.dot(d.start), (w.start.dot(d.end) + w.end.dot(d.start)) / 2,
                             w.end.dot(d.end)};
    low = std::min({low, along[0], along[1], along[2]});
    high = std::max({high, along[0], along[1], along[2]});
    reach = std::max(reach, w.largest());
  }
  // A dot product of differences is off by at most 6 u times three products; 32 also covers the division.
  const double slack = 32 * kUnitRoundoff * (1 + 3 * reach * d.largest() / shortest);
  const Range range{low / (low < 0 ? shortest : longest) - slack,
                    high / (high < 0 ? longest : shortest) + slack};
  const bool known = range.low <= range.high;  // false for NaN
  return known ? Range{std::clamp(range.low, 0.0, 1.0), std::clamp(range.high, 0.0, 1.0)} : Range{0, 1};
}

Orientation towards_segment(const MovingPoint (&corner)[3], const MovingPoint& head,
                            const MovingPoint& tail) {
  const Range range = viewing_range(corner, head, tail);
  // q(u) is rounded in two operations on each coordinate.
  const auto largest = [](const Vec3& v) { return v.cwiseAbs().maxCoeff(); };
  const double slack =
      4 * kUnitRoundoff *
      std::max({largest(head.start), largest(head.end), largest(tail.start), largest(tail.end)});
  const auto at = [&](double u) -> MovingPoint {
    return {(1 - u) * head.start + u * tail.start, (1 - u) * head.end + u * tail.end};
  };
  const Orientation first = towards_point(corner, at(range.low), slack);
  if (first == Orientation::uncertain || range.low == range.high) return first;
  return towards_point(corner, at(range.high), slack) == first ? first : Orientation::uncertain;
}

}  // namespace

Orientation orientation(const MovingPoint (&corner)[3], const Observer& observer) {
  if (observer.is_segment) return towards_segment(corner, observer.head, observer.tail);
  return towards_point(corner, observer.head, 0);
}

OrientationTable::OrientationTable(const TriangleMesh& mesh, std::span<const std::vector<TriangleId>> groups)
    : mesh_(mesh) {
  for (const std::vector<TriangleId>& group : groups) {
    first_block_.push_back(lanes_.size());
    for (std::size_t first = 0; first < group.size(); first += kLanes) {
      std::array<std::int32_t, kLanes>& lane = lanes_.emplace_back();
      for (std::size_t l = 0; l < kLanes; ++l)
        lane[l] = static_cast<std::int32_t>(group[std::min(first + l, group.size() - 1)]);
    }
  }
  first_block_.push_back(lanes_.size());
  blocks_.resize(lanes_.size());
}

void OrientationTable::update(const Motion& motion) {
  motion_ = motion;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    Block& block = blocks_[b];
    Row a[2][3], c[2][3];  // the edges from the first corner, at both ends, by component
    for (std::size_t l = 0; l < kLanes; ++l) {
      const Triangle& corner = mesh_.triangles()[static_cast<std::size_t>(lanes_[b][l])];
      for (int end = 0; end < 2; ++end) {
        const std::span<const Vec3> x = end == 0 ? motion.start() : motion.end();
        const Vec3 &p = x[+corner[0]], &q = x[+corner[1]], &r = x[+corner[2]];
        for (int i = 0; i < 3; ++i) {
          block.corner[end][i][l] = p[i];
          a[end][i][l] = q[i] - p[i];
          c[end][i][l] = r[i] - p[i];
        }
      }
    }
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      for (std::size_t l = 0; l < kLanes; ++l) {
        block.normal[0][i][l] = a[0][j][l] * c[0][k][l] - a[0][k][l] * c[0][j][l];
        block.normal[1][i][l] = (a[0][j][l] * c[1][k][l] - a[0][k][l] * c[1][j][l]) +
                                (a[1][j][l] * c[0][k][l] - a[1][k][l] * c[0][j][l]);
        block.normal[2][i][l] = a[1][j][l] * c[1][k][l] - a[1][k][l] * c[1][j][l];
      }
    }
    for (std::size_t l = 0; l < kLanes; ++l) {
      double largest_a = 0, largest_c = 0;
      for (int end = 0; end < 2; ++end)
        for (int i = 0; i < 3; ++i) {
          largest_a = std::max(largest_a, std::abs(a[end][i][l]));
          largest_c = std::max(largest_c, std::abs(c[end][i][l]));
        }
      block.area[l] = largest_a * largest_c;
    }
  }
}

void OrientationTable::classify(std::size_t group, const Observer& observer,
                                std::span<Orientation> out) const {
  if (observer.is_segment) {
    for (std::size_t member = 0; member < out.size(); ++member)
      out[member] = classify(group, member, observer);
    return;
  }
  const Vec3 &q0 = observer.head.start, &q1 = observer.head.end;
  for (std::size_t b = first_block_[group], first = 0; first < out.size(); ++b, first += kLanes) {
    const Block& block = blocks_[b];
    std::array<std::uint8_t, kLanes> result;
    for (std::size_t l = 0; l < kLanes; ++l) {
      const double x0 = block.corner[0][0][l] - q0.x(), y0 = block.corner[0][1][l] - q0.y(),
                   z0 = block.corner[0][2][l] - q0.z();
      const double x1 = block.corner[1][0][l] - q1.x(), y1 = block.corner[1][1][l] - q1.y(),
                   z1 = block.corner[1][2][l] - q1.z();
      const auto dot = [&block, l](int n, double x, double y, double z) {
        return block.normal[n][0][l] * x + block.normal[n][1][l] * y + block.normal[n][2][l] * z;
      };
      const double k0 = dot(0, x0, y0, z0), k1 = (dot(1, x0, y0, z0) + dot(0, x1, y1, z1)) / 3,
                   k2 = (dot(1, x1, y1, z1) + dot(2, x0, y0, z0)) / 3, k3 = dot(2, x1, y1, z1);
      const double distance = std::max(std::max(std::max(std::abs(x0), std::abs(y0)), std::abs(z0)),
                                       std::max(std::max(std::abs(x1), std::abs(y1)), std::abs(z1)));
      const double volume = block.area[l] * distance;
      const bool known = (block.area[l] >= kTiny) & (volume >= kTiny) & (volume <= kHuge);
      const double error = known ? kErrorFactor * volume : std::numeric_limits<double>::infinity();
      const double low = std::min(std::min(k0, k1), std::min(k2, k3));
      const double high = std::max(std::max(k0, k1), std::max(k2, k3));
      result[l] = low > error ? 1 : high < -error ? 2 : 4;
    }
    const std::size_t count = std::min(kLanes, out.size() - first);
    for (std::size_t l = 0; l < count; ++l) out[first + l] = static_cast<Orientation>(result[l]);
  }
}

Orientation OrientationTable::classify(std::size_t group, std::size_t member,
                                       const Observer& observer) const {
  const std::size_t block = first_block_[group] + member / kLanes;
  const Triangle& c = mesh_.triangles()[static_cast<std::size_t>(lanes_[block][member % kLanes])];
  const Motion& m = *motion_;
  return orientation({m[c[0]], m[c[1]], m[c[2]]}, observer);
}

}  // namespace cscd::radial
