#include "bench/answer/answer_text.h"

#include <gtest/gtest.h>

#include "bench/answer/answer_json.h"
#include "bench/answer/clip_answerer.h"
#include "bench/inputs/test_inputs.h"

namespace cscd::bench {
namespace {

struct Said {
  std::vector<std::string> sentences;
  std::string sentence, text;
  DepthCheck depth;  // at most 0.1 deep
  nlohmann::json summary;
};

Said said(Input input, const AnswerRequest& request = {}) {
  ClipAnswerer asked(request, std::move(input));
  asked.answer_all("test", false, [](const AnsweredPose&) {});
  const ClipAnswer& answer = asked.answers().front();
  return {verdict_sentences(answer), verdict_text(answer), clip_text(answer),
          check_depth(answer, {.text = "0.1", .number = 0.1}), summary_json(answer)};
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

Input one_pose(double shift) {
  Input input = two_balls({shift, shift});
  input.is_one_pose = true;
  return input;
}

// Mutation: a clip of which only what is left out touches is said not to touch itself.
TEST(AnswerText, SaysWhatAClipDoesAndWhen) {
  EXPECT_EQ(said(two_balls({0, 0.5})).sentence, "test does not touch itself in frames 0 to 1.");
  EXPECT_EQ(said(two_balls({0, 0})).sentence,
            "test does not move in frames 0 to 1, and does not touch itself.");
  EXPECT_EQ(said(two_balls({0, -1.2, 0})).sentence,
            "test: component 1 is 0.1156 deep in component 0, at frame 1 alone. It crosses itself at the "
            "start of 1 of 2 intervals and touches itself in 1 more, first at frame 0.9: component 0 touches "
            "component 1.");
  EXPECT_EQ(
      said(two_balls({-1.2, -1.3, 0})).sentence,
      "test touches itself in frames 0 to 2 only in what crosses at rest, which comes to lie deeper than "
      "there.");
  AnswerRequest kept;
  kept.answers.keep_rest_crossings = true;
  EXPECT_EQ(said(two_balls({-1.2, -1.3, 0}), kept).sentence,
            "test: component 1 is 0.21 deep in component 0, deepest at frame 1 (frames 0 to 1). It crosses "
            "itself at the start of 2 of 2 intervals, first at frame 0: component 0 crosses component 1.");
}

// Three balls: the second dips into the first twice, deeper the second time, and the third flies through the
// first between two frames.
Input three_balls() {
  const test::Shape ball = test::icosphere(1);
  const test::Shape all = test::together(test::together(ball, test::moved(ball, {3, 0.1, 0.2})),
                                         test::moved(ball, {0.1, 0.2, 3}));
  const std::size_t n = ball.positions.size();
  std::vector<std::vector<Vec3>> frames;
  for (const auto& [second, third] : {std::pair(0.0, 0.0),
                                      {0.0, -6.0},
                                      {-1.2, -6.0},
                                      {0.0, -6.0},
                                      {-1.3, -6.0},
                                      {-1.4, -6.0},
                                      {0.0, -6.0}}) {
    frames.push_back(all.positions);
    for (std::size_t v = 0; v < n; ++v)
      frames.back()[n + v].x() += second, frames.back()[2 * n + v].z() += third;
  }
  return input_of(all, frames);
}

// Mutations: the first contact stays first; what begins first, or lies less deep, is taken for the worst;
// what crosses is said only to touch.
TEST(AnswerText, SaysTheWorstFirst) {
  const Said found = said(three_balls());
  EXPECT_EQ(found.sentence,
            "test: component 1 is 0.3043 deep in component 0, deepest at frame 5 (frames 4 to 5). These only "
            "touch: component 0 and component 2. It crosses itself at the start of 3 of 6 intervals and "
            "touches itself in 3 more, first at frame 0.18: component 2 touches component 0.");
  EXPECT_EQ(found.text.find(found.sentences[0] + "\n  " + found.sentences[1] + "\n  " + found.sentences[2]),
            0u)
      << found.text;
  AnswerRequest fresh;
  fresh.new_contacts = true;
  EXPECT_EQ(said(three_balls(), fresh).sentence,
            "test touches itself in 3 of 6 intervals, apart from what lies in itself already, first at frame "
            "0.18: component 2 touches component 0.");
}

// Mutation: what comes close is said to touch.
TEST(AnswerText, SaysHowNearThingsCome) {
  AnswerRequest thick;
  thick.thickness = {.thickness = parse_length("--thickness", "0.5"), .rings = 3};
  EXPECT_EQ(said(two_balls({0, 0.5}), thick).sentence,
            "test does not come within 0.5 of itself in frames 0 to 1.");
  const Said close = said(two_balls({0, -0.8, 0}), thick);
  EXPECT_EQ(
      close.sentence,
      "test comes within 0.5 of itself in 2 of 2 intervals, first at frame 0.68: component 0 comes close "
      "to component 1.");
  EXPECT_TRUE(has(close.text, "2 intervals: 0 clear, 2 close, 0 touch, 0 cross at their start"))
      << close.text;
  EXPECT_TRUE(has(close.text, "left out (--exclude-rings 3), and 0 others are this close at rest"))
      << close.text;
  EXPECT_EQ(said(two_balls({0, -1.2}), thick).sentence,
            "test: component 1 is 0.1156 deep in component 0, at frame 1 alone. It touches itself in 1 of 1 "
            "interval, first at frame 0.46: component 0 comes close to component 1.");
}

// Three balls, each with a bone, the first of which a joint joins to the second and that one to the third.
// In each frame the second ball is shifted along x, and the third one along z.
Input jointed_balls(std::initializer_list<std::pair<double, double>> shifts) {
  const test::Shape ball = test::icosphere(2);
  const Vec3 second(3, 0.1, 0.2), third(0.1, 0.2, 3);
  const test::Shape all =
      test::together(test::together(ball, test::moved(ball, second)), test::moved(ball, third));
  const std::size_t n = ball.positions.size();
  Rig rig{{BoneId{-1}, BoneId{0}, BoneId{1}}, {}};
  for (const Vec3& at : {Vec3(0, 0, 0), second, third}) rig.reference.push_back({at, at + Vec3(0, 0.1, 0)});
  auto clip = std::make_unique<scenes::Clip>(
      scenes::ClipHeader{all.triangles, all.positions.size(), rig.parent, false, all.positions});
  for (const auto& [x, z] : shifts) {
    std::vector<Vec3> frame = all.positions;
    for (std::size_t v = 0; v < n; ++v) frame[n + v].x() += x, frame[2 * n + v].z() += z;
    clip->append({frame, rig.reference});
  }
  Input out{"test", std::move(clip), all.mesh(), all.positions, rig};
  out.bone_names = {"thigh", "calf", "hand"};
  return out;
}

// Mutations: a fold at a joint is the headline, or the first contact that is named; however deep, what meets
// at a joint is a fold; folds are left out of counts.
TEST(AnswerText, SaysFoldsAtJointsInOneQuietLine) {
  AnswerRequest base;
  base.strategies = {"base"};
  const Said both = said(jointed_balls({{0, 0}, {-1.3, 0}, {-1.3, -1.15}, {0, 0}}), base);
  EXPECT_EQ(
      both.sentence,
      "test: thigh is 0.1105 deep in hand, at frame 2 alone. It crosses itself at the start of 2 of 3 "
      "intervals and touches itself in 1 more, first away from joints at frame 1.9: thigh touches hand.");
  EXPECT_TRUE(has(both.text,
                  "\n  met: hand and thigh (2 intervals)\n"
                  "  at joints, less deep than a tenth of the limb's girth: calf and thigh (3 "
                  "intervals); 184 contacts and 92 crossing pairs of triangles "
                  "(--ignore-neighbours 1 ignores such pairs)\n"))
      << both.text;
  EXPECT_TRUE(has(both.text, "\n  lies in itself in 1 place, and at joints in 1 more:\n    thigh in hand: "))
      << both.text;
  const nlohmann::json& events = both.summary["events"];
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0]["at_joint"], true);
  EXPECT_EQ(events[1]["at_joint"], false);
  EXPECT_GT(events[0]["depth"]["at_least"], events[1]["depth"]["at_least"]);
  EXPECT_EQ(both.summary["headline"]["event"], 1);
  EXPECT_LT(both.summary["first"]["frame"], 1);
  EXPECT_EQ(both.summary["first_named"]["interval"], 1);
  EXPECT_EQ(both.summary["first_named"]["second"], "hand");
  for (const nlohmann::json& row : both.summary["met"]) EXPECT_EQ(row["at_joint"], row["first"] == "calf");
  const Said folds = said(jointed_balls({{0, 0}, {-1.3, 0}, {0, 0}}), base);
  EXPECT_EQ(folds.sentence,
            "test crosses itself at the start of 1 of 2 intervals and touches itself in 1 more, only at "
            "joints and less deep than a tenth of the limb's girth, first at frame 0.8: thigh touches calf.");
  EXPECT_TRUE(has(folds.text, "\n  folds onto itself at joints in 1 place\n")) << folds.text;
  EXPECT_TRUE(folds.summary["headline"].is_null());
  EXPECT_TRUE(folds.depth.fails) << "a fold is as deep as anything";
  const Said deep = said(jointed_balls({{0, 0}, {-1.9, 0}, {0, 0}}), base);
  EXPECT_EQ(deep.sentence.find("test: calf is 0.798 deep in thigh, at frame 1 alone. It crosses "), 0u)
      << deep.sentence;
}

// Mutation: the pose is called an interval.
TEST(AnswerText, SaysWhatOnePoseIs) {
  EXPECT_EQ(said(one_pose(0)).sentence, "test does not touch itself in its one pose.");
  EXPECT_EQ(said(one_pose(-1.2)).sentence,
            "test: component 1 is 0.1156 deep in component 0. It crosses itself in its one pose: 12 pairs of "
            "triangles, component 0 crosses component 1.");
}

// Mutation: the last pose is not looked at.
TEST(AnswerText, SaysWhatCrossesAtTheEndAndHowDeep) {
  const Said ends = said(two_balls({0, -1.2}));
  EXPECT_TRUE(has(ends.text, "\n  ends crossed: 12 pairs of triangles cross in its last pose, frame 1\n"))
      << ends.text;
  EXPECT_FALSE(has(said(two_balls({0, -1.2, 0})).text, "ends crossed"));
  EXPECT_TRUE(ends.depth.fails);
  EXPECT_TRUE(has(ends.depth.text, "--fail-deeper-than 0.1: fails, because something lies deeper: 0.1"))
      << ends.depth.text;
  const Said clear = said(two_balls({0, 0.5}));
  EXPECT_FALSE(clear.depth.fails);
  EXPECT_EQ(clear.depth.text, "--fail-deeper-than 0.1: passes: nothing is known to lie deeper");
}

}  // namespace
}  // namespace cscd::bench
