#include "scenes/clip/clip.h"

#include <gtest/gtest.h>
#include <limits>

#include "core/base/test_refusal.h"
#include "scenes/clip/digest.h"
#include "scenes/clip/test_clips.h"

namespace cscd::scenes {
namespace {

std::string refusal(Clip& clip, const FrameView& frame, const FrameView* predicted = nullptr) {
  return test::refusal([&] { clip.append(frame, predicted); });
}

TEST(Clip, GivesIntervalsAsViewsOfItsFrames) {
  const Clip clip = small_clip({.frames = 3, .bones = 2});
  ASSERT_EQ(clip.interval_count(), 2u);
  const ClipInterval interval = clip.interval(1);
  EXPECT_EQ(interval.motion.start().data(), clip.frame(1).positions.data());
  EXPECT_EQ(interval.motion.end().data(), clip.frame(2).positions.data());
  ASSERT_TRUE(interval.bones);
  EXPECT_EQ(interval.bones->start.data(), clip.frame(1).bones.data());
  EXPECT_EQ(interval.bones->end.size(), 2u);
}

TEST(Clip, EndsIntervalsAtPredictionsWhereItHasThem) {
  const Clip clip = small_clip({.frames = 3, .bones = 1, .predicted = true});
  EXPECT_EQ(clip.interval(1).motion.end()[2], predicted_position(1, 2));
  EXPECT_NE(clip.interval(1).motion.end()[2], clip.frame(2).positions[2]);
  EXPECT_EQ(clip.interval(1).motion.start()[2], clip.frame(1).positions[2]);
  EXPECT_EQ(clip.interval(0).bones->end[0].head, predicted_position(0, 100));
}

TEST(Clip, HasNoBonesWithoutARig) {
  Clip clip = small_clip({.frames = 2});
  EXPECT_FALSE(clip.interval(0).bones);
  EXPECT_FALSE(rig_of(clip));
  Clip rigged = small_clip({.frames = 2, .bones = 2});
  const std::optional<Rig> rig = rig_of(rigged);
  ASSERT_TRUE(rig);
  EXPECT_EQ(rig->parent, rigged.header().bone_parent);
  EXPECT_EQ(rig->reference[1].tail, rigged.frame(0).bones[1].tail);
}

TEST(Clip, RefusesFramesThatDoNotFitAndNamesThem) {
  Clip clip = small_clip({.frames = 2, .bones = 1});
  std::vector<Vec3> positions(clip.header().vertex_count, Vec3::Zero());
  std::vector<Bone> bones(1, Bone{Vec3::Zero(), Vec3::Ones()});
  EXPECT_EQ(refusal(clip, {positions, {}}), "frame 2: 0 bones for a rig of 1; give one each");
  EXPECT_EQ(refusal(clip, {std::span(positions).first(2), bones}),
            "frame 2: 2 positions for 4 vertices; give one each");
  const FrameView good{positions, bones};
  EXPECT_EQ(refusal(clip, good, &good), "frame 2: a prediction that the clip does not announce");
  positions[3].y() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal(clip, {positions, bones}),
            "frame 2, vertex 3: position is not finite; repair the animation");
  positions[3].y() = 0;
  bones[0].tail.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(clip, {positions, bones}), "frame 2, bone 0: joint is not finite; repair the animation");
  EXPECT_EQ(clip.frame_count(), 2u) << "nothing refused is kept";

  Clip predicted = small_clip({.frames = 2, .predicted = true});
  EXPECT_EQ(refusal(predicted, {positions, {}}),
            "frame 2: the prediction is missing; give one for every frame but the first");
}

TEST(Digest, IsFnv1aAndSeesEveryBit) {
  EXPECT_EQ(digest(""), "cbf29ce484222325");
  EXPECT_EQ(digest("foobar"), "85944171f73967e8");
  Clip clip = small_clip({.frames = 3, .bones = 2, .predicted = true});
  const auto digest_of = [](Clip& source) {
    DigestSink sink;
    copy_frames(source, sink);
    return sink.text();
  };
  const std::string whole = digest_of(clip);
  EXPECT_EQ(whole, digest_of(clip));
  Clip fewer = small_clip({.frames = 2, .bones = 2, .predicted = true});
  EXPECT_NE(whole, digest_of(fewer));
  std::vector<Vec3> positions(4, Vec3::Zero());
  FrameDigest zero, minus_zero;
  zero.add({positions, {}});
  positions[3].z() = -0.0;
  minus_zero.add({positions, {}});
  EXPECT_NE(zero.text(), minus_zero.text());
}

}  // namespace
}  // namespace cscd::scenes
