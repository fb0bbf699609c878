#include "scenes/export/glb.h"

#include <functional>
#include <gtest/gtest.h>

#include "core/base/test_refusal.h"
#include "scenes/character/test_figure.h"
#include "scenes/export/test_glb_rules.h"
#include "scenes/export/test_round_trip.h"

namespace cscd::scenes {
namespace {

// Returns the frames that a reader should see: poses at equally spaced times from the
// clip's start to its end.
Clip frames_of(const Character& character, double fps) {
  ClipHeader header;
  for (const Part& part : character.parts) {
    for (const auto& t : part.triangles) {
      const int shift = static_cast<int>(header.vertex_count);
      header.triangles.push_back(test::corners(t[0] + shift, t[1] + shift, t[2] + shift));
    }
    header.vertex_count += part.positions.size();
  }
  Clip clip(header);
  const Animation& animation = character.animations[0];
  const auto frames = static_cast<std::size_t>(std::lround(animation.seconds * fps)) + 1;
  std::vector<Vec3> positions;
  for (std::size_t i = 0; i < frames; ++i) {
    skin(character, pose_at(character, animation, animation.start + static_cast<double>(i) / fps), positions);
    clip.append({positions, {}});
  }
  return clip;
}

void expect_round_trip(const Character& character, double fps = 30) {
  const std::string glb = to_glb(character);
  const GlbRules rules(glb);
  ImportOptions options;
  options.component = "all";
  options.fps = fps;
  const ReadBack back = read_back(glb, options);
  // Readers list meshes in an order of their own.
  Character ordered = character;
  ordered.parts.clear();
  for (const Part& part : back.character.parts) {
    const auto own = std::ranges::find(character.parts, part.name, &Part::name);
    ASSERT_NE(own, character.parts.end()) << part.name;
    ordered.parts.push_back(*own);
  }
  ASSERT_EQ(ordered.parts.size(), character.parts.size());
  expect_same_frames(frames_of(ordered, fps), back.clip);
  EXPECT_EQ(back.clip.header().bone_parent.size(), moving_nodes(character).size());
  EXPECT_EQ(back.report.clips.size(), character.animations.size());
}

// The tube of bending_tube() on joints along it. The joints are all children of the root, or form a chain.
// Every vertex follows `influences` joints, and nearer joints more strongly.
Character tube_on(int joints, std::size_t influences, bool chain) {
  Character tube = bending_tube();
  tube.nodes.resize(2);
  Part& part = tube.parts[0];
  part.joints.clear();
  part.influences.clear();
  part.first.assign(1, 0);
  tube.animations[0].channels.clear();
  for (int j = 0; j < joints; ++j) {
    const Vec3 where(4.0 * j / joints, 0, 0);
    const Vec3 step = chain && j > 0 ? Vec3(4.0 / joints, 0, 0) : where;
    const int node = j + 2;
    tube.nodes.push_back({"joint " + std::to_string(j), chain && j > 0 ? node - 1 : 0, moved_by(step)});
    part.joints.push_back({node, moved_by(-where)});
    Channel channel{node, {}, {}, {}};
    for (int key = 0; key <= 4; ++key)
      channel.rotations.push_back({key * 0.25, from_euler(Vec3(3, 5 - j, 2 * j) * key, {0, 1, 2})});
    if (j % 3 == 1)
      for (const double time : {0.0, 0.5, 1.0})
        channel.moves.push_back({time, step + time * Vec3(0.1, 0.2, -0.1)});
    tube.animations[0].channels.push_back(channel);
  }
  for (const Vec3& x : part.positions) {
    std::vector<std::pair<double, int>> nearest;
    for (int j = 0; j < joints; ++j) nearest.emplace_back(std::abs(x.x() - 4.0 * j / joints), j);
    std::sort(nearest.begin(), nearest.end());
    nearest.resize(std::min(nearest.size(), influences));
    double sum = 0;
    for (auto& [distance, joint] : nearest) sum += 1 / (1 + distance);
    for (auto& [distance, joint] : nearest) part.influences.push_back({joint, 1 / (1 + distance) / sum});
    part.first.push_back(part.influences.size());
  }
  return tube;
}

TEST(Glb, AChainIsReadBackAsItWas) {
  expect_round_trip(tube_on(6, 2, true));
}

TEST(Glb, VerticesMayFollowMoreThanFourAndMoreThanEightJoints) {
  for (const std::size_t influences : {1u, 4u, 5u, 8u, 9u, 12u}) {
    SCOPED_TRACE(influences);
    const Character tube = tube_on(13, influences, false);
    const nlohmann::json file = GlbRules(to_glb(tube)).file;
    EXPECT_EQ(file["meshes"][0]["primitives"][0]["attributes"].size(), 1 + 2 * ((influences + 3) / 4));
    expect_round_trip(tube);
  }
}

// The figure has a tree of bones and meshes with and without a skin, then also two meshes on one node.
TEST(Glb, AFigureOfSeveralMeshesIsReadBackAsItWas) {
  Character figure = walking_figure();
  expect_round_trip(figure);
  figure.parts[3].node = figure.parts[0].node;
  expect_round_trip(figure);
}

TEST(Glb, BonesMayMoveOrStretchAlone) {
  Character tube = bending_tube();
  const int upper = 4;
  tube.animations[0].channels = {{upper, {{0, {1, 0, 0}}, {0.5, {1, 0.5, 0}}, {1, {1.5, 0, 0}}}, {}, {}}};
  expect_round_trip(tube);
  tube.animations[0].channels = {{upper, {}, {}, {{0, {1, 1, 1}}, {1, {1, 2, 0.5}}}}};
  expect_round_trip(tube);
}

TEST(Glb, ClipsMayHaveAnyRate) {
  for (const double fps : {24.0, 60.0, 10.0}) expect_round_trip(tube_on(6, 2, true), fps);
}

// Both quaternions of a rotation are legal keys. The file must have those that lie near each other.
TEST(Glb, RotationsGoTheShorterWay) {
  Character tube = bending_tube();
  Quaternion& last = tube.animations[0].channels[0].rotations.back().value;
  last = {-last.w, -last.x, -last.y, -last.z};
  expect_round_trip(tube);
}

std::string refusal(const std::function<void(Character&)>& change) {
  Character tube = bending_tube();
  change(tube);
  return test::refusal([&] { to_glb(tube); });
}

TEST(Glb, WhatTheFileCannotSayIsRefused) {
  using C = Character;
  const auto says = [](const std::string& text, const std::string& what) {
    EXPECT_NE(text.find(what), std::string::npos) << text;
  };
  EXPECT_EQ(refusal([](C&) {}), "");
  says(refusal([](C& c) { c.parts.clear(); }), "has no mesh");
  says(refusal([](C& c) { c.parts[0].triangles.clear(); }), "has no triangles");
  says(refusal([](C& c) { c.parts[0].positions[3].x() = 1e100; }), "beyond 1e15");
  says(refusal([](C& c) {
         c.nodes[0].written = ScaleTurnMove{{0, 0, 5}, {}, {1e300, 1, 1}};
       }),
       "beyond 1e15");
  says(refusal([](C& c) { c.animations[0].channels[0].rotations[1].time = 1e300; }),
       "beyond single precision");
  says(refusal([](C& c) { c.animations[0].channels[0].rotations[1].time = 1e-320; }),
       "its time is negative, or");
  says(refusal([](C& c) { c.animations[0].channels[0].rotations[0].time = -1; }), "its time is negative, or");
  says(refusal([](C& c) { c.animations[0].channels[0].rotations[0].next = Between::cubic; }),
       "not joined by straight lines");
  says(refusal([](C& c) {
         c.animations[0].channels[0].angles.degrees.base.axis[0].keys = {{0, 1}};
       }),
       "keys for single components");
  says(refusal([](C& c) { c.animations[0].channels.clear(); }), "moves nothing");
  says(refusal([](C& c) {
         c.parts[0].targets.push_back({"t", std::vector<Vec3>(c.parts[0].positions.size())});
       }),
       "morph targets");
  says(refusal([](C& c) { c.nodes[3].local.column[1] = {0.5, 1, 0}; }), "is sheared");
  says(refusal([](C& c) { c.parts[0].joints.push_back(c.parts[0].joints[0]); }), "are one node");
  says(refusal([](C& c) {
         Part& part = c.parts[0];
         const std::size_t own = part.first.back() - part.first[part.first.size() - 2];
         part.influences.resize(part.influences.size() - own);
         part.first.back() = part.influences.size();
       }),
       "follows no joint");
}

}  // namespace
}  // namespace cscd::scenes
