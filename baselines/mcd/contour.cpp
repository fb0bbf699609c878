#include "baselines/mcd/contour.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/rounding.h"

namespace cscd::mcd {
namespace {

// A difference of two projected points at both ends of the interval.
struct Arrow {
  double start[2], end[2];
  double largest() const {
    return std::max(std::max(std::abs(start[0]), std::abs(start[1])),
                    std::max(std::abs(end[0]), std::abs(end[1])));
  }
};

// Returns the sign of a quadratic in t if it is certain for all t in [0, 1], else 0. The quadratic is a sum
// of two products of components of two arrows, and `product` gives its polar form. Let `off` bound the error
// of the arrows' coordinates, and d be the sum of the largest coordinates. Two products are off by at most 2
// (d off + off^2) + 3 u d^2. The larger factors in the code also pay for the roundings of the bound.
template <class Product>
int certain_sign(const Arrow& a, const Arrow& b, double off, const Product& product) {
  const double c0 = product(a.start, b.start), c2 = product(a.end, b.end);
  const double c1 = (product(a.start, b.end) + product(a.end, b.start)) / 2;
  const double d = a.largest() + b.largest();
  const double error = 8 * d * off + 4 * off * off + 16 * kUnitRoundoff * d * d;
  if (!(error > 1e-280 && error < 1e280)) return 0;  // underflow, overflow or NaN on the way
  return (c0 > error && c1 > error && c2 > error) - (c0 < -error && c1 < -error && c2 < -error);
}

double cross(const double (&a)[2], const double (&b)[2]) {
  return a[0] * b[1] - a[1] * b[0];
}
double dot(const double (&a)[2], const double (&b)[2]) {
  return a[0] * b[0] + a[1] * b[1];
}

}  // namespace

bool ContourTest::simple(std::span<const VertexId> loop, const Vec3& direction, const Motion& motion) {
  project(loop, direction, motion);
  boxes_.resize(std::max(boxes_.size(), 2 * loop.size()));
  build(0, 0, loop.size());
  return self(0, 0, loop.size());
}

void ContourTest::project(std::span<const VertexId> loop, const Vec3& direction, const Motion& motion) {
  int z = 0;
  direction.cwiseAbs().maxCoeff(&z);
  const int axis[2] = {(z + 1) % 3, (z + 2) % 3};
  const double along[2] = {direction[axis[0]], direction[axis[1]]};
  points_.resize(loop.size());
  double largest = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const MovingPoint p = motion[loop[i]];
    for (int k = 0; k < 2; ++k) {
      points_[i].start[k] = direction[z] * p.start[axis[k]] - along[k] * p.start[z];
      points_[i].end[k] = direction[z] * p.end[axis[k]] - along[k] * p.end[z];
    }
    largest = std::max({largest, p.start.cwiseAbs().maxCoeff(), p.end.cwiseAbs().maxCoeff()});
  }
  // A coordinate is off by the roundings of two products of numbers up to |d_z| and `largest` and of
  // their difference, 4 u in all, and by 2 u more once it is drawn out to a box. The smallest positive
  // double pays for subnormal products.
  slack_ =
      8 * kUnitRoundoff * std::abs(direction[z]) * largest + 4 * std::numeric_limits<double>::denorm_min();
}

ContourTest::Box ContourTest::build(std::size_t node, std::size_t first, std::size_t count) {
  Box box;
  if (count == 1) {
    const Point &p = points_[first], &q = points_[after(first)];
    for (int k = 0; k < 2; ++k) {
      box.start[k] = std::min(p.start[k], q.start[k]) - slack_;
      box.start[2 + k] = std::min(-p.start[k], -q.start[k]) - slack_;
      box.end[k] = std::min(p.end[k], q.end[k]) - slack_;
      box.end[2 + k] = std::min(-p.end[k], -q.end[k]) - slack_;
    }
  } else {
    const std::size_t half = count / 2;
    const Box left = build(node + 1, first, half), right = build(node + 2 * half, first + half, count - half);
    for (int k = 0; k < 4; ++k) {
      box.start[k] = std::min(left.start[k], right.start[k]);
      box.end[k] = std::min(left.end[k], right.end[k]);
    }
  }
  return boxes_[node] = box;
}

bool ContourTest::self(std::size_t node, std::size_t first, std::size_t count) {
  if (count == 1) return true;
  const std::size_t half = count / 2, left = node + 1, right = node + 2 * half;
  return pair(left, first, half, right, first + half, count - half) && self(left, first, half) &&
         self(right, first + half, count - half);
}

bool ContourTest::pair(std::size_t a, std::size_t first_a, std::size_t count_a, std::size_t b,
                       std::size_t first_b, std::size_t count_b) {
  ++box_tests_;
  const Box &x = boxes_[a], &y = boxes_[b];
  for (int k = 0; k < 2; ++k) {
    const bool beyond = (x.start[k] > -y.start[2 + k]) & (x.end[k] > -y.end[2 + k]);
    const bool before = (y.start[k] > -x.start[2 + k]) & (y.end[k] > -x.end[2 + k]);
    if (beyond | before) return true;
  }
  if (count_a == 1 && count_b == 1) {
    if (after(first_a) == first_b) return corner_open(first_a, first_b, after(first_b));
    if (after(first_b) == first_a) return corner_open(first_b, first_a, after(first_a));
    return edges_apart(first_a, first_b);
  }
  if (count_a == 1 || (count_b > 1 && count_b > count_a)) {
    const std::size_t half = count_b / 2;
    return pair(a, first_a, count_a, b + 1, first_b, half) &&
           pair(a, first_a, count_a, b + 2 * half, first_b + half, count_b - half);
  }
  const std::size_t half = count_a / 2;
  return pair(a + 1, first_a, half, b, first_b, count_b) &&
         pair(a + 2 * half, first_a + half, count_a - half, b, first_b, count_b);
}

bool ContourTest::edges_apart(std::size_t a, std::size_t b) const {
  return side_certain(a, after(a), b, after(b)) || side_certain(b, after(b), a, after(a));
}

// Returns whether points a and b certainly stay on one side of the moving line from `from` to `to`.
bool ContourTest::side_certain(std::size_t from, std::size_t to, std::size_t a, std::size_t b) const {
  const auto arrow = [&](std::size_t i) {
    const Point &p = points_[from], &q = points_[i];
    return Arrow{{q.start[0] - p.start[0], q.start[1] - p.start[1]},
                 {q.end[0] - p.end[0], q.end[1] - p.end[1]}};
  };
  const Arrow line = arrow(to);
  const int side = certain_sign(line, arrow(a), 3 * slack_, cross);
  return side != 0 && certain_sign(line, arrow(b), 3 * slack_, cross) == side;
}

// Returns whether the two edges at `corner` certainly never lie on each other.
bool ContourTest::corner_open(std::size_t before, std::size_t corner, std::size_t after) const {
  const auto arrow = [&](std::size_t i) {
    const Point &p = points_[corner], &q = points_[i];
    return Arrow{{q.start[0] - p.start[0], q.start[1] - p.start[1]},
                 {q.end[0] - p.end[0], q.end[1] - p.end[1]}};
  };
  const Arrow a = arrow(before), b = arrow(after);
  return certain_sign(a, b, 3 * slack_, cross) != 0 || certain_sign(a, b, 3 * slack_, dot) < 0;
}

}  // namespace cscd::mcd
