#include "scenes/import/frame_rate.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "scenes/character/options.h"
#include "scenes/character/test_characters.h"
#include "scenes/import/fbx/test_fbx.h"

namespace cscd::scenes {
namespace {

// A clip with a key at each of these moments, in single precision as files have them.
Animation keyed(const std::vector<double>& seconds) {
  Animation animation;
  Channel channel{0, {}, {}, {}};
  for (const double second : seconds)
    channel.moves.push_back({static_cast<double>(static_cast<float>(second)), Vec3::Zero()});
  animation.channels.push_back(channel);
  return animation;
}

std::vector<double> every(double gap, std::size_t count, double start = 0) {
  std::vector<double> times;
  for (std::size_t i = 0; i < count; ++i) times.push_back(start + static_cast<double>(i) * gap);
  return times;
}

FrameRate rate_of(const std::vector<Animation>& animations) {
  Character character;
  character.animations = animations;
  return frame_rate(character, std::nullopt);
}

TEST(FrameRate, IsReadFromKeysThatAreEvenlySpaced) {
  const std::pair<double, double> kRates[] = {
      {1.0 / 24, 24}, {1.0 / 30, 30}, {0.04, 25}, {1001.0 / 24000, 24000.0 / 1001}, {1.0 / 120, 120}};
  for (const auto& [gap, rate] : kRates)
    for (const double start : {0.0, gap, 900 * gap}) {
      const FrameRate found = rate_of({keyed(every(gap, 200, start))});
      EXPECT_DOUBLE_EQ(found.fps, rate) << start;
      EXPECT_EQ(found.from, kSpaced);
    }
}

// Mutations that die here: the smallest gap taken for the rate; keys of a pose sampled at the rate of the
// keys.
TEST(FrameRate, IsAssumedWhereKeysDoNotSayIt) {
  std::vector<double> uneven = every(1.0 / 24, 20);
  uneven.back() += 0.01;
  for (const std::vector<double>& times : {std::vector<double>{},
                                           {0},
                                           {0, 1.0 / 24},
                                           every(0.5, 12),
                                           every(1.0 / 12, 30),
                                           uneven,
                                           every(0.001, 50),
                                           {0, 1.0 / 24, 3.0 / 24}}) {
    const FrameRate found = rate_of({keyed(times)});
    EXPECT_EQ(found.fps, kAssumedFps);
    EXPECT_EQ(found.from, kAssumed);
  }
}

TEST(FrameRate, IsOneForAllClipsOfAFile) {
  const Animation film = keyed(every(1.0 / 24, 50)), pose = keyed({0, 0.1}), video = keyed(every(0.04, 50));
  EXPECT_EQ(rate_of({pose, film, pose, film}).fps, 24);
  EXPECT_EQ(rate_of({film, video}).from, kAssumed) << "no two rates";
}

TEST(FrameRate, OfTheUserGoesBeforeThatOfTheFileAndThatBeforeKeys) {
  Character tube = bending_tube();
  tube.animations[0].ticks_per_second = 24;
  EXPECT_EQ(frame_rate(tube, std::nullopt).fps, 24);
  EXPECT_EQ(frame_rate(tube, std::nullopt).from, kStated);
  EXPECT_EQ(frame_rate(tube, 12).fps, 12);
  EXPECT_EQ(frame_rate(tube, 12).from, kAsked);
  tube.animations = {keyed(every(0.04, 9))};
  for (const double unit : {0.0, 1.0, 1000.0, 4800.0, 46186158000.0}) {  // of time, and no rates of frames
    tube.animations[0].ticks_per_second = unit;
    EXPECT_EQ(frame_rate(tube, std::nullopt).fps, 25) << unit;
  }
  tube.animations[0].ticks_per_second = 60;
  EXPECT_EQ(frame_rate(tube, std::nullopt).fps, 60);
}

TEST(FrameRate, OfAnFbxFileIsItsTimeMode) {
  const auto rate = [](int mode, double custom) {
    FbxText file = triangle_file();
    file.settings = property("TimeMode", {static_cast<double>(mode)}) + property("CustomFrameRate", {custom});
    file.clip(0, 2);
    file.curve_node(60, 51, 20, "Lcl Translation", "");
    file.curve(61, 60, "d|X", {0, 2}, {0, 1});
    return frame_rate(read(file), std::nullopt);
  };
  EXPECT_EQ(rate(11, -1).fps, 24);
  EXPECT_EQ(rate(11, -1).from, kStated);
  EXPECT_EQ(rate(10, 24).fps, 25);
  EXPECT_EQ(rate(14, 12.5).fps, 12.5);
  EXPECT_EQ(rate(15, -1).fps, 96);
  EXPECT_EQ(rate(12, -1).fps, 1000);
  EXPECT_EQ(rate(12, -1).from, kStated);
  EXPECT_EQ(rate(14, 480).fps, 480);
  EXPECT_EQ(rate(14, 2).fps, 2);
  EXPECT_DOUBLE_EQ(rate(17, -1).fps, 60000.0 / 1001);
  for (const auto& [mode, custom] : {std::pair(0, 24.0), {14, -1}, {14, 1e9}, {99, 24}, {-1, 24}}) {
    EXPECT_EQ(rate(mode, custom).fps, kAssumedFps) << mode;
    EXPECT_EQ(rate(mode, custom).from, kAssumed);
  }
}

}  // namespace
}  // namespace cscd::scenes
