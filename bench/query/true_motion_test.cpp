#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/testing/test_queries.h"

// --true-motion from outside: what query says with it.
namespace cscd::bench {
namespace {

using nlohmann::json;

class TrueMotionOption : public QueryProgram {};

// What an answer says of straight lines alone.
json of_lines(json document) {
  document["summary"].erase("true_motion");
  document["summary"].erase("sentence");
  for (json& interval : document["intervals"]) interval.erase("true_motion");
  return document;
}

TEST_F(TrueMotionOption, AnswersBesideStraightLines) {
  const json lines = answer("figure.glb --clip hug"), both = answer("figure.glb --clip hug --true-motion");
  EXPECT_EQ(of_lines(timeless(lines)), of_lines(timeless(both)));
  EXPECT_FALSE(lines["summary"].contains("true_motion"));
  const json& summary = both["summary"]["true_motion"];
  EXPECT_EQ(summary["verdict"], "intersects_at_start");
  EXPECT_GT(summary["deviation"], 0);
  std::size_t count = 0;
  for (const char* verdict : {"clear", "touches", "close", "undecided", "intersects_at_start"})
    count += summary[verdict].get<std::size_t>();
  EXPECT_EQ(count, both["intervals"].size());
  bool first = true;
  for (const json& interval : both["intervals"]) {
    const json& own = interval["true_motion"];
    EXPECT_EQ(own["verdict"] == "intersects_at_start", interval["verdict"] == "intersects_at_start");
    if (own["verdict"] != "touches") continue;
    EXPECT_LE(own["to"].get<double>() - own["from"].get<double>(), 1.0 / 256 + 1e-9);
    if (first) {
      EXPECT_EQ(summary["first"]["interval"], interval["index"]);
    }
    first = false;
  }
  EXPECT_FALSE(first) << "nothing touches";
}

TEST_F(TrueMotionOption, FinePartsOfStraightLinesAgreeWithIt) {
  // Straight lines between many frames come as near to the true motion as anyone wants.
  const json coarse = answer("figure.glb --clip hug --fps 3 --true-motion"),
             fine = answer("figure.glb --clip hug --fps 768");
  double at = 2;
  for (const json& interval : fine["intervals"])
    if (interval["verdict"] != "clear") {
      at = interval["index"].get<double>() / 768;
      break;
    }
  const json& first = coarse["summary"]["true_motion"]["first"];
  ASSERT_FALSE(first.is_null());
  EXPECT_NEAR((first["interval"].get<double>() + first["to"].get<double>()) / 3, at, 2.0 / 768);
}

TEST_F(TrueMotionOption, SaysWhichMotionItAnswers) {
  const Ran lines = run("cscd query figure.glb --clip walk");
  EXPECT_NE(lines.out.find("answered for straight lines between frames; --true-motion asks"),
            std::string::npos);
  const Ran both = run("cscd query figure.glb --true-motion --fail-on-contact");
  EXPECT_EQ(both.status, 3) << both.errors;
  EXPECT_NE(both.out.find("  true motion: "), std::string::npos) << both.out;
  EXPECT_EQ(run("cscd query figure.glb --clip walk --true-motion --fail-on-contact").status, 0);
  EXPECT_EQ(run("cscd query small").out.find("--true-motion"), std::string::npos);
}

// The figure stays in a hug. Mutation: of intervals that start crossed, a deviation of 0 is told.
TEST_F(TrueMotionOption, SaysNothingOfWhatItDoesNotAsk) {
  scenes::Character figure = scenes::walking_figure();
  scenes::Animation& hug = figure.animations[1];
  for (scenes::Channel& channel : hug.channels) {
    const auto value = channel.rotations[channel.rotations.size() / 2].value;
    channel.rotations = {{hug.start, value}, {hug.start + 1, value}};
  }
  put("crossed.glb", scenes::to_glb(figure));
  const json crossed = answer("crossed.glb --clip hug --true-motion");
  const json& summary = crossed["summary"]["true_motion"];
  EXPECT_EQ(summary["not_asked"], crossed["intervals"].size()) << summary;
  EXPECT_TRUE(summary["deviation"].is_null());
  EXPECT_TRUE(crossed["intervals"][0]["true_motion"]["deviation"].is_null());
}

// Between two frames of one pose the figure jumps into a hug and out again. Mutations: the first sentence is
// about straight lines; a crossing after a jump has no pair.
TEST_F(TrueMotionOption, SaysFirstWhatTheTrueMotionDoes) {
  scenes::Character figure = scenes::walking_figure();
  scenes::Animation& hug = figure.animations[1];
  for (scenes::Channel& channel : hug.channels) {
    const auto open = channel.rotations.front().value,
               closed = channel.rotations[channel.rotations.size() / 2].value;
    channel.rotations = {{0, open}, {0.25, closed}, {0.5, open}, {1, open}};
  }
  hug.start = 0, hug.seconds = 1;
  json gltf = json::parse(scenes::to_gltf(figure));
  for (json& sampler : gltf["animations"][1]["samplers"]) sampler["interpolation"] = "STEP";
  put("jump.gltf", gltf.dump());
  const std::string command = "jump.gltf --clip hug --fps 1 --true-motion";
  const json found = answer(command);
  EXPECT_EQ(found["summary"]["verdict"], "clear");
  EXPECT_EQ(found["summary"]["true_motion"]["first"]["from"], 0.25);
  EXPECT_TRUE(found["intervals"][0]["true_motion"]["pair"].is_array());
  const Ran ran = run("cscd query " + command + " --fail-on-contact");
  EXPECT_EQ(ran.status, 3);
  for (const char* said :
       {"crosses itself in 1 of 1 intervals of its true motion", "first at frame 0.250 (0.25 s)"})
    EXPECT_NE(ran.out.find(said), std::string::npos) << ran.out;
  EXPECT_EQ(found["summary"]["sentence"].get<std::string>().find("does not"), std::string::npos);
}

// A frame lies between two keys that are a millionth of a second apart, and one of them stands for it. Keys
// of several bones that lie a hair beside a frame are on it. Mutation: a frame that is not where its key is
// counts as a fault of the program.
TEST_F(TrueMotionOption, TakesKeysThatAreNextToEachOther) {
  scenes::Character figure = scenes::walking_figure();
  scenes::Channel& pelvis = figure.animations[0].channels.back();
  const Vec3 before = pelvis.moves.front().value, after = pelvis.moves.back().value;
  const double frame = 4.0 / 12;
  pelvis.moves = {{0, before}, {frame - 5e-7, before}, {frame + 5e-7, after}, {1, after}};
  put("ramp.glb", scenes::to_glb(figure));
  // The eye turns in a step, between the frame and a key of other bones.
  pelvis.moves = {{0, before}, {frame + 5e-7, after}, {1, after}};
  scenes::Channel& eye = figure.animations[0].channels[7];
  eye.rotations[1].time = frame + 2e-7;
  json step = json::parse(scenes::to_gltf(figure));
  for (const json& channel : step["animations"][0]["channels"])
    if (channel["target"]["node"] == eye.node)
      step["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()]["interpolation"] = "STEP";
  put("step.gltf", step.dump());
  for (const char* file : {"ramp.glb", "step.gltf"}) {
    const json found = answer(std::string(file) + " --clip walk --fps 12 --true-motion");
    for (const json& interval : found["intervals"])
      EXPECT_EQ(interval["true_motion"]["verdict"],
                std::string(file) == "ramp.glb" && interval["index"] == 4 ? "undecided" : "clear")
          << file << ": " << interval["true_motion"];
  }
}

// An arm goes once round from frame to frame, through the body. Mutation: whether a clip moves is judged by
// its frames alone.
TEST_F(TrueMotionOption, TakesAMotionThatEndsEveryFrameWhereItBegan) {
  scenes::Character figure = scenes::walking_figure();
  figure.animations.erase(figure.animations.begin());
  scenes::Animation& turn = figure.animations[0];
  turn.channels.resize(1);
  turn.channels[0].rotations.clear();
  for (int k = 0; k <= 6; ++k)
    turn.channels[0].rotations.push_back({k / 3.0, scenes::from_euler({0, 120.0 * k, 0}, {0, 1, 2})});
  turn.seconds = 2;
  put("rotor.glb", scenes::to_glb(figure));
  const json found = answer("rotor.glb --fps 1 --true-motion");
  EXPECT_EQ(found["summary"]["verdict"], "clear");
  EXPECT_GT(found["summary"]["true_motion"]["touches"], 0);
  EXPECT_EQ(run("cscd query rotor.glb --fps 1 --true-motion --fail-on-contact").status, 3);
  const Ran lines = run("cscd query rotor.glb --fps 1");
  EXPECT_NE(lines.out.find("moves between its frames alone: at 1 a second"), std::string::npos) << lines.out;
  EXPECT_NE(lines.out.find("does not move in frames 0 to 2"), std::string::npos) << lines.out;
  EXPECT_EQ(run("cscd export rotor.glb --fps 1 rotor.h5").status, 0);
}

TEST_F(TrueMotionOption, TakesAResolution) {
  EXPECT_EQ(
      answer("figure.glb --clip hug --true-motion --resolution 0.1e")["summary"]["true_motion"]["verdict"],
      "intersects_at_start");
  expect_refused(run("cscd query figure.glb --clip walk --resolution 0.1"), "is for --true-motion");
  expect_refused(run("cscd query figure.glb --clip walk --true-motion --resolution 0"), "above 0");
  scenes::Character still = scenes::walking_figure();
  still.animations.clear();
  put("still.glb", scenes::to_glb(still));
  expect_refused(run("cscd query still.glb --true-motion"), "--true-motion: is one pose");
}

TEST_F(TrueMotionOption, RefusesInOneLine) {
  expect_refused(run("cscd query small --true-motion"), "nothing is known but straight lines");
  expect_refused(run("cscd query figure.glb --clip walk --true-motion --thickness 0.1"),
                 "takes no --thickness");
  expect_refused(run("cscd query figure.glb --clip walk --true-motion --from-bind-pose"), "leave out one of");
  expect_refused(run("cscd query figure.glb --clip walk --true-motion --new-contacts"), "one of the two");
  expect_refused(run("cscd query figure.glb --clip walk --true-motion --elementary newton"),
                 "know distances");
}

}  // namespace
}  // namespace cscd::bench
