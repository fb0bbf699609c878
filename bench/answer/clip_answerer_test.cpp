#include "bench/answer/clip_answerer.h"

#include <gtest/gtest.h>
#include <memory>

#include "bench/inputs/test_inputs.h"
#include "core/mesh/test_shapes.h"

namespace cscd::bench {
namespace {

// A clip that counts how often it is read.
class Counting final : public scenes::ClipSource {
 public:
  explicit Counting(std::unique_ptr<scenes::ClipSource> clip) : clip_(std::move(clip)) {}
  const scenes::ClipHeader& header() const override { return clip_->header(); }
  std::size_t frame_count() const override { return clip_->frame_count(); }
  scenes::ClipInterval load(std::size_t interval) override {
    ++intervals;
    return clip_->load(interval);
  }
  scenes::FrameView load_frame(std::size_t frame) override {
    ++frames;
    return clip_->load_frame(frame);
  }
  std::size_t intervals = 0, frames = 0;

 private:
  std::unique_ptr<scenes::ClipSource> clip_;
};

// One ball flies into another and rests there. Mutations: an interval is loaded for each strategy, or once
// more for its motion; the last pose starts an interval; strategies but the first are not told what touches.
TEST(ClipAnswerer, LoadsEachIntervalOnceForAllStrategies) {
  Input input = two_balls({0.0, -0.5, -1.2, -2.2, -2.2});
  auto counting = std::make_unique<Counting>(std::move(input.clip));
  Counting& reads = *counting;
  input.clip = std::move(counting);
  AnswerRequest request;
  request.strategies = {"drvbc_fast_complete", "base"};
  ClipAnswerer asked(request, std::move(input));
  reads.intervals = reads.frames = 0;
  std::size_t visits = 0;
  asked.answer_all("test", false, [&](const AnsweredPose& pose) {
    EXPECT_EQ(pose.frame, visits++);
    EXPECT_EQ(pose.is_last(), pose.frame == 4);
    if (pose.is_last()) return;
    ASSERT_EQ(pose.answers.size(), 2u);
    EXPECT_EQ(pose.answers[0].start.pairs, pose.answers[1].start.pairs);
    EXPECT_EQ(digest(pose.answers[0].found), digest(pose.answers[1].found));
  });
  EXPECT_EQ(visits, 5u);
  EXPECT_EQ(reads.intervals, 4u);
  EXPECT_EQ(reads.frames, 1u);
  for (const ClipAnswer& answer : asked.answers()) {
    EXPECT_EQ(answer.summary.verdicts[IntervalVerdict::intersects_at_start], 2u);
    EXPECT_EQ(answer.summary.verdicts[IntervalVerdict::touches], 1u);
    EXPECT_EQ(answer.summary.intervals(), 4u);
    ASSERT_TRUE(answer.last_pose);
    EXPECT_GT(answer.last_pose->start.total, 0u);
  }
}

}  // namespace
}  // namespace cscd::bench
