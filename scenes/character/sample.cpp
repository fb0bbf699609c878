#include "scenes/character/sample.h"

#include <cmath>
#include <optional>

namespace cscd::scenes {
namespace {

double between(double a, double b, double s) {
  return (1 - s) * a + s * b;
}
Vec3 between(const Vec3& a, const Vec3& b, double s) {
  return (1 - s) * a + s * b;
}
Quaternion between(const Quaternion& a, const Quaternion& b, double s) {
  return slerp(a, b, s);
}

// The value at share s of the cubic from p with slope m to q with slope n. Both slopes are per whole way
// from p to q (glTF 2.0, appendix C).
double hermite(double p, double m, double q, double n, double s) {
  const double s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * p + (s3 - 2 * s2 + s) * m + (3 * s2 - 2 * s3) * q + (s3 - s2) * n;
}
double cubic(const Key<double>& a, const Key<double>& b, double s) {
  const double length = b.time - a.time;
  return hermite(a.value, length * a.leaving, b.value, length * b.arriving, s);
}
Vec3 cubic(const Key<Vec3>& a, const Key<Vec3>& b, double s) {
  const double length = b.time - a.time;
  Vec3 out;
  for (int k = 0; k < 3; ++k)
    out[k] = hermite(a.value[k], length * a.leaving[k], b.value[k], length * b.arriving[k], s);
  return out;
}
Quaternion cubic(const Key<Quaternion>& a, const Key<Quaternion>& b, double s) {
  const double length = b.time - a.time;
  const auto along = [&](double Quaternion::*x) {
    return hermite(a.value.*x, length * a.leaving.*x, b.value.*x, length * b.arriving.*x, s);
  };
  return normalised(
      {along(&Quaternion::w), along(&Quaternion::x), along(&Quaternion::y), along(&Quaternion::z)});
}

template <class Value>
Value sample_keys(const std::vector<Key<Value>>& keys, double seconds) {
  const auto next = std::upper_bound(keys.begin(), keys.end(), seconds,
                                     [](double time, const Key<Value>& key) { return time < key.time; });
  if (next == keys.begin()) return keys.front().value;
  const Key<Value>& before = *(next - 1);
  if (next == keys.end() || before.next == Between::constant) return before.value;
  const double s = (seconds - before.time) / (next->time - before.time);
  return before.next == Between::cubic ? cubic(before, *next, s) : between(before.value, next->value, s);
}

// Returns the value where the keys of a curve are repeated, `late` seconds before the first key or after the
// last one.
double sample_repeated(const Curve& curve, bool before, double late) {
  const Extrapolation& beyond = curve.beyond;
  const Beyond kind = before ? beyond.before : beyond.after;
  const double most = before ? beyond.repeats_before : beyond.repeats_after;
  const Key<double>&first = curve.keys.front(), &last = curve.keys.back();
  const double length = beyond.last - beyond.first;
  if (most == 0 || !(length > 0) || length < beyond.tick) return before ? first.value : last.value;
  double repeats = std::floor((late + beyond.tick / 2) / length);  // whole ones that are over
  double rest = std::max(0.0, late - repeats * length);
  if (repeats >= most) {
    repeats = most - 1;
    rest = length;
  }
  const bool forwards = kind != Beyond::mirror || std::fmod(repeats, 2) != 0;
  if (forwards == before) rest = length - rest;
  const double value = sample_keys(curve.keys, beyond.first + rest);
  if (kind != Beyond::rise) return value;
  return value + (before ? -1 : 1) * (repeats + 1) * (last.value - first.value);
}

// Returns |base| to the power of an exponent in [0, 1], with the sign of the base. Repeated square roots are
// multiplied, because the last bits of std::pow depend on the processor.
double signed_power(double base, double exponent) {
  if (exponent <= 0) return 1;
  if (exponent >= 1) return base;
  double root = std::abs(base), power = 1;
  for (int bit = 0; bit < 53 && exponent > 0; ++bit) {
    root = std::sqrt(root);
    exponent *= 2;
    if (exponent < 1) continue;
    power *= root;
    exponent -= 1;
  }
  return std::copysign(power, base);
}

template <std::size_t Width>
std::array<double, Width> sample_components(const Components<Width>& components, double seconds) {
  std::array<double, Width> out;
  for (std::size_t k = 0; k < Width; ++k)
    out[k] = components.axis[k].empty() ? components.rest[k] : sample(components.axis[k], seconds);
  return out;
}

template <std::size_t Width>
double share_of(const Layer<Width>& layer, const std::vector<double>& shares) {
  return layer.weight < 0 ? 1 : shares[static_cast<std::size_t>(layer.weight)];
}

template <std::size_t Width>
void put_above(std::array<double, Width>& value, const Layer<Width>& layer, double share, double seconds) {
  const std::array<double, Width> own = sample_components(layer.values, seconds);
  const bool add = layer.blend == LayerBlend::add;
  for (std::size_t k = 0; k < Width; ++k)
    if (layer.as_maps)
      value[k] = (add ? value[k] : signed_power(value[k], 1 - share)) * signed_power(own[k], share);
    else
      value[k] = (add ? value[k] : (1 - share) * value[k]) + share * own[k];
}

template <std::size_t Width>
std::array<double, Width> sample_layers(const Layered<Width>& layered, const std::vector<double>& shares,
                                        double seconds) {
  std::array<double, Width> value = sample_components(layered.base, seconds);
  for (const Layer<Width>& layer : layered.above) put_above(value, layer, share_of(layer, shares), seconds);
  return value;
}

Vec3 vector_of(const std::array<double, 3>& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

double end_slope(const std::vector<Key<double>>& keys, bool first) {
  const Key<double>&a = first ? keys.front() : *(keys.end() - 2), &b = first ? keys[1] : keys.back();
  if (a.next == Between::constant) return 0;
  if (a.next == Between::line) return (b.value - a.value) / (b.time - a.time);
  return first ? a.leaving : b.arriving;
}

Vec3 sample(const std::vector<Key<Vec3>>& keys, double seconds) {
  return sample_keys(keys, seconds);
}

Quaternion sample(const std::vector<Key<Quaternion>>& keys, double seconds) {
  return sample_keys(keys, seconds);
}

double sample(const Curve& curve, double seconds) {
  const Extrapolation& beyond = curve.beyond;
  const bool before = seconds<beyond.first - beyond.tick / 2, after = seconds> beyond.last + beyond.tick / 2;
  const Beyond kind = before ? beyond.before : after ? beyond.after : Beyond::hold;
  if (kind == Beyond::hold || curve.keys.size() < 2) return sample_keys(curve.keys, seconds);
  if (kind != Beyond::straight)
    return sample_repeated(curve, before, before ? beyond.first - seconds : seconds - beyond.last);
  const Key<double>& end = before ? curve.keys.front() : curve.keys.back();
  return end.value + (seconds - end.time) * end_slope(curve.keys, before);
}

std::vector<double> layer_shares(const Animation& animation, double seconds) {
  std::vector<double> shares;
  for (const Curve& weight : animation.layer_weights)
    shares.push_back(weight.empty() ? 1 : std::clamp(sample(weight, seconds), 0.0, 1.0));
  return shares;
}

Vec3 sample(const Layered<3>& layered, const std::vector<double>& shares, double seconds) {
  return vector_of(sample_layers(layered, shares, seconds));
}

double sample(const Layered<1>& layered, const std::vector<double>& shares, double seconds) {
  return sample_layers(layered, shares, seconds)[0];
}

Quaternion sample(const EulerAngles& angles, const std::vector<double>& shares, double seconds) {
  std::array<double, 3> degrees = sample_components(angles.degrees.base, seconds);
  std::optional<Quaternion> turned;  // instead of the angles, from the first layer of rotations on
  for (const Layer<3>& layer : angles.degrees.above) {
    const double share = share_of(layer, shares);
    if (!layer.as_maps) {
      put_above(degrees, layer, share, seconds);
      continue;
    }
    const Quaternion below = turned ? *turned : from_euler(vector_of(degrees), angles.order);
    const Quaternion own = from_euler(vector_of(sample_components(layer.values, seconds)), angles.order);
    turned =
        layer.blend == LayerBlend::add ? product(below, slerp({}, own, share)) : slerp(below, own, share);
  }
  return turned ? normalised(*turned) : from_euler(vector_of(degrees), angles.order);
}

double weight_of(const MorphTarget& target, double driven) {
  const auto& knots = target.response;
  if (knots.empty()) return driven;
  std::size_t k = 1;
  while (k + 1 < knots.size() && driven > knots[k].driven) ++k;
  const double share = (driven - knots[k - 1].driven) / (knots[k].driven - knots[k - 1].driven);
  return (1 - share) * knots[k - 1].weight + share * knots[k].weight;
}

}  // namespace cscd::scenes
