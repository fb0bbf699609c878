#include "scenes/import/fbx/curve_sum.h"

#include <algorithm>

namespace cscd::scenes::fbx {
namespace {

// A curve's value at a time, and its slopes just before and just after that time.
struct Sample {
  double value = 0, before = 0, after = 0;
};

// Returns the slope at the share s of the way between two keys.
double slope_between(const Key<double>& a, const Key<double>& b, double s) {
  const double length = b.time - a.time, secant = (b.value - a.value) / length;
  if (a.next == Between::constant) return 0;
  if (a.next == Between::line) return secant;
  return 6 * s * (1 - s) * secant + (1 - s) * (1 - 3 * s) * a.leaving + s * (3 * s - 2) * b.arriving;
}

double value_between(const Key<double>& a, const Key<double>& b, double s) {
  if (a.next == Between::line) return (1 - s) * a.value + s * b.value;
  const double length = b.time - a.time, s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * a.value + (s3 - 2 * s2 + s) * length * a.leaving +
         (3 * s2 - 2 * s3) * b.value + (s3 - s2) * length * b.arriving;
}

Sample sample(const Curve& curve, double time) {
  const auto next = std::upper_bound(curve.begin(), curve.end(), time,
                                     [](double t, const Key<double>& key) { return t < key.time; });
  if (next == curve.begin()) return {curve.front().value};
  const auto key = next - 1;
  Sample result{key->value};
  if (key->time == time) {
    if (key != curve.begin()) result.before = slope_between(*(key - 1), *key, 1);
    if (next != curve.end()) result.after = slope_between(*key, *next, 0);
    return result;
  }
  if (next == curve.end()) return result;
  const double s = (time - key->time) / (next->time - key->time);
  result.value = value_between(*key, *next, s);
  result.before = result.after = slope_between(*key, *next, s);
  return result;
}

bool has_steps(const Curve& curve) {
  return std::any_of(curve.begin(), curve.end(),
                     [](const Key<double>& key) { return key.next == Between::constant; });
}

}  // namespace

Curve scaled(Curve curve, double factor, double offset) {
  for (Key<double>& key : curve) {
    key.value = factor * key.value + offset;
    key.arriving *= factor;
    key.leaving *= factor;
  }
  return curve;
}

bool is_level(const Curve& curve) {
  for (std::size_t i = 0; i < curve.size(); ++i) {
    if (curve[i].value != curve.front().value) return false;
    if (curve[i].next != Between::cubic || i + 1 == curve.size()) continue;
    if (curve[i].leaving != 0 || curve[i + 1].arriving != 0) return false;
  }
  return true;
}

std::optional<Curve> sum(const Curve& a, const Curve& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  if (is_level(b)) return scaled(a, 1, b.front().value);
  if (is_level(a)) return scaled(b, 1, a.front().value);
  if (has_steps(a) || has_steps(b)) return std::nullopt;
  std::vector<double> times;
  for (const Key<double>& key : a) times.push_back(key.time);
  for (const Key<double>& key : b) times.push_back(key.time);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  Curve both;
  for (const double time : times) {
    const Sample p = sample(a, time), q = sample(b, time);
    both.push_back({time, p.value + q.value, Between::cubic, p.before + q.before, p.after + q.after});
  }
  return both;
}

}  // namespace cscd::scenes::fbx
