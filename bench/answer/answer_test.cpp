#include "bench/answer/answer.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "bench/answer/clip_answer.h"
#include "bench/answer/test_figure.h"
#include "bench/inputs/test_inputs.h"
#include "bench/strategies/catalogue.h"
#include "core/detect/start/embedding.h"
#include "core/mesh/test_shapes.h"

namespace cscd::bench {
namespace {

constexpr std::size_t kAll = 1'000'000;

const ElementaryTest& exact() {
  return elementary_test_named("filtered_exact");
}

// Cloth hangs near bones that do not carry it.
TEST(SurfaceNames, NameClothAndNotTheBoneNearestToIt) {
  const test::Shape ball = test::octahedron();
  const test::Shape shape = test::together(ball, test::moved(ball, {3, 0, 0}));
  const std::size_t vertices = ball.positions.size(), triangles = ball.triangles.size();
  Input input = input_of(shape, {shape.positions, shape.positions});
  input.rig = Rig{{BoneId{-1}}, {{Vec3(0, 0, 0), Vec3(0, 0, 1)}}};
  input.bone_names = {"thigh"};
  const TriangleId body{0}, cloth{static_cast<std::int32_t>(triangles)};
  EXPECT_EQ(SurfaceNames(input).place_of(cloth), "thigh");
  input.cloth_names = {"skirt"};
  const SurfaceNames names(input);
  EXPECT_EQ(names.place_of(body), "thigh");
  EXPECT_EQ(names.place_of(cloth), "skirt");
  EXPECT_EQ(names.part_of(cloth), "skirt");
  EXPECT_EQ(names.bone_of(VertexId{static_cast<std::int32_t>(vertices)}), "");
  EXPECT_NE(names.place_number(body), names.place_number(cloth));
}

// Everything that is said of every interval, held against the reference and against a look at each start from
// nothing. Mutations that die here: contacts taken for proof where the row reports the first alone; the end
// of an interval taken for the start of the next where they differ; pairs left out that nothing explains.
void expect_right(Input& input, const Strategy& strategy, const AnswerOptions& options, IntervalRange range,
                  VerdictCounts& verdicts) {
  Answerer answerer(input, strategy, exact(), options);
  const std::unique_ptr<Detector> reference = complete_reference().make(input.setup(exact())).detector;
  EmbeddingTest looked(input.mesh, input.reference);
  RestCrossings rest;
  if (!options.keep_rest_crossings)
    rest = {input.mesh,
            tell_meetings_apart(input.mesh, input.rest(), looked.find_all(input.rest(), kAll)).crossing};
  for (std::size_t i = range.first; i < range.last; ++i) {
    const IntervalAnswer answer = answerer.answer(i, input.clip->load(i));
    verdicts.add(answer.verdict);
    const scenes::ClipInterval interval = input.clip->load(i);
    Crossings start = looked.find_all(interval.motion.start(), kAll);
    EXPECT_EQ(answer.starts_embedded, start.total == 0) << i;
    EXPECT_EQ(answer.start.total + answer.start_touching.total + answer.rest_pairs, start.total) << i;
    rest.follow(start);
    std::erase_if(start.pairs, [&](const CrossingPair& pair) { return rest.explains(pair); });
    const Meetings met = tell_meetings_apart(input.mesh, interval.motion.start(), start);
    ASSERT_EQ(answer.start.pairs, met.crossing.pairs) << i;
    ASSERT_EQ(answer.start_touching.pairs, met.touching.pairs) << i;

    ContactSet expected;
    reference->detect({interval.motion, interval.bones ? &*interval.bones : nullptr}, expected);
    std::erase_if(expected.contacts, [&](const Contact& contact) { return rest.explains(contact.pair); });
    expected.sort();
    ASSERT_TRUE(answer.proven);
    const std::optional<double> first =
        expected.contacts.empty() ? std::nullopt : std::optional(expected.contacts.front().time);
    ASSERT_EQ(answer.time(), first) << i;
    if (answer.strategy->guarantee == Guarantee::complete && !options.first) {
      EXPECT_EQ(digest(answer.found), digest(expected)) << i;
    }
    const bool crosses = !met.crossing.pairs.empty();
    EXPECT_EQ(answer.verdict, crosses                     ? IntervalVerdict::intersects_at_start
                              : expected.contacts.empty() ? IntervalVerdict::clear
                                                          : IntervalVerdict::touches)
        << i;
  }
}

TEST(AnswerSummary, TakesRoundingForNoMotion) {
  const test::Shape ball = test::icosphere(1);
  for (const double by : {1e-11, 1e-6}) {
    Input input = input_of(ball, {ball.positions, moved_part(ball, 0, {by, 0, 0})});
    const SurfaceNames names(input);
    Answerer answerer(input, strategy_named("base"), exact(), {});
    AnswerSummary summary;
    summary.add(answerer.answer(0, input.clip->load(0)), input.clip->load(0).motion, names);
    EXPECT_EQ(summary.moves, by > 1e-9) << by;
  }
}

class Answers : public testing::TestWithParam<const char*> {};

// A figure that has eyes in its head at rest and touches itself in one of two clips.
TEST_P(Answers, OfACharacterAreRight) {
  const Scratch scratch;
  VerdictCounts verdicts;
  for (const char* clip : {"0", "1"})
    for (const bool keep : {false, true})
      for (const bool first : {false, true}) {
        Input input = figure_for(strategy_named(GetParam()), clip, scratch);
        expect_right(input, strategy_named(GetParam()), {first, false, keep},
                     {0, input.clip->interval_count()}, verdicts);
      }
  EXPECT_GT(verdicts[IntervalVerdict::clear], 3u);
  EXPECT_GT(verdicts[IntervalVerdict::intersects_at_start], 3u);
}

// Two balls, one of which flies into the other and rests there, and comes out again.
TEST_P(Answers, OfABodyInsideItselfSayThatItCollides) {
  for (const bool first : {false, true}) {
    Input input = two_balls({0.0, -0.5, -1.2, -2.2, -2.2, -1.9, -0.3, 0.1});
    VerdictCounts verdicts;
    expect_right(input, strategy_named(GetParam()), {first, false, false}, {0, 7}, verdicts);
    EXPECT_EQ(verdicts[IntervalVerdict::clear], 2u);
    EXPECT_EQ(verdicts[IntervalVerdict::touches], 1u);
    EXPECT_EQ(verdicts[IntervalVerdict::intersects_at_start], 4u);
  }
}

// Frame 0 crosses: that is how it is made, wherever the clip begins.
TEST_P(Answers, LeaveOutWhatCrossesInFrameZeroUnlessAsked) {
  const test::Shape balls =
      test::together(test::icosphere(2), test::moved(test::icosphere(2), {0.9, 0, 0}, 0.4));
  const std::size_t second = balls.positions.size() / 2;
  std::vector<std::vector<Vec3>> frames;
  for (const double x : {0.0, 0.01, 0.03, 0.01, -1.9, -1.9})
    frames.push_back(moved_part(balls, second, {x, 0, 0}));
  VerdictCounts left_out, kept;
  for (const bool first : {false, true}) {
    Input input = input_of(balls, frames);
    expect_right(input, strategy_named(GetParam()), {first, false, false}, {0, 5}, left_out);
    expect_right(input, strategy_named(GetParam()), {first, false, true}, {0, 5}, kept);
  }
  EXPECT_EQ(left_out[IntervalVerdict::clear], 6u);
  EXPECT_EQ(left_out[IntervalVerdict::touches], 2u) << "the ball flies through to the other side";
  EXPECT_EQ(left_out[IntervalVerdict::intersects_at_start], 2u) << "and crosses there";
  EXPECT_EQ(kept[IntervalVerdict::intersects_at_start], 10u);
}

// A simulator's step: intervals end where nothing goes on.
TEST_P(Answers, OfAScenesStepsAreRight) {
  Input input = open_input("urchin_contact");
  VerdictCounts verdicts;
  expect_right(input, strategy_named(GetParam()), {}, {0, input.clip->interval_count()}, verdicts);
  EXPECT_GT(verdicts[IntervalVerdict::touches], 3u);
}

INSTANTIATE_TEST_SUITE_P(Strategies, Answers, testing::Values("base", "drvbc_fast", "drvbc_fast_complete"),
                         [](const auto& name) { return std::string(name.param); });

TEST(Answerer, TakesARestPoseThatIsNotAFrame) {
  const test::Shape balls =
      test::together(test::icosphere(1), test::moved(test::icosphere(1), {0.9, 0, 0}, 0.4));
  const std::size_t second = balls.positions.size() / 2;
  const std::vector<Vec3> apart = moved_part(balls, second, {5, 0, 0}),
                          near_rest = moved_part(balls, second, {0.01, 0, 0});
  Input input = input_of(balls, {near_rest, balls.positions, apart, balls.positions}, balls.positions);
  Answerer answerer(input, strategy_named("drvbc_fast_complete"), exact(), {});
  EXPECT_GT(answerer.rest_crossings().total, 10u);
  for (const std::size_t interval : {0u, 1u}) {
    const IntervalAnswer answer = answerer.answer(interval, input.clip->load(interval));
    EXPECT_EQ(answer.verdict, IntervalVerdict::clear) << interval;
    EXPECT_GT(answer.rest_pairs, 10u) << interval;
    EXPECT_EQ(answer.rest_contacts > 0, interval == 1) << "it flies away from there";
  }
  EXPECT_EQ(answerer.answer(2, input.clip->load(2)).verdict, IntervalVerdict::touches)
      << "it has parted, and flies to where it rests";
  const IntervalAnswer pose = answerer.answer(3, {Motion(balls.positions, balls.positions), std::nullopt});
  EXPECT_EQ(pose.verdict, IntervalVerdict::intersects_at_start);
  EXPECT_EQ(pose.rest_pairs, 0u);
}

// Coplanar triangles that slide onto each other: boxes without end, cut off after a few.
TEST(Answerer, SaysWhatAnInexactTestCannotTell) {
  const test::Shape shape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}},
                          {test::corners(0, 1, 2), test::corners(3, 4, 5)}};
  Input input = input_of(shape, {shape.positions, moved_part(shape, 3, {-5, 0.1, 0})});
  Answerer inexact(input, strategy_named("base"), elementary_test_named("inclusion@1e-9:10"), {});
  const IntervalAnswer answer = inexact.answer(0, input.clip->load(0));
  EXPECT_FALSE(answer.found.contacts.empty());
  EXPECT_EQ(answer.time(), std::nullopt);
  EXPECT_EQ(answer.verdict, IntervalVerdict::undecided);
}

}  // namespace
}  // namespace cscd::bench
