#include "scenes/motion/key_jets.h"

#include "scenes/character/sample.h"

namespace cscd::scenes {
namespace {

// The share of the way from key `a` to key `b`.
template <class Value>
Jet share_between(const Key<Value>& a, const Key<Value>& b, const Span& span) {
  const Interval length = Interval(b.time) - Interval(a.time);
  const Interval per_second = reciprocal(length);
  return {(Interval(span.from, span.to) - Interval(a.time)) * per_second, per_second, 0};
}

// The cubic from p with slope m to q with slope n, each slope per whole way, at the share s. The second
// derivative is linear, so its bound is tight; those of the first derivative and of the value follow from
// their values in the middle (mean value theorem).
Jet hermite(const Interval& p, const Interval& m, const Interval& q, const Interval& n, const Jet& share) {
  const Interval s = share.value, d = q - p;
  const Interval c2 = 3 * d - 2 * m - n, c3 = m + n - 2 * d;
  const Interval at = s.middle(), off = s - at;
  const Interval bend = 2 * c2 + 6 * (c3 * s);
  const Interval rate = m + at * (2 * c2 + 3 * (at * c3)) + bend * off;
  const Interval value = p + at * (m + at * (c2 + at * c3)) + rate * off;
  return {value, rate * share.rate, bend * square(share.rate)};
}

Jet cubic(double p, double m, double q, double n, const Interval& length, const Jet& share) {
  return hermite(p, length * m, q, length * n, share);
}

JetQuaternion fixed(const Quaternion& q) {
  return {Jet(q.w), Jet(q.x), Jet(q.y), Jet(q.z)};
}

double dot(const Quaternion& a, const Quaternion& b) {
  return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}

// Slerp between unit quaternions a and b at the angle T is f(1 - s) a + f(s) b with f(s) = sin(s T) / sin T.
// Its slope is (cos(s T) b - cos((1 - s) T) a) / (sin T / T), and its second derivative is -T^2 times itself.
// The value is enclosed by that in the middle and the slope: the two weights alone may take all numbers from
// 0 to 1.
JetQuaternion slerp(const Quaternion& from, const Quaternion& to, const Jet& share) {
  const JetQuaternion a = unit_of(fixed(from));
  JetQuaternion b = unit_of(fixed(to));
  if (dot(from, to) < 0)
    for (Jet& x : b) x = -x;
  Interval squared;
  for (std::size_t k = 0; k < 4; ++k) squared = squared + square(b[k].value - a[k].value);
  const Interval angle = 2 * arcsine(square_root(squared) * 0.5), per_whole = reciprocal(sinc(angle));
  // Shares may leave [0, 1] by rounding.
  const Interval s(std::clamp(share.value.low, 0.0, 1.0), std::clamp(share.value.high, 0.0, 1.0));
  const Interval middle = s.middle(), off = s - middle;
  const auto weight = [&](const Interval& part) { return part * sinc(part * angle) * per_whole; };
  const Interval wa = weight(1 - middle), wb = weight(middle);
  const Interval slope_a = cosine((1 - s) * angle) * per_whole, slope_b = cosine(s * angle) * per_whole;
  JetQuaternion out;
  for (std::size_t k = 0; k < 4; ++k) {
    const Interval slope = slope_b * b[k].value - slope_a * a[k].value;
    const Interval value = wa * a[k].value + wb * b[k].value + slope * off;
    out[k] = {value, slope * share.rate, -(square(share.rate * angle) * value)};
  }
  return out;
}

Jet between(double a, double b, const Jet& share) {
  return Jet(a) + (Interval(b) - Interval(a)) * share;
}

// Returns value(before, next, share) of the keys around the span, or hold(key) where the value stays.
template <class Value, class Hold, class Go>
auto around(const std::vector<Key<Value>>& keys, const Span& span, const Hold& hold, const Go& go) {
  const auto next = std::upper_bound(keys.begin(), keys.end(), span.from,
                                     [](double time, const Key<Value>& key) { return time < key.time; });
  if (next == keys.begin()) return hold(keys.front());
  const Key<Value>& before = *(next - 1);
  if (next == keys.end() || before.next == Between::constant) return hold(before);
  return go(before, *next, share_between(before, *next, span));
}

Jet jets_of_keys(const std::vector<Key<double>>& keys, const Span& span) {
  return around(
      keys, span, [](const Key<double>& key) { return Jet(key.value); },
      [](const Key<double>& a, const Key<double>& b, const Jet& share) {
        if (a.next == Between::line) return between(a.value, b.value, share);
        return cubic(a.value, a.leaving, b.value, b.arriving, Interval(b.time) - Interval(a.time), share);
      });
}

template <std::size_t Width>
std::array<Jet, Width> jets_of_components(const Components<Width>& components, const Span& span) {
  std::array<Jet, Width> out;
  for (std::size_t k = 0; k < Width; ++k)
    out[k] = components.axis[k].empty() ? Jet(components.rest[k]) : jets_of(components.axis[k], span);
  return out;
}

template <std::size_t Width>
std::array<Jet, Width> jets_of_layers(const Layered<Width>& layered, const Span& span) {
  std::array<Jet, Width> value = jets_of_components(layered.base, span);
  for (const Layer<Width>& layer : layered.above) {
    const std::array<Jet, Width> own = jets_of_components(layer.values, span);
    for (std::size_t k = 0; k < Width; ++k)
      value[k] = layer.blend == LayerBlend::add ? value[k] + own[k] : own[k];
  }
  return value;
}

template <class Value>
void add_breaks_of_keys(const std::vector<Key<Value>>& keys, Breaks& out) {
  for (std::size_t i = 0; i < keys.size(); ++i)
    (i > 0 && keys[i - 1].next == Between::constant ? out.jumps : out.corners).push_back(keys[i].time);
}

// The rotation by an angle in degrees about an axis.
JetRotation turned_about(int axis, const Jet& degrees) {
  const Interval per_degree = Interval(rounded_down(std::numbers::pi), rounded_up(std::numbers::pi)) / 180;
  const Jet angle = Jet(per_degree) * degrees, c = cosine(angle), s = sine(angle);
  const auto k = static_cast<std::size_t>(axis), i = (k + 1) % 3, j = (k + 2) % 3;
  JetRotation out{};
  out[k][k] = 1;
  out[i][i] = c, out[i][j] = s;
  out[j][i] = -s, out[j][j] = c;
  return out;
}

}  // namespace

JetQuaternion unit_of(const JetQuaternion& q) {
  const Jet length = square_root(square(q[0]) + square(q[1]) + square(q[2]) + square(q[3]));
  const Jet factor = reciprocal(length);
  return {factor * q[0], factor * q[1], factor * q[2], factor * q[3]};
}

JetRotation columns_of(const JetQuaternion& q) {
  const auto& [w, x, y, z] = q;
  const Jet xx = square(x), yy = square(y), zz = square(z), xy = x * y, xz = x * z, yz = y * z, wx = w * x,
            wy = w * y, wz = w * z;
  return {JetVector{1 - 2 * (yy + zz), 2 * (xy + wz), 2 * (xz - wy)},
          JetVector{2 * (xy - wz), 1 - 2 * (xx + zz), 2 * (yz + wx)},
          JetVector{2 * (xz + wy), 2 * (yz - wx), 1 - 2 * (xx + yy)}};
}

JetVector jets_of(const std::vector<Key<Vec3>>& keys, const Span& span) {
  return around(
      keys, span,
      [](const Key<Vec3>& key) {
        return JetVector{key.value.x(), key.value.y(), key.value.z()};
      },
      [](const Key<Vec3>& a, const Key<Vec3>& b, const Jet& share) {
        const Interval length = Interval(b.time) - Interval(a.time);
        JetVector out;
        for (int k = 0; k < 3; ++k)
          out[static_cast<std::size_t>(k)] =
              a.next == Between::line
                  ? between(a.value[k], b.value[k], share)
                  : cubic(a.value[k], a.leaving[k], b.value[k], b.arriving[k], length, share);
        return out;
      });
}

JetRotation jets_of(const std::vector<Key<Quaternion>>& keys, const Span& span) {
  return columns_of(around(
      keys, span, [](const Key<Quaternion>& key) { return unit_of(fixed(key.value)); },
      [](const Key<Quaternion>& a, const Key<Quaternion>& b, const Jet& share) {
        if (a.next == Between::line) return slerp(a.value, b.value, share);
        const Interval length = Interval(b.time) - Interval(a.time);
        const auto along = [&](double Quaternion::*x) {
          return cubic(a.value.*x, a.leaving.*x, b.value.*x, b.arriving.*x, length, share);
        };
        return unit_of(
            {along(&Quaternion::w), along(&Quaternion::x), along(&Quaternion::y), along(&Quaternion::z)});
      }));
}

namespace {

// sin(x) / x for x in [0, pi / 2], off by less than 8 units in the last place.
double sinc_of(double x) {
  return x < 1e-4 ? 1 - x * x / 6 : std::sin(x) / x;
}

// A unit quaternion, off by 4 roundings at most (kTurnRounding).
Eigen::Vector4d unit(const Quaternion& q) {
  const Eigen::Vector4d v(q.x, q.y, q.z, q.w);
  return v / v.norm();
}

Eigen::Matrix3d cross_matrix(const Vec3& w) {
  Eigen::Matrix3d out;
  out << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return out;
}

// The matrix of a quaternion of length 1: the identity plus 2 (w [v] + [v]^2), [v] being the matrix of the
// cross product.
Eigen::Matrix3d matrix_of(const Eigen::Vector4d& q) {
  const Eigen::Matrix3d v = cross_matrix(q.head<3>());
  return Eigen::Matrix3d::Identity() + 2 * (q[3] * v + v * v);
}

// How far the quaternion of slerp may be off, in roundings (kUnitRoundoff). T <= pi / 2 is the angle between
// the ends, s the share, and the two weights sum to at most sqrt(2).
//   an end: 3 of its norm (4 of the sum of squares, of which the root keeps half, and 1 of the root) and 1 of
//     the division; both ends times their weights: 6
//   T: |b - a| is off by 8 of the ends and 4 sqrt(2) of the difference and its norm; half of those 14 times
//     sqrt(2), the derivative of the arcsine, and 1 of the arcsine itself; twice that: 22. The weights'
//     derivatives by T sum to at most 0.71: 16
//   s: 3 of two differences and a quotient, times T: 5. 1 - s has 1 of its own, times T / sin T: 2
//   a weight times its end: 1 of s T, 3 of the sine over the angle (2 of the sine, 1 of the division) and as
//     many of the divisor, 1 of the quotient, 2 of the products; both of them: 15
//   the sum: 1
// Together 45. The velocity of a turn is off by 47 over the time between the keys and by 21 of itself at
// most, for the same reasons.
constexpr double kTurnRounding = 128 * kUnitRoundoff;
// The matrix of quaternions is off by at most 6 times as much (it is of second degree), and a few roundings.
constexpr double kMatrixRounding = 6 * kTurnRounding + 64 * kUnitRoundoff;

}  // namespace

// Slerp turns about one axis at a constant speed: with w the angular velocity, R' = [w] R and R'' = [w]^2 R.
// What turns stays within |w| times half the span of where it is in the middle, and its derivatives within
// |w|^2 and |w|^3 times that.
std::optional<MovingMatrix> turning_of(const std::vector<Key<Quaternion>>& keys, const Span& span) {
  const auto next = std::upper_bound(keys.begin(), keys.end(), span.from,
                                     [](double time, const Key<Quaternion>& key) { return time < key.time; });
  const auto still = [](const Key<Quaternion>& key) {
    return MovingMatrix{{matrix_of(unit(key.value)), kMatrixRounding}, {}, {}};
  };
  if (next == keys.begin())
    return span.to <= keys.front().time || keys.size() == 1 ? std::optional(still(keys.front()))
                                                            : std::nullopt;
  const Key<Quaternion>& before = *(next - 1);
  if (next == keys.end()) return still(before);
  if (span.to > next->time || before.next == Between::cubic) return std::nullopt;
  if (before.next == Between::constant) return still(before);
  const Eigen::Vector4d a = unit(before.value);
  Eigen::Vector4d b = unit(next->value);
  if (dot(before.value, next->value) < 0) b = -b;
  const double length = next->time - before.time, middle = span.from + (span.to - span.from) / 2;
  const double share = std::clamp((middle - before.time) / length, 0.0, 1.0);
  const double angle = 2 * std::asin(std::min((b - a).norm() / 2, 1.0)), whole = sinc_of(angle);
  const Eigen::Vector4d q =
      (1 - share) * (sinc_of((1 - share) * angle) / whole) * a + share * (sinc_of(share * angle) / whole) * b;
  const Vec3 va = a.head<3>(), vb = b.head<3>();
  const Vec3 turned = a[3] * vb - b[3] * va - vb.cross(va);  // of b times the conjugate of a
  const Vec3 w = (2 / (whole * length)) * turned;
  const double speed = grown(w.norm() + 4 * kTurnRounding / length),
               off = 4 * kTurnRounding / length + kTurnRounding * speed;
  const double half = rounded_up(std::max(middle - span.from, span.to - middle));
  const Eigen::Matrix3d value = matrix_of(q), rate = cross_matrix(w) * value, bend = cross_matrix(w) * rate;
  const double away = grown(speed * half + 2 * kMatrixRounding);
  if (!std::isfinite(speed * speed * speed * away)) throw Unbounded();
  return MovingMatrix{
      {value, away}, {rate, grown(speed * away + off)}, {bend, grown(speed * (speed * away + 2 * off))}};
}

Jet jets_of(const Curve& curve, const Span& span) {
  const Extrapolation& beyond = curve.beyond;
  if (curve.keys.size() >= 2) {
    const Key<double>&first = curve.keys.front(), &last = curve.keys.back();
    const bool before = beyond.before == Beyond::straight && span.to <= first.time && span.from < first.time,
               after = beyond.after == Beyond::straight && span.from >= last.time;
    if (before || after) {
      const Key<double>& end = before ? first : last;
      const Interval slope = end_slope(curve.keys, before);
      return {Interval(end.value) + slope * (Interval(span.from, span.to) - Interval(end.time)), slope, 0};
    }
  }
  return jets_of_keys(curve.keys, span);
}

JetVector jets_of(const Layered<3>& layered, const Span& span) {
  return jets_of_layers(layered, span);
}

Jet jets_of(const Layered<1>& layered, const Span& span) {
  return jets_of_layers(layered, span)[0];
}

JetRotation jets_of(const EulerAngles& angles, const Span& span) {
  const JetVector degrees = jets_of_layers(angles.degrees, span);
  JetRotation whole = turned_about(angles.order[0], degrees[static_cast<std::size_t>(angles.order[0])]);
  for (std::size_t n = 1; n < 3; ++n) {
    const JetRotation turn =
        turned_about(angles.order[n], degrees[static_cast<std::size_t>(angles.order[n])]);
    for (JetVector& column : whole) column = column[0] * turn[0] + column[1] * turn[1] + column[2] * turn[2];
  }
  return whole;
}

void add_breaks(const std::vector<Key<Vec3>>& keys, Breaks& out) {
  add_breaks_of_keys(keys, out);
}
void add_breaks(const std::vector<Key<Quaternion>>& keys, Breaks& out) {
  add_breaks_of_keys(keys, out);
}
void add_breaks(const Curve& curve, Breaks& out) {
  add_breaks_of_keys(curve.keys, out);
}

const char* without_bounds(const Curve& curve, const Span& clip) {
  const auto repeats = [](Beyond kind) {
    return kind == Beyond::repeat || kind == Beyond::rise || kind == Beyond::mirror;
  };
  const Extrapolation& beyond = curve.beyond;
  if (curve.keys.size() < 2) return nullptr;
  if ((repeats(beyond.before) && clip.from < beyond.first - beyond.tick / 2) ||
      (repeats(beyond.after) && clip.to > beyond.last + beyond.tick / 2))
    return "curves that are repeated beyond their keys";
  return nullptr;
}

}  // namespace cscd::scenes
