#include "bench/measure/studies/scaling.h"

#include <cmath>

namespace cscd::bench {

std::optional<PowerLaw> fit_power_law(std::span<const double> x, std::span<const double> y) {
  double n = 0, sum_x = 0, sum_y = 0;
  const auto each = [&](const auto& act) {
    for (std::size_t i = 0; i < x.size() && i < y.size(); ++i)
      if (x[i] > 0 && y[i] > 0) act(std::log(x[i]), std::log(y[i]));
  };
  each([&](double u, double v) { ++n, sum_x += u, sum_y += v; });
  if (n < 3) return std::nullopt;
  double square = 0, product = 0;
  each([&](double u, double v) {
    square += (u - sum_x / n) * (u - sum_x / n);
    product += (u - sum_x / n) * (v - sum_y / n);
  });
  if (!(square > 0)) return std::nullopt;
  const double exponent = product / square;
  return PowerLaw{exponent, std::exp((sum_y - exponent * sum_x) / n), static_cast<std::size_t>(n)};
}

Moment between(const Moment& a, const Moment& b, double share) {
  const auto mix = [&](const Vec3& from, const Vec3& to) { return Vec3((1 - share) * from + share * to); };
  Moment moment;
  moment.positions.reserve(a.positions.size());
  for (std::size_t i = 0; i < a.positions.size(); ++i)
    moment.positions.push_back(mix(a.positions[i], b.positions[i]));
  for (std::size_t i = 0; i < a.bones.size(); ++i)
    moment.bones.push_back({mix(a.bones[i].head, b.bones[i].head), mix(a.bones[i].tail, b.bones[i].tail)});
  return moment;
}

std::vector<Bone> resampled_chain(std::span<const Bone> chain, std::size_t count) {
  const auto joint = [&](std::size_t i) {
    const std::size_t whole = i * chain.size() / count;
    if (whole == chain.size()) return chain.back().tail;
    const double part = static_cast<double>(i * chain.size() % count) / static_cast<double>(count);
    return Vec3((1 - part) * chain[whole].head + part * chain[whole].tail);
  };
  std::vector<Bone> bones;
  for (std::size_t i = 0; i < count; ++i) bones.push_back({joint(i), joint(i + 1)});
  return bones;
}

bool is_chain(const Rig& rig) {
  for (std::size_t i = 0; i < rig.parent.size(); ++i)
    if (static_cast<std::int64_t>(rig.parent[i]) != static_cast<std::int64_t>(i) - 1) return false;
  return !rig.parent.empty();
}

}  // namespace cscd::bench
