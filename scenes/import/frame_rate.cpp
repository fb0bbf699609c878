#include "scenes/import/frame_rate.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/character/options.h"

namespace cscd::scenes {
namespace {

// Rates beyond these are units of time, such as seconds, milliseconds, or the ticks of DirectX.
constexpr double kLeastStated = 5, kLeastSpaced = 20, kMost = 240;
// Times are single precision in many files. Moments nearer than this, in seconds, are one.
constexpr double kSameMoment = 1e-4;
// By how much of a gap a key may miss its place, and by which share two rates may differ and be the same.
constexpr double kMiss = 0.02, kSameRate = 3e-4;

template <class Value>
void add_times(const std::vector<Key<Value>>& keys, std::vector<double>& times) {
  for (const Key<Value>& key : keys) times.push_back(key.time);
}
template <std::size_t Width>
void add_times(const Layered<Width>& layered, std::vector<double>& times) {
  for_each_curve(layered, [&](const Curve& curve) { add_times(curve.keys, times); });
}

// Returns all moments at which a clip has keys, in order.
std::vector<double> moments_of(const Animation& animation) {
  std::vector<double> times;
  for (const Channel& channel : animation.channels) {
    add_times(channel.moves, times);
    add_times(channel.rotations, times);
    add_times(channel.scales, times);
    add_times(channel.move_components, times);
    add_times(channel.scale_components, times);
    add_times(channel.angles.degrees, times);
  }
  for (const MorphChannel& morph : animation.morphs)
    for (const Layered<1>& weights : morph.weights) add_times(weights, times);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end(), [](double a, double b) { return b - a < kSameMoment; }),
              times.end());
  return times;
}

// Rates are whole numbers, or those of television: 24, 30 or 60 divided by 1.001.
double rounded(double rate) {
  for (const double exact : {std::round(rate), std::round(rate * 1.001) / 1.001})
    if (std::abs(rate - exact) <= kSameRate * exact) return exact;
  return rate;
}

std::optional<double> spacing_of(const Animation& animation) {
  const std::vector<double> moments = moments_of(animation);
  if (moments.size() < 3) return std::nullopt;
  const double gap = (moments.back() - moments.front()) / static_cast<double>(moments.size() - 1);
  for (std::size_t i = 0; i < moments.size(); ++i)
    if (std::abs(moments.front() + static_cast<double>(i) * gap - moments[i]) > kMiss * gap)
      return std::nullopt;
  const double rate = 1 / gap;
  return rate >= kLeastSpaced * (1 - kSameRate) && rate <= kMost ? std::optional(rounded(rate))
                                                                 : std::nullopt;
}

}  // namespace

FrameRate frame_rate(const Character& character, std::optional<double> asked) {
  if (asked) return {*asked, kAsked};
  if (character.frames_per_second) return {*character.frames_per_second, kStated};
  for (const Animation& animation : character.animations)
    if (animation.ticks_per_second >= kLeastStated && animation.ticks_per_second <= kMost)
      return {animation.ticks_per_second, kStated};
  std::optional<double> spaced;
  for (const Animation& animation : character.animations) {
    const std::optional<double> rate = spacing_of(animation);
    if (!rate) continue;
    if (spaced && std::abs(*rate - *spaced) > kSameRate * *spaced) return {kAssumedFps, kAssumed};
    spaced = spaced.value_or(*rate);
  }
  return spaced ? FrameRate{*spaced, kSpaced} : FrameRate{kAssumedFps, kAssumed};
}

}  // namespace cscd::scenes
