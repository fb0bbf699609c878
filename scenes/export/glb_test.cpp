#include "scenes/export/glb.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "core/base/test_refusal.h"
#include "scenes/character/test_figure.h"
#include "scenes/clip/up_axis.h"
#include "scenes/export/test_round_trip.h"

namespace cscd::scenes {
namespace {

// Checks the rules of the glTF 2.0 specification that a reader may rely on, on the bytes of a .glb file.
class GlbRules {
 public:
  explicit GlbRules(const std::string& bytes) : bytes_(bytes) { check(); }

  nlohmann::json file;

 private:
  void check() {
    const std::string& bytes = bytes_;
    ASSERT_GE(bytes.size(), 28u);
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(word(4), 2u);
    EXPECT_EQ(word(8), bytes.size());
    const std::size_t text = word(12);
    EXPECT_EQ(text % 4, 0u);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    file = nlohmann::json::parse(bytes.substr(20, text));
    binary_ = 28 + text;
    EXPECT_EQ(word(20 + text) % 4, 0u);
    EXPECT_EQ(bytes.substr(24 + text, 4), std::string("BIN\0", 4));
    ASSERT_EQ(binary_ + word(20 + text), bytes.size());
    EXPECT_EQ(file["buffers"][0]["byteLength"], word(20 + text));
    for (const auto& view : file["bufferViews"]) {
      EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
      ASSERT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(),
                word(20 + text));
    }
    for (const auto& mesh : file["meshes"]) check_mesh(mesh["primitives"][0]);
    if (file.contains("skins"))
      for (const auto& skin : file["skins"]) check_skin(skin);
    if (file.contains("animations"))
      for (const auto& clip : file["animations"]) check_clip(clip);
  }

  std::uint32_t word(std::size_t at) const {
    std::uint32_t number = 0;
    std::memcpy(&number, bytes_.data() + at, sizeof number);
    return number;
  }

  // Returns the numbers of an accessor as doubles.
  std::vector<double> numbers(const nlohmann::json& index, int component, const char* type,
                              std::size_t width) {
    const auto& accessor = file["accessors"][index.get<std::size_t>()];
    EXPECT_EQ(accessor["componentType"], component);
    EXPECT_EQ(accessor["type"], type);
    const auto& view = file["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::size_t count = accessor["count"].get<std::size_t>() * width, size = component == 5123 ? 2 : 4;
    EXPECT_GT(count, 0u);
    EXPECT_EQ(view["byteLength"], count * size);
    std::vector<double> out;
    for (std::size_t i = 0; i < count; ++i) {
      const char* at = bytes_.data() + binary_ + view["byteOffset"].get<std::size_t>() + i * size;
      float real = 0;
      std::uint16_t small = 0;
      std::uint32_t large = 0;
      if (component == 5126) std::memcpy(&real, at, size), out.push_back(static_cast<double>(real));
      if (component == 5123) std::memcpy(&small, at, size), out.push_back(small);
      if (component == 5125) std::memcpy(&large, at, size), out.push_back(large);
    }
    return out;
  }

  void expect_bounds(const nlohmann::json& index, const std::vector<double>& values, std::size_t width) {
    const auto& accessor = file["accessors"][index.get<std::size_t>()];
    ASSERT_EQ(accessor["min"].size(), width);
    for (std::size_t k = 0; k < width; ++k) {
      double low = values[k], high = values[k];
      for (std::size_t i = k; i < values.size(); i += width)
        low = std::min(low, values[i]), high = std::max(high, values[i]);
      EXPECT_EQ(accessor["min"][k].get<double>(), low);
      EXPECT_EQ(accessor["max"][k].get<double>(), high);
    }
  }

  int target(const nlohmann::json& index) {
    const auto& accessor = file["accessors"][index.get<std::size_t>()];
    return file["bufferViews"][accessor["bufferView"].get<std::size_t>()].value("target", 0);
  }

  void check_mesh(const nlohmann::json& primitive) {
    const auto& attributes = primitive["attributes"];
    const std::vector<double> positions = numbers(attributes["POSITION"], 5126, "VEC3", 3);
    expect_bounds(attributes["POSITION"], positions, 3);
    for (const auto& [name, accessor] : attributes.items()) EXPECT_EQ(target(accessor), 34962) << name;
    EXPECT_EQ(target(primitive["indices"]), 34963);
    const std::vector<double> corners = numbers(primitive["indices"], 5125, "SCALAR", 1);
    EXPECT_EQ(corners.size() % 3, 0u);
    for (const double corner : corners) ASSERT_LT(corner, static_cast<double>(positions.size()) / 3);
    std::vector<double> sum(positions.size() / 3, 0);
    std::size_t sets = 0;
    for (; attributes.contains("JOINTS_" + std::to_string(sets)); ++sets) {
      const std::vector<double> weights =
          numbers(attributes.at("WEIGHTS_" + std::to_string(sets)), 5126, "VEC4", 4);
      const std::vector<double> joints =
          numbers(attributes.at("JOINTS_" + std::to_string(sets)), 5123, "VEC4", 4);
      ASSERT_EQ(weights.size(), 4 * sum.size());
      ASSERT_EQ(joints.size(), weights.size());
      for (std::size_t i = 0; i < weights.size(); ++i) {
        sum[i / 4] += weights[i];
        EXPECT_GE(weights[i], 0);
        if (weights[i] == 0) {
          EXPECT_EQ(joints[i], 0);
        }
        EXPECT_LT(joints[i], static_cast<double>(file["skins"][0]["joints"].size()));
      }
    }
    for (const double s : sum) {
      ASSERT_NEAR(s, sets > 0 ? 1 : 0, 2e-7 * 4 * static_cast<double>(sets) + 1e-300);
    }
  }

  void check_skin(const nlohmann::json& skin) {
    const std::vector<double> offsets = numbers(skin["inverseBindMatrices"], 5126, "MAT4", 16);
    EXPECT_EQ(offsets.size(), 16 * skin["joints"].size());
    for (std::size_t i = 0; i < offsets.size(); i += 16)
      EXPECT_EQ(std::vector<double>({offsets[i + 3], offsets[i + 7], offsets[i + 11], offsets[i + 15]}),
                (std::vector<double>{0, 0, 0, 1}));
    std::set<int> in_scene;
    std::vector<int> open = file["scenes"][0]["nodes"].get<std::vector<int>>();
    while (!open.empty()) {
      const int node = open.back();
      open.pop_back();
      EXPECT_TRUE(in_scene.insert(node).second) << "two parents";
      for (const int child :
           file["nodes"][static_cast<std::size_t>(node)].value("children", std::vector<int>{}))
        open.push_back(child);
    }
    EXPECT_EQ(in_scene.size(), file["nodes"].size());
    for (const int joint : skin["joints"]) EXPECT_TRUE(in_scene.contains(joint));
  }

  void check_clip(const nlohmann::json& clip) {
    for (const auto& channel : clip["channels"]) {
      const auto& sampler = clip["samplers"][channel["sampler"].get<std::size_t>()];
      const std::vector<double> times = numbers(sampler["input"], 5126, "SCALAR", 1);
      expect_bounds(sampler["input"], times, 1);
      for (std::size_t i = 1; i < times.size(); ++i) EXPECT_GT(times[i], times[i - 1]);
      if (channel["target"]["path"] != "rotation") {
        EXPECT_EQ(numbers(sampler["output"], 5126, "VEC3", 3).size(), 3 * times.size());
        continue;
      }
      const std::vector<double> turns = numbers(sampler["output"], 5126, "VEC4", 4);
      ASSERT_EQ(turns.size(), 4 * times.size());
      const auto dot = [&](std::size_t a, std::size_t b) {
        double product = 0;
        for (std::size_t k = 0; k < 4; ++k) product += turns[4 * a + k] * turns[4 * b + k];
        return product;
      };
      for (std::size_t i = 0; i < times.size(); ++i) {
        EXPECT_NEAR(dot(i, i), 1, 1e-6);
        EXPECT_GE(dot(i, i > 0 ? i - 1 : 0), 0) << "the shorter way";
      }
    }
  }

  const std::string& bytes_;
  std::size_t binary_ = 0;
};

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

// Mutations: the node of baked frames is not turned, or the other way, or not scaled.
TEST(BakedGlb, TurnsItsUpAxisToYAndScalesToMetres) {
  for (const std::string_view up : kUpAxes) {
    const Vec3 tip = (up[0] == '-' ? -1.0 : 1.0) *
                     Vec3(up.back() == 'x' ? 1 : 0, up.back() == 'y' ? 1 : 0, up.back() == 'z' ? 1 : 0);
    Clip clip({{{VertexId{0}, VertexId{1}, VertexId{2}}}, 3, {}, false});
    for (const double height : {2.0, 3.0})
      clip.append({std::vector<Vec3>{height * tip, {1, 1, 1}, {-1, 1, -1}}, {}});
    const ReadBack read = read_back(baked_glb(clip, "tip", 30, 6, std::string(up), 0.01));
    EXPECT_NEAR(read.report.clips[0].start, 0.2, 1e-6);
    for (const std::size_t frame : {0, 1})
      EXPECT_LT(
          (read.clip.frame(frame).positions[0] - Vec3(0, 0.02 + 0.01 * static_cast<double>(frame), 0)).norm(),
          1e-8)
          << up;
  }
}

}  // namespace
}  // namespace cscd::scenes
