#include "scenes/character/sample.h"

#include <cmath>
#include <gtest/gtest.h>

namespace cscd::scenes {
namespace {

constexpr double kTick = 1e-6;

// Returns the keys of a curve with all repetitions written out, from -20 to 20 times their length. This is
// the slow way, which the arithmetic of Extrapolation has to agree with.
std::vector<Key<double>> written_out(const Curve& curve) {
  const auto& keys = curve.keys;
  const double length = keys.back().time - keys.front().time, rise = keys.back().value - keys.front().value;
  const Extrapolation& beyond = curve.beyond;
  std::vector<Key<double>> all;
  for (int cycle = -20; cycle <= 20; ++cycle) {
    const Beyond kind = cycle < 0 ? beyond.before : beyond.after;
    const double most = cycle < 0 ? beyond.repeats_before : beyond.repeats_after;
    if (cycle != 0 && (kind == Beyond::hold || std::abs(cycle) > most)) continue;
    std::vector<Key<double>> copy = keys;
    if (cycle != 0 && kind == Beyond::mirror && cycle % 2 != 0) {
      for (std::size_t i = 0; i < keys.size(); ++i) {
        const Key<double>& from = keys[keys.size() - 1 - i];
        copy[i] = {keys.front().time + keys.back().time - from.time, from.value, Between::line, -from.leaving,
                   -from.arriving};
        if (i + 1 < keys.size()) copy[i].next = keys[keys.size() - 2 - i].next;
      }
    }
    for (Key<double>& key : copy) {
      key.time += cycle * length;
      if (cycle != 0 && kind == Beyond::rise) key.value += cycle * rise;
      // The end of a cycle and the start of the next one lie at one time; put them a little apart.
      if (!all.empty() && key.time <= all.back().time) key.time = all.back().time + 1e-9;
      all.push_back(key);
    }
  }
  return all;
}

Curve wave() {
  return {{{1, 2, Between::cubic, 0, 5}, {1.5, 4, Between::line, -1, 0}, {2, 0, Between::line}, {3.5, 3}},
          {Beyond::hold, Beyond::hold, 1e300, 1e300, 1, 3.5, kTick}};
}

TEST(Sample, RepetitionsAreThoseOfTheKeysWrittenOut) {
  for (const Beyond kind : {Beyond::hold, Beyond::repeat, Beyond::rise, Beyond::mirror})
    for (const double most : {0.0, 1.0, 2.0, 3.0, 1e300}) {
      Curve curve = wave();
      curve.beyond.before = curve.beyond.after = kind;
      curve.beyond.repeats_before = curve.beyond.repeats_after = most;
      const Curve slow{written_out(curve)};
      for (int i = -400; i <= 400; ++i) {
        const double time = 2 + 0.103 * i;
        EXPECT_NEAR(sample(curve, time), sample(slow, time), 1e-7)
            << "kind " << static_cast<int>(kind) << ", " << most << " times, time " << time;
      }
    }
}

// A repetition begins with the first key, also if the time of its start was rounded downwards.
TEST(Sample, ARepetitionStartsAtItsOwnTime) {
  Curve saw{{{0, 0}, {1, 1}}, {Beyond::repeat, Beyond::repeat, 1e300, 1e300, 0, 1, kTick}};
  EXPECT_NEAR(sample(saw, 3 - kTick / 4), 0, 2 * kTick);
  EXPECT_NEAR(sample(saw, 3), 0, 2 * kTick);
  EXPECT_NEAR(sample(saw, 3 - 2 * kTick), 1, 4 * kTick);
  EXPECT_EQ(sample(saw, 1), 1) << "the keys themselves end with the last key";
  EXPECT_EQ(sample(saw, 1 + kTick / 4), 1);
  EXPECT_EQ(sample(saw, -kTick / 4), 0);
}

TEST(Sample, StraightEndsFollowTheSlopeOfTheirKey) {
  Curve curve = wave();
  curve.beyond.before = curve.beyond.after = Beyond::straight;
  EXPECT_NEAR(sample(curve, -1), 2 - 2 * 5, 1e-12);
  EXPECT_NEAR(sample(curve, 5), 3 + 1.5 * 3 / 1.5, 1e-12);
  curve.keys[2].next = Between::constant;
  EXPECT_EQ(sample(curve, 5), 3) << "a value that is held has no slope";
  curve.keys.resize(1);
  EXPECT_EQ(sample(curve, -1), 2) << "one key has no slope";
}

TEST(Sample, PowersOfScalingsAreThoseOfTheLibrary) {
  Layered<3> layered{{{}, {1, 2, 0.001}}, {{{{}, {-3, 1e-8, 1e8}}, LayerBlend::add, true, 0}}};
  for (const double share : {0.0, 1e-17, 1.0 / 3, 0.5, 0.9999999, 1.0}) {
    const Vec3 was = sample(layered, {share}, 0);
    EXPECT_NEAR(was.x(), (share == 0 ? 1 : -1) * std::pow(3, share), 1e-13);
    EXPECT_NEAR(was.y() / (2 * std::pow(1e-8, share)), 1, 1e-13);
    EXPECT_NEAR(was.z() / (0.001 * std::pow(1e8, share)), 1, 1e-13);
  }
}

TEST(Sample, SharesOfLayersStayBetweenZeroAndOne) {
  Animation animation;
  animation.layer_weights = {{{{0, -1}, {4, 3}}}, {}};
  for (const double time : {0.0, 1.5, 2.0, 4.0})
    EXPECT_EQ(layer_shares(animation, time), (std::vector<double>{std::clamp(time - 1, 0.0, 1.0), 1}));
}

TEST(Sample, AMorphTargetRespondsAlongItsKnots) {
  const MorphTarget target{"half", {}, 0, {{0, 0}, {50, 1}, {100, 0}}};
  EXPECT_EQ(weight_of(target, 25), 0.5);
  EXPECT_EQ(weight_of(target, 50), 1);
  EXPECT_EQ(weight_of(target, 75), 0.5);
  EXPECT_EQ(weight_of(target, 150), -1);
  EXPECT_EQ(weight_of(target, -50), -1);
  EXPECT_EQ(weight_of({"plain", {}}, 0.75), 0.75);
}

}  // namespace
}  // namespace cscd::scenes
