// What lies on or in each other in the pose at rest, and what becomes of it: a box over a box.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <vector>

#include "bench/testing/test_queries.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

class AtRest : public QueryProgram {
 protected:
  static bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }
  // A box of half the width over the unit cube, whose upper side is at 1; its lower side is at `bottom`, and
  // it lies to one side by `shift`.
  static std::string boxes(double bottom, double inset = 0.25, double shift = 0) {
    std::string obj;
    for (const bool upper : {false, true})
      for (const double z : {0.0, 1.0})
        for (const double y : {0.0, 1.0})
          for (const double x : {0.0, 1.0}) {
            const double low = upper ? inset : 0, width = upper ? 1 - 2 * inset : 1;
            obj += "v " + std::to_string(low + width * x + (upper ? shift : 0)) + " " +
                   std::to_string(low + width * y) + " " + std::to_string(upper ? bottom + 0.5 * z : z) +
                   "\n";
          }
    constexpr int kFaces[][3] = {{1, 3, 4}, {1, 4, 2}, {5, 6, 8}, {5, 8, 7}, {1, 2, 6}, {1, 6, 5},
                                 {3, 7, 8}, {3, 8, 4}, {1, 5, 7}, {1, 7, 3}, {2, 4, 8}, {2, 8, 6}};
    for (const int first : {0, 8})
      for (const auto& face : kFaces) {
        obj += "f";
        for (const int corner : face) obj += " " + std::to_string(first + corner);
        obj += "\n";
      }
    return obj;
  }
  // Frame by frame, the lower side of the upper box is that high.
  void put_frames(const std::vector<double>& bottoms, double inset = 0.25) const {
    for (std::size_t i = 0; i < 10; ++i) fs::remove(folder / ("f." + std::to_string(i) + ".obj"));
    for (std::size_t i = 0; i < bottoms.size(); ++i)
      put("f." + std::to_string(i) + ".obj", boxes(bottoms[i], inset));
  }
  static std::string sentence(const json& document) { return document["summary"]["sentence"]; }
  int status(const std::string& words) const { return run("cscd query f.0.obj " + words).status; }
};

// The verdict of an interval, how its first sentence and the page's begin, and how many pairs of triangles
// cross and touch at its start. Mutations: what touches at a start crosses; what crosses beside it touches.
TEST_F(AtRest, WhatOnlyTouchesAtAStartIsSaidToTouch) {
  struct Pose {
    const char* what;
    double bottom, inset, shift;
    bool crosses, touches;
  };
  for (const Pose& pose :
       {Pose{"rests on it", 1, 0.25, 0, false, true}, Pose{"rests, as wide", 1, 0, 0, false, true},
        Pose{"lies half beside it", 1, 0.25, 0.5, false, true},
        Pose{"shares a part of an edge", 1, 0.25, 0.75, false, true},
        Pose{"shares a corner's height alone", 1, 0.25, 1.5, false, false},
        Pose{"is pressed in", 0.75, 0.25, 0, true, false},
        Pose{"crosses along edges of both alone", 0.75, 0, 0, true, false}}) {
    SCOPED_TRACE(pose.what);
    // The first frame is apart, and the third slides or lifts from the pose.
    put("f.0.obj", boxes(2));
    put("f.1.obj", boxes(pose.bottom, pose.inset, pose.shift));
    for (const bool lifts : {false, true}) {
      put("f.2.obj", boxes(pose.bottom + (lifts ? 0.5 : 0), pose.inset, pose.shift + (lifts ? 0 : 0.0625)));
      const json found = answer("f.0.obj --frames 1:2"), &interval = found["intervals"][0];
      EXPECT_EQ(interval["verdict"], pose.crosses   ? "intersects_at_start"
                                     : pose.touches ? "touches"
                                                    : "clear");
      EXPECT_EQ(interval["start_pairs_total"] > 0, pose.crosses) << interval;
      EXPECT_TRUE(pose.crosses || (interval["start_touching"] > 0) == pose.touches) << interval;
      EXPECT_EQ(interval["starts_embedded"], !pose.crosses && !pose.touches);
      const std::string said = sentence(found), text = run("cscd query f.0.obj --frames 1:2").out;
      const bool meets = pose.crosses || pose.touches;
      EXPECT_EQ(has(said, pose.crosses ? " crosses itself at the start of 1 of 1 interval, first at frame 1 ("
                                       : " touches itself in 1 of 1 interval, first at frame 1 ("),
                meets)
          << said;
      EXPECT_EQ(has(said, "cross"), pose.crosses) << said;
      EXPECT_EQ(
          has(text, pose.crosses ? " 0 touch, 1 cross at their start" : " 1 touch, 0 cross at their start"),
          meets)
          << text;
      EXPECT_EQ(has(text, "lies in itself"), pose.crosses) << text;
      if (!pose.touches || pose.crosses) continue;
      EXPECT_EQ(interval["time"], 0);
      EXPECT_GT(interval["contacts"].size(), 0u);
      for (const json& event : found["summary"]["events"]) EXPECT_EQ(event["crosses"], false);
    }
  }
}

TEST_F(AtRest, WhatTouchesInTheLastPoseOrInOnePoseIsSaidToTouch) {
  put_frames({1.5, 1});
  const json last = answer("f.0.obj")["last_pose"];
  EXPECT_EQ(last["pairs_total"], 0);
  EXPECT_GT(last["touching"], 0);
  EXPECT_FALSE(has(run("cscd query f.0.obj").out, "ends crossed"));
  put("lone.obj", boxes(1));
  EXPECT_TRUE(has(sentence(answer("lone.obj")), "lone.obj touches itself in its one pose: the surface, "))
      << answer("lone.obj");
  EXPECT_EQ(run("cscd query lone.obj --fail-on-contact").status, 3);
}

// With a thickness, what is close at first and touches later is said to come close at that moment.
TEST_F(AtRest, WhatTouchesAtAStartTouchesWithinAThicknessToo) {
  put_frames({1, 1.5});
  const json rests = answer("f.0.obj --thickness 0.125");
  EXPECT_EQ(rests["intervals"][0]["verdict"], "touches");
  EXPECT_TRUE(has(sentence(rests), "first at frame 0 (0 s): the surface, component 0 touches "))
      << sentence(rests);
  put_frames({1.5, 1});
  const json falls = answer("f.0.obj --thickness 0.125");
  EXPECT_EQ(falls["intervals"][0]["verdict"], "touches");
  EXPECT_TRUE(has(sentence(falls), " comes close to the surface, component ")) << sentence(falls);
}

// Mutations: what touches at rest is left out for good; what has parted goes on being left out.
TEST_F(AtRest, WhatLiesOnEachOtherIsAnAnswer) {
  for (const double inset : {0.25, 0.0}) {  // boxes of equal width have walls in one plane
    SCOPED_TRACE(inset);
    put_frames({1, 1.5, 1.25, 0.75, 0.751}, inset);
    const json lifted = answer("f.0.obj");
    EXPECT_FALSE(has(sentence(lifted), "does not touch")) << sentence(lifted);
    EXPECT_TRUE(has(sentence(lifted), "first at frame 0 (0 s): the surface, component 0 touches"))
        << sentence(lifted);
    EXPECT_TRUE(has(sentence(lifted), "; once it had parted, again at frame 2.5 (")) << sentence(lifted);
    EXPECT_EQ(lifted["intervals"][1]["verdict"], "clear");
    EXPECT_EQ(lifted["intervals"][2]["verdict"], "touches");
    EXPECT_EQ(lifted["intervals"][2]["time"], 0.5);
    EXPECT_EQ(lifted["intervals"][3]["verdict"], "intersects_at_start");
    EXPECT_EQ(lifted["rest_crossings"]["pairs"], 0);
    EXPECT_GT(lifted["rest_crossings"]["touching"], 0);
    EXPECT_EQ(status("--fail-on-contact"), 3);
    put_frames({1, 0.9, 0.75}, inset);  // pressed in at once
    EXPECT_EQ(answer("f.0.obj")["intervals"][1]["verdict"], "intersects_at_start");
  }
  put_frames({1, 1.5, 1.25, 0.75, 0.751});
  const json events = answer("f.0.obj")["summary"]["events"];
  ASSERT_FALSE(events.empty());
  EXPECT_NEAR(events.back()["depth"]["at_least"].get<double>(), 0.25, 1e-12) << events;
}

TEST_F(AtRest, WhatPartsAndComesBackIsAnAnswer) {
  put_frames({0.9, 0.95, 1.2, 0.9, 0.9});
  const json found = answer("f.0.obj");
  EXPECT_GT(found["rest_crossings"]["pairs"], 0);
  const char* const kVerdicts[] = {"clear", "clear", "touches", "intersects_at_start"};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(found["intervals"][i]["verdict"], kVerdicts[i]) << i;
  EXPECT_NEAR(found["summary"]["first"]["frame"].get<double>(), 2 + 2.0 / 3, 1e-9);
  EXPECT_EQ(found["intervals"][3]["left_out"]["start_pairs"], 0);
  EXPECT_EQ(status("--fail-on-contact"), 3);
}

// Mutations: depths are not compared; what is as deep as at rest counts.
TEST_F(AtRest, WhatLiesDeeperThanAtRestIsAnAnswer) {
  put_frames({0.9, 0.9, 0.95, 0.9});
  const json same = answer("f.0.obj");
  EXPECT_EQ(same["summary"]["verdict"], "clear");
  EXPECT_EQ(sentence(same), "f.0.obj touches itself in frames 0 to 3 only in what crosses at rest.");
  EXPECT_EQ(status("--fail-on-contact"), 0);
  EXPECT_TRUE(same["summary"]["events"].empty());
  put_frames({0.9, 0.85, 0.6, 0.95});
  const json pressed = answer("f.0.obj");
  EXPECT_EQ(
      sentence(pressed),
      "f.0.obj touches itself in frames 0 to 3 only in what crosses at rest, which comes to lie deeper than "
      "there.");
  ASSERT_EQ(pressed["summary"]["events"].size(), 1u);
  const json& event = pressed["summary"]["events"][0];
  EXPECT_NEAR(event["depth"]["at_least"].get<double>(), 0.4, 1e-9);
  EXPECT_EQ(event["deepest"]["frame"], 2);
  EXPECT_NEAR(event["at_rest"].get<double>(), 0.1, 1e-9);
  EXPECT_EQ(status("--fail-deeper-than 0.3"), 3);
  EXPECT_EQ(status("--fail-deeper-than 0.5"), 0);
  EXPECT_TRUE(has(run("cscd query f.0.obj").out, ", deeper than at rest (0.1)"));
}

// Mutation: what starts no interval is not looked at.
TEST_F(AtRest, TheLastPoseIsLookedAt) {
  put_frames({1.5, 1.25, 0.75});
  const json found = answer("f.0.obj");
  EXPECT_GT(found["last_pose"]["pairs_total"], 0);
  EXPECT_EQ(found["last_pose"]["pairs"].size(), found["last_pose"]["pairs_total"]);
  EXPECT_EQ(found["last_pose"]["frame"], 2);
  ASSERT_EQ(found["summary"]["events"].size(), 1u);
  const json& event = found["summary"]["events"][0];
  EXPECT_EQ(event["deepest"]["frame"], 2);
  EXPECT_EQ(event["deepest"]["interval"], 1);
  EXPECT_EQ(event["deepest"]["time"], 1);
  EXPECT_EQ(status("--fail-deeper-than 0.2"), 3);
  EXPECT_EQ(status("--fail-deeper-than 0.3"), 0);
  // The two touch before, and cross there: one sentence does not contradict the other.
  EXPECT_FALSE(has(sentence(found), "only touch")) << sentence(found);
  const json part = answer("f.0.obj --frames 0:1");
  EXPECT_EQ(part["last_pose"]["frame"], 1);
  EXPECT_EQ(part["last_pose"]["pairs_total"], 0);
}

// Mutation: the one pose is taken for the pose at rest, whose crossings are left out.
TEST_F(AtRest, OnePoseIsAnsweredByItself) {
  put("lone.obj", boxes(0.75));
  put("lone.7.obj", boxes(1.1));
  const json crossed = answer("lone.obj"), free = answer("lone.7.obj");
  EXPECT_EQ(crossed["one_pose"], true);
  EXPECT_EQ(crossed["intervals"].size(), 1u);
  EXPECT_EQ(crossed["last_pose"], nullptr);
  EXPECT_EQ(crossed["summary"]["verdict"], "intersects_at_start");
  EXPECT_TRUE(has(sentence(crossed),
                  "lone.obj: the surface, component 1 is 0.25 deep in the surface, component 0. It crosses "
                  "itself in its one pose: "))
      << sentence(crossed);
  EXPECT_NEAR(crossed["summary"]["events"][0]["depth"]["at_least"].get<double>(), 0.25, 1e-12);
  EXPECT_EQ(sentence(free), "lone.7.obj does not touch itself in its one pose.");
  EXPECT_EQ(run("cscd query lone.obj --fail-deeper-than 0.2").status, 3);
  EXPECT_EQ(run("cscd query lone.obj --fail-deeper-than 0.3").status, 0);
  EXPECT_EQ(run("cscd query lone.7.obj --fail-on-contact").status, 0);
  EXPECT_EQ(answer("lone.7.obj --thickness 0.2")["summary"]["verdict"], "close");
  EXPECT_EQ(run("cscd inspect lone.obj").status, 0);
  expect_refused(run("cscd export lone.obj out.ply"), "is one pose, and nothing moves");

  scenes::Character still = scenes::walking_figure();
  still.animations.clear();
  put("still.glb", scenes::to_glb(still));
  const json figure = answer("still.glb");
  EXPECT_EQ(figure["one_pose"], true);
  EXPECT_EQ(figure["summary"]["verdict"], "intersects_at_start") << "its eyes lie in its head";

  // Frames that are all one pose are that pose. Mutation: its crossings are left out.
  put_frames({0.75, 0.75, 0.75});
  EXPECT_EQ(answer("f.0.obj")["one_pose"], true);
  EXPECT_EQ(status("--fail-deeper-than 0.2"), 3);
  put_frames({0.75, 0.75, 0.76});
  EXPECT_EQ(answer("f.0.obj")["one_pose"], false);

  // A clip of several frames that moves nothing is a pose too.
  scenes::Character kept = scenes::bending_tube();
  for (auto& key : kept.animations[0].channels[0].rotations)
    key.value = kept.animations[0].channels[0].rotations[0].value;
  put("kept.glb", scenes::to_glb(kept));
  EXPECT_EQ(run("cscd query kept.glb").status, 0);
  EXPECT_EQ(
      sentence(answer("kept.glb --clip 0")),
      "kept.glb, clip 'bend' (the only one), does not move in frames 0 to 30, and does not touch itself.");
  EXPECT_TRUE(answer("figure.glb --clip walk")["summary"]["verdict"] == "clear");
}

// Mutations: a clip of one pose is passed over; what crosses at rest, as eyes in a head do, counts in it.
TEST_F(AtRest, AClipOfOnePoseIsAnsweredBesideOthers) {
  scenes::Character figure = scenes::walking_figure();
  scenes::Animation& hugged = figure.animations[1];
  hugged.seconds = 0;
  for (scenes::Channel& channel : hugged.channels) channel.rotations = {{0, channel.rotations.back().value}};
  put("posed.glb", scenes::to_glb(figure));
  const json all = answer("posed.glb");
  ASSERT_EQ(all["clips"].size(), 2u);
  EXPECT_EQ(all["clips"][0]["summary"]["verdict"], "clear");
  const json& pose = all["clips"][1];
  EXPECT_EQ(pose["one_pose"], true);
  EXPECT_EQ(pose["summary"]["verdict"], "intersects_at_start") << sentence(pose);
  EXPECT_FALSE(has(pose["summary"]["met"].dump(), "eye")) << pose["summary"]["met"];
  EXPECT_EQ(run("cscd query posed.glb --fail-on-contact").status, 3);
  EXPECT_EQ(run("cscd query posed.glb --fail-deeper-than 1cm").status, 3);
  EXPECT_EQ(answer("posed.glb --true-motion")["clips"].size(), 1u);
}

// Of faces with the same corners one is kept: with two, no depth would be known. Mutation: all are kept.
TEST_F(AtRest, IdenticalTrianglesAreLeftOutAndSaid) {
  for (const std::string twice : {"f 1 3 4\nf 4 1 3\n", "f 1 4 3\nf 4 3 1\n"}) {
    SCOPED_TRACE(twice);
    put_frames({1.5, 1.25, 0.75});
    const json plain = answer("f.0.obj");
    for (const char* file : {"f.0.obj", "f.1.obj", "f.2.obj"}) put(file, text(file) + twice);
    const json found = answer("f.0.obj");
    EXPECT_EQ(found["import"]["duplicate_triangles"], 2);
    EXPECT_EQ(found["identical_triangles"], 0);
    EXPECT_EQ(found["summary"]["events"], plain["summary"]["events"]);
    EXPECT_EQ(status("--fail-deeper-than 0.2"), 3);
    EXPECT_EQ(status("--fail-deeper-than 0.3"), 0);
    for (const char* command : {"query", "inspect"})
      EXPECT_TRUE(has(run("cscd " + std::string(command) + " f.0.obj").out, "2 duplicate triangles"))
          << command;
  }
}

// Mutations: a depth of which only a bound is known passes; what only touches fails.
TEST_F(AtRest, ADepthThatIsNotKnownFailsUnlessItsBoundIsSmall) {
  put_frames({1, 1.5});
  EXPECT_EQ(status("--fail-deeper-than 0.1"), 0) << "one box rests on the other";
  // A tetrahedron comes to lie on its copy.
  for (const int frame : {0, 1, 2}) {
    std::string obj;
    for (const double shift : {0.0, frame == 1 ? 0.0 : 2.0})
      for (const auto& [x, y, z] : {std::array{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})
        obj += "v " + std::to_string(x + shift) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    put("f." + std::to_string(frame) + ".obj",
        obj + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 7 5 8\n");
  }
  const auto asked = run("cscd query f.0.obj --fail-deeper-than 0.1");
  EXPECT_EQ(asked.status, 3);
  EXPECT_TRUE(has(asked.out, "fails, because a depth is not known: at most ")) << asked.out;
  EXPECT_EQ(status("--fail-deeper-than 2"), 0);
}

// Mutation: what touches beside what crosses is said to be counted.
TEST_F(AtRest, WhatTouchesBesideWhatCrossesIsLeftOutWithIt) {
  put_frames({0.999999, 0.9, 0.75});
  const json found = answer("f.0.obj");
  EXPECT_EQ(found["rest_crossings"]["pairs"], found["intervals"][0]["left_out"]["start_pairs"]);
  EXPECT_EQ(found["rest_crossings"]["touching"], 0);
  EXPECT_EQ(found["intervals"][0]["start_pairs_total"], 0);
}

}  // namespace
}  // namespace cscd::bench
