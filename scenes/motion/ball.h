#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/rounding.h"
#include "core/base/vec3.h"
#include "scenes/motion/jet.h"

// Vectors and matrices that are known up to a distance. A chain of rotations adds up the uncertainties of its
// members; the product of as many matrices of intervals would multiply them.
namespace cscd::scenes {

// More than some tens of roundings of sums of non-negative numbers lose, underflow included.
inline double grown(double x) {
  return x * (1 + 64 * kUnitRoundoff) + std::numeric_limits<double>::min();
}
// A product of matrices and vectors of three is off by less than this share of the product of their norms:
// each number by three roundings of what the rows and columns of absolute values give, and those have norms
// of at most sqrt(3) times the norms of the matrices.
inline constexpr double kProductRounding = 16 * kUnitRoundoff;

// All vectors, or matrices, within `radius` of `centre`; matrices by the largest length of what a unit vector
// becomes.
template <class Centre>
struct Ball {
  Centre centre = Centre::Zero();
  double radius = 0;
};
using BallVector = Ball<Vec3>;
using BallQuaternion = Ball<Eigen::Vector4d>;  // x, y, z, w
using BallMatrix = Ball<Eigen::Matrix3d>;

inline double norm_above(const Vec3& v) {
  return grown(v.norm());
}
inline double norm_above(const Eigen::Vector4d& v) {
  return grown(v.norm());
}
// The norm of M is the square root of that of its transpose times M, which is at most the largest sum of a
// row.
inline double norm_above(const Eigen::Matrix3d& m) {
  const Eigen::Matrix3d both = m.transpose() * m;
  return grown(std::sqrt(both.cwiseAbs().rowwise().sum().maxCoeff() + kProductRounding * m.squaredNorm()));
}

template <class Centre>
Ball<Centre> operator+(const Ball<Centre>& a, const Ball<Centre>& b) {
  const Centre sum = a.centre + b.centre;
  return {sum, grown(a.radius + b.radius + kUnitRoundoff * sum.norm())};
}
template <class Centre>
Ball<Centre> operator*(const BallMatrix& a, const Ball<Centre>& b) {
  const double na = norm_above(a.centre), nb = norm_above(b.centre);
  return {a.centre * b.centre,
          grown(na * (b.radius + kProductRounding * nb) + a.radius * nb + a.radius * b.radius)};
}
// The product of quaternions, whose lengths multiply.
inline BallQuaternion operator*(const BallQuaternion& a, const BallQuaternion& b) {
  const Vec3 v = a.centre.head<3>(), w = b.centre.head<3>();
  Eigen::Vector4d product;
  product << a.centre[3] * w + b.centre[3] * v + v.cross(w), a.centre[3] * b.centre[3] - v.dot(w);
  const double na = norm_above(a.centre), nb = norm_above(b.centre);
  return {product, grown(na * (b.radius + kProductRounding * nb) + a.radius * nb + a.radius * b.radius)};
}
template <class Centre>
Ball<Centre> operator*(double x, const Ball<Centre>& a) {
  const Centre product = x * a.centre;
  return {product, grown(std::abs(x) * a.radius + kUnitRoundoff * product.norm())};
}
template <class Centre>
Interval dot(const Ball<Centre>& a, const Ball<Centre>& b) {
  const double middle = a.centre.dot(b.centre), na = norm_above(a.centre), nb = norm_above(b.centre),
               off = grown(na * (b.radius + kProductRounding * nb) + a.radius * nb + a.radius * b.radius);
  return outward(middle - off, middle + off);
}
inline BallMatrix transposed(const BallMatrix& a) {
  return {a.centre.transpose(), a.radius};
}

template <class Centre>
Ball<Centre> twice(const Ball<Centre>& a) {
  return {2 * a.centre, 2 * a.radius};
}

// What moves: a value and its first and second derivative, each over a span of time.
template <class Centre>
struct MovingBall {
  Ball<Centre> value, rate, bend;
};
using MovingVector = MovingBall<Vec3>;
using MovingMatrix = MovingBall<Eigen::Matrix3d>;
using MovingQuaternion = MovingBall<Eigen::Vector4d>;

template <class Centre>
MovingBall<Centre> operator+(const MovingBall<Centre>& a, const MovingBall<Centre>& b) {
  return {a.value + b.value, a.rate + b.rate, a.bend + b.bend};
}
template <class Centre>
MovingBall<Centre> operator*(double x, const MovingBall<Centre>& a) {
  return {x * a.value, x * a.rate, x * a.bend};
}
template <class A, class B>
MovingBall<B> operator*(const MovingBall<A>& a, const MovingBall<B>& b) {
  return {a.value * b.value, a.rate * b.value + a.value * b.rate,
          a.bend * b.value + twice(a.rate * b.rate) + a.value * b.bend};
}

// An affine map that moves.
struct MovingTransform {
  MovingMatrix linear;
  MovingVector origin;

  MovingVector operator()(const MovingVector& x) const { return linear * x + origin; }
};
inline MovingTransform composed(const MovingTransform& after, const MovingTransform& before) {
  return {after.linear * before.linear, after(before.origin)};
}

// Where a map takes a fixed point. `norms` are those of the map.
struct Norms {
  double value, rate, bend;
};
inline Norms norms_of(const MovingTransform& map) {
  return {norm_above(map.linear.value.centre), norm_above(map.linear.rate.centre),
          norm_above(map.linear.bend.centre)};
}
inline MovingVector moved(const MovingTransform& map, const Norms& norms, const BallVector& x) {
  const double length = norm_above(x.centre), uncertain = x.radius + 2 * kProductRounding * length;
  const auto by = [&](const BallMatrix& linear, double norm, const BallVector& origin) -> BallVector {
    return {linear.centre * x.centre + origin.centre,
            grown(norm * uncertain + linear.radius * (length + x.radius) + origin.radius +
                  2 * kUnitRoundoff * origin.centre.cwiseAbs().sum())};
  };
  return {by(map.linear.value, norms.value, map.origin.value),
          by(map.linear.rate, norms.rate, map.origin.rate), by(map.linear.bend, norms.bend, map.origin.bend)};
}

// The ball around a box: a matrix is no larger than the square root of the sum of its squares.
template <class Centre, class At>
Ball<Centre> ball_around(const At& at) {
  Ball<Centre> out;
  double squares = 0;
  for (int column = 0; column < out.centre.cols(); ++column)
    for (int row = 0; row < 3; ++row) {
      const Interval& x = at(row, column);
      out.centre(row, column) = x.middle();
      const double off = grown(std::max(x.high - x.middle(), x.middle() - x.low));
      squares += off * off;
    }
  if (!std::isfinite(squares)) throw Unbounded();
  out.radius = grown(std::sqrt(squares));
  return out;
}
inline MovingVector ball_around(const JetVector& v) {
  const auto of = [&](Interval Jet::*which) {
    return ball_around<Vec3>([&](int row, int) { return v[static_cast<std::size_t>(row)].*which; });
  };
  return {of(&Jet::value), of(&Jet::rate), of(&Jet::bend)};
}
inline MovingMatrix ball_around(const std::array<JetVector, 3>& columns) {
  const auto of = [&](Interval Jet::*which) {
    return ball_around<Eigen::Matrix3d>([&](int row, int column) {
      return columns[static_cast<std::size_t>(column)][static_cast<std::size_t>(row)].*which;
    });
  };
  return {of(&Jet::value), of(&Jet::rate), of(&Jet::bend)};
}

// The box around a moving ball.
inline JetVector box_around(const MovingVector& v) {
  JetVector out;
  const auto of = [](const BallVector& ball, int row) {
    return outward(ball.centre[row] - ball.radius, ball.centre[row] + ball.radius);
  };
  for (int row = 0; row < 3; ++row)
    out[static_cast<std::size_t>(row)] = {of(v.value, row), of(v.rate, row), of(v.bend, row)};
  return out;
}
inline std::array<JetVector, 3> box_around(const MovingMatrix& m) {
  const auto column = [](const BallMatrix& ball, int k) {
    return BallVector{ball.centre.col(k), ball.radius};
  };
  std::array<JetVector, 3> out;
  for (int k = 0; k < 3; ++k)
    out[static_cast<std::size_t>(k)] =
        box_around(MovingVector{column(m.value, k), column(m.rate, k), column(m.bend, k)});
  return out;
}

}  // namespace cscd::scenes
