#include "scenes/import/convert.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/test_folder.h"
#include "core/base/test_refusal.h"
#include "scenes/base/test_says.h"
#include "scenes/character/pose.h"
#include "scenes/character/test_characters.h"
#include "scenes/clip/point_cache.h"
#include "scenes/import/surface.h"

namespace cscd::scenes {
namespace {

class Convert : public testing::Test {
 protected:
  Clip converted(const Character& character, const ImportOptions& options = {},
                 const CharacterLimits& limits = {}) {
    validate(character, limits);
    const std::filesystem::path file = root / (std::to_string(serial_++) + ".h5");
    const std::filesystem::path sources = file.string() + ".sources";
    report = convert(character, options, limits, file, sources);
    const Clip clip = read_clip(file);
    map = read_source_map(sources, {clip.header().triangles.size(), clip.header().vertex_count,
                                    report.parts.size(), report.bones.size()});
    return read_clip(file);
  }
  std::string refusal(const Character& character, const ImportOptions& options = {},
                      const CharacterLimits& limits = {}) {
    return test::refusal([&] { converted(character, options, limits); });
  }

  const test::Folder root;
  ImportReport report;
  SourceMap map;

 private:
  int serial_ = 0;
};

TriangleMesh mesh_of(const Clip& clip) {
  return TriangleMesh(clip.header().triangles, clip.header().vertex_count);
}

// A tube as exporters write it with hard edges and two materials: every triangle has three vertices of its
// own, and the two halves of the list of triangles are two parts on one skeleton.
Character torn_tube() {
  Character tube = bending_tube();
  const Part whole = tube.parts[0];
  tube.parts.clear();
  for (const bool second : {false, true}) {
    Part part = whole;
    part.positions.clear();
    part.triangles.clear();
    part.first.clear();
    part.influences.clear();
    for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
      if ((t % 2 == 1) != second) continue;
      std::array<std::int32_t, 3> corner;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v = static_cast<std::size_t>(whole.triangles[t][k]);
        corner[k] = static_cast<std::int32_t>(part.positions.size());
        part.positions.push_back(whole.positions[v]);
        part.first.push_back(part.influences.size());
        for (std::size_t i = whole.first[v]; i < whole.first[v + 1]; ++i)
          part.influences.push_back(whole.influences[i]);
      }
      part.triangles.push_back(corner);
    }
    part.first.push_back(part.influences.size());
    tube.parts.push_back(std::move(part));
  }
  return tube;
}

TEST_F(Convert, WritesFramesAtTheRateWithBones) {
  ImportOptions options;
  options.fps = 10;
  const Clip clip = converted(bending_tube(), options);
  EXPECT_EQ(clip.frame_count(), 11u);
  EXPECT_EQ(clip.header().bone_parent, (std::vector<BoneId>{BoneId{-1}, BoneId{0}}));
  EXPECT_TRUE(mesh_of(clip).closed_and_oriented());
  EXPECT_EQ(report.chosen_clip, 0);
  EXPECT_EQ(report.clips[0].driven, 1u);
  EXPECT_EQ(report.joints, 2u);
  EXPECT_EQ(report.most_influences, 2u);
  EXPECT_EQ(report.welded_vertices, 0u);
}

// Mutation: the rate of 30 where the file says another.
TEST_F(Convert, TakesTheFilesOwnRateAndTimeLine) {
  Character tube = bending_tube();
  tube.animations[0].ticks_per_second = 24;
  tube.animations[0].start = 37.5;
  for (Key<Quaternion>& key : tube.animations[0].channels[0].rotations) key.time += 37.5;
  EXPECT_EQ(converted(tube).frame_count(), 25u);
  EXPECT_EQ(report.fps, 24);
  EXPECT_EQ(report.fps_from, kStated);
  EXPECT_EQ(report.clips[0].frames, 25u);
  EXPECT_EQ(report.clips[0].first_frame, 900);
  tube.animations[0].start += 1e-5;  // single precision
  converted(tube);
  EXPECT_EQ(report.clips[0].first_frame, 900);
}

TEST_F(Convert, ClipsBlendMorphTargets) {
  Character tube = bending_tube();
  Part& part = tube.parts[0];
  part.targets = {{"up", std::vector<Vec3>(part.positions.size(), Vec3(0, 0, 2)), 0.5}};
  tube.animations[0].channels.clear();
  tube.animations[0].morphs = {{0, {driven({{0, 0.0}, {1, 1.0}})}}};
  ImportOptions options;
  options.fps = 10;
  const Clip clip = converted(tube, options);
  ASSERT_EQ(clip.frame_count(), 11u);
  for (std::size_t v = 0; v < clip.header().vertex_count; ++v)
    EXPECT_NEAR(clip.frame(7).positions[v].z() - clip.frame(0).positions[v].z(), 0.7 * 2, 1e-9);
}

TEST_F(Convert, ABoneIsDrivenByTheNodesBetweenItAndTheBoneAbove) {
  Character tube = bending_tube();
  tube.animations[0].channels[0].node = 3;  // a node between the two bones
  converted(tube);
  EXPECT_EQ(report.clips[0].driven, 1u);
  tube.animations[0].channels[0].node = 1;  // the node of the mesh, which follows the bones
  ImportOptions named;
  named.clip = "bend";  // the clip moves nothing
  converted(tube, named);
  EXPECT_EQ(report.clips[0].driven, 0u);
}

TEST_F(Convert, WeldsAcrossTrianglesPartsAndMaterials) {
  const Clip whole = converted(bending_tube()), torn = converted(torn_tube());
  EXPECT_EQ(torn.header().vertex_count, whole.header().vertex_count);
  EXPECT_TRUE(mesh_of(torn).closed_and_oriented());
  EXPECT_EQ(report.weld_tolerance, kDefaultWeld);
  EXPECT_LT(report.weld_spread, 1e-15);
}

TEST_F(Convert, DoesNotWeldWhatMovesApart) {
  // A second tube whose end touches the end of the first: their points are equal at
  // rest and move apart later.
  Character two = bending_tube();
  Part other = two.parts[0];
  for (Vec3& x : other.positions) x.x() += 4;
  other.influences.clear();
  for (std::size_t v = 0; v < other.positions.size(); ++v) {
    other.first[v] = v;
    other.influences.push_back({0, 1});
  }
  other.first.back() = other.positions.size();
  two.parts.push_back(other);
  ImportOptions all;
  all.component = "all";
  EXPECT_EQ(mesh_of(converted(two, all)).component_count(), 2);
  EXPECT_EQ(report.welded_vertices, 0u);
}

// A sheet whose two sides lie 1e-7 of the diagonal apart, so that the default tolerance would weld them.
TEST_F(Convert, LowersTheToleranceWhereDetailWouldCollapse) {
  Character thin = bending_tube();
  for (Vec3& x : thin.parts[0].positions) x.z() *= 4e-7;
  const Clip clip = converted(thin);
  EXPECT_EQ(clip.header().vertex_count, thin.parts[0].positions.size());
  EXPECT_LT(report.weld_tolerance, kDefaultWeld);
  EXPECT_FALSE(report.notes.empty());
  ImportOptions forced;
  forced.weld = 1e-6;
  EXPECT_TRUE(says(refusal(thin, forced), "more than two triangles"));
}

TEST_F(Convert, BeginsInTheBindPose) {
  Character tube = bending_tube();
  // The clip starts bent.
  tube.animations[0].channels[0].rotations.erase(tube.animations[0].channels[0].rotations.begin());
  tube.animations[0].channels[0].moves = {{0, Vec3(1, 0, 0)}, {1, Vec3(1, 0, 0)}};
  ImportOptions options;
  options.clip = "bend";
  options.fps = 20;
  EXPECT_EQ(converted(tube, options).frame_count(), 21u);
  options.from_bind_pose = true;
  const Clip clip = converted(tube, options);
  EXPECT_EQ(clip.frame_count(), 31u);
  EXPECT_EQ(report.lead_in, 10u);
  for (std::size_t v = 0; v < clip.header().vertex_count; ++v) {
    const Vec3 bound = tube.parts[0].positions[v] + Vec3(0, 0, 5);
    EXPECT_LT((clip.frame(0).positions[v] - bound).norm(), 1e-12);
    if (bound.x() < 2.6) continue;
    // After half of the lead-in, half of the quarter turn about (2, 0) is done.
    const double half = std::sqrt(0.5), along = bound.x() - 2, across = bound.y();
    const Vec3 turned(2 + half * (along - across), half * (along + across), bound.z());
    EXPECT_LT((clip.frame(5).positions[v] - turned).norm(), 1e-9);
  }
}

TEST_F(Convert, ChoosesClipsByNameNumberOrLength) {
  Character tube = bending_tube();
  const Animation bend = tube.animations[0];
  tube.animations = {{"pose", 0, 0, 0, bend.channels}, bend, {"", 3, 2, 0, bend.channels}};
  converted(tube);
  EXPECT_EQ(report.chosen_clip, 1);
  ImportOptions options;
  options.clip = "2";
  EXPECT_EQ(converted(tube, options).frame_count(), 61u);
  options.clip = "bend";
  converted(tube, options);
  EXPECT_EQ(report.chosen_clip, 1);
  options.clip = "pose";
  EXPECT_TRUE(says(refusal(tube, options), "--from-bind-pose"));
  options.from_bind_pose = true;
  EXPECT_EQ(converted(tube, options).frame_count(), 16u);
  options.clip = "run";
  EXPECT_TRUE(says(refusal(tube, options), "0 'pose', 1 'bend', 2 ''"));
  tube.animations.clear();
  EXPECT_TRUE(says(refusal(tube), "no clip"));
}

TEST_F(Convert, EndsWhereTheClipEnds) {
  Character tube = bending_tube();
  Animation& bend = tube.animations[0];
  bend.seconds = 10.0 / 24;
  bend.channels[0].rotations[1].time = bend.seconds;
  const Clip clip = converted(tube);
  // 12 whole frames of 1/30 second, and half a frame more.
  ASSERT_EQ(clip.frame_count(), 14u);
  EXPECT_EQ(report.clips[0].frames, 14u);
  std::vector<Vec3> end;
  skin(tube, pose_at(tube, bend, bend.seconds), end);
  EXPECT_TRUE(std::equal(end.begin(), end.end(), clip.frame(13).positions.begin()));
  // Rounding to float must not add a frame to a length that is a whole number of frames.
  bend.seconds = static_cast<double>(static_cast<float>(0.7));
  EXPECT_EQ(converted(tube).frame_count(), 22u);
  bend.seconds = 0.7;
  EXPECT_EQ(converted(tube).frame_count(), 22u);
}

TEST_F(Convert, TakesTheFirstClipThatMovesTheSurface) {
  Character tube = bending_tube();
  const Animation bend = tube.animations[0];
  Animation camera = bend, still = bend;
  tube.nodes.push_back({"camera", 0, Transform()});
  camera.channels[0].node = 5;
  still.channels[0].rotations[1].value = still.channels[0].rotations[0].value;
  tube.animations = {camera, still, bend};
  converted(tube);
  EXPECT_EQ(report.chosen_clip, 2);
  tube.animations = {camera, still};
  EXPECT_TRUE(says(refusal(tube), "none of its clips moves the surface"));
  ImportOptions options;
  options.clip = "1";
  EXPECT_EQ(converted(tube, options).frame_count(), 31u) << "whoever names it gets it";

  // A clip that moves the surface by morph targets alone is found too.
  Animation smile{"smile", 0, 1, 0, {}};
  smile.morphs = {{0, {driven({{0, 0.0}, {1, 1.0}})}}};
  tube.parts[0].targets = {{"wide", std::vector<Vec3>(tube.parts[0].positions.size(), Vec3(0, 0.5, 0)), 0}};
  tube.animations = {camera, smile};
  const Clip clip = converted(tube);
  EXPECT_EQ(report.chosen_clip, 1);
  EXPECT_LT((clip.frame(30).positions[9] - clip.frame(0).positions[9] - Vec3(0, 0.5, 0)).norm(), 1e-12);
}

// A tube whose end moves aside and comes back between two frames, at keys of several kinds. Mutation: the
// clip is looked at in frames and at fixed shares of them alone, or the keys of one kind are passed over.
TEST_F(Convert, TakesAClipThatMovesForTheShortestTimeBetweenFrames) {
  const auto moves = [&](const auto& set, double begin, double end) {
    Character tube = bending_tube();
    tube.animations[0].start = 2;
    tube.animations[0].seconds = 3;
    Channel& channel = tube.animations[0].channels[0];
    channel.rotations.clear();
    set(tube.animations[0], 2 + begin, 2 + end);
    converted(tube);
    return report.chosen_clip == 0 && std::ranges::any_of(report.notes, [](const std::string& note) {
             return says(note, "moves between its frames alone");
           });
  };
  const Vec3 here(0, 0, 0), aside(0, 1, 0);
  for (const auto& [begin, end] : {std::pair(0.501, 0.503), {0.5151, 0.5152}, {1.70001, 1.70002}}) {
    const auto shown = [&, from = begin, to = end](const auto& set) { return moves(set, from, to); };
    EXPECT_TRUE(shown([&](Animation& clip, double from, double to) {
      clip.channels[0].moves = {{2, here}, {from, here}, {(from + to) / 2, aside}, {to, here}, {5, here}};
    }));
    EXPECT_TRUE(shown([&](Animation& clip, double from, double to) {
      clip.channels[0].moves = {
          {2, here, Between::constant}, {from, aside, Between::constant}, {to, here, Between::constant}};
    }));
    // Both keys have one value, and the tangents lead away from it and back.
    EXPECT_TRUE(shown([&](Animation& clip, double from, double to) {
      clip.channels[0].moves = {{from, here, Between::cubic, here, 1e6 * aside},
                                {to, here, Between::line, -1e6 * aside, here}};
    }));
    // Two whole turns, whose ends and middle are one pose.
    EXPECT_TRUE(shown([&](Animation& clip, double from, double to) {
      clip.channels[0].angles.degrees.base.axis[2].keys = {{from, 0}, {to, 720}};
    }));
  }
  // The keys lie before the clip, which shows a repetition of them.
  for (const Beyond kind : {Beyond::repeat, Beyond::mirror})
    EXPECT_TRUE(moves(
        [&](Animation& clip, double, double) {
          Curve& curve = clip.channels[0].angles.degrees.base.axis[2];
          curve.keys = {{-2, 0}, {0.501, 0}, {0.5015, 90}, {0.502, 0}, {2, 0}};
          curve.beyond = {.before = Beyond::hold, .after = kind, .first = -2, .last = 2};
        },
        0, 0));
  EXPECT_TRUE(says(test::refusal([&] {
                     moves(
                         [&](Animation& clip, double, double) {
                           clip.channels[0].moves = {{2, here}, {5, here}};
                         },
                         0, 0);
                   }),
                   "none of its clips moves the surface"));
}

// A time of single precision may lie behind the frame that it is meant for. Mutation: the frame shows the key
// before.
TEST_F(Convert, ShowsAJumpInTheFrameThatItIsMeantFor) {
  for (const double fps : {24.0, 25.0, 30.0, 60.0}) {
    const auto second = [&](int frame) { return double(static_cast<float>(frame / fps)); };
    Character tube = bending_tube();
    tube.frames_per_second = fps;
    tube.animations[0].start = second(6);
    tube.animations[0].seconds = second(35) - second(6);
    Channel& channel = tube.animations[0].channels[0];
    channel.rotations.clear();
    channel.moves.clear();
    for (int k = 6; k <= 35; ++k) channel.moves.push_back({second(k), Vec3(0, k, 0), Between::constant});
    const Clip clip = converted(tube);
    ASSERT_EQ(clip.frame_count(), 30u);
    const auto moved = [&](std::size_t frame) {
      double most = 0;
      for (std::size_t v = 0; v < clip.header().vertex_count; ++v)
        most = std::max(most, (clip.frame(frame).positions[v] - clip.frame(0).positions[v]).norm());
      return most;
    };
    for (std::size_t i = 1; i < 30; ++i)
      EXPECT_NEAR(moved(i), static_cast<double>(i) * moved(29) / 29, 1e-9) << fps << " " << i;
    EXPECT_GT(moved(29), 1);
  }
}

// What an exporter makes of a clip that it cuts out of a long time line: each time is a difference of single
// precision. Mutations: only keys of jumps are put on frames; one of a pulse's keys is.
TEST_F(Convert, ShowsAPulseOfOneFrame) {
  for (const Between kind : {Between::constant, Between::line})
    for (const double fps : {24.0, 25.0, 30.0, 60.0})
      for (int at = 1; at < 40; ++at) {
        const auto second = [&](int frame) {
          const auto time = [&](int f) { return static_cast<float>(f / fps); };
          return double(time(1000 + frame) - time(1000));
        };
        Character tube = bending_tube();
        tube.frames_per_second = fps;
        tube.animations[0].start = 0;
        tube.animations[0].seconds = second(41);
        Channel& channel = tube.animations[0].channels[0];
        channel.rotations.clear();
        channel.moves.clear();
        for (const int k : {0, at, at + 1, 41})
          channel.moves.push_back({second(k), Vec3(0, k == at, 0), kind});
        const Clip clip = converted(tube);
        ASSERT_EQ(clip.frame_count(), 42u);
        const auto moved = [&](int frame) {
          const auto place = [&](int f) { return clip.frame(static_cast<std::size_t>(f)).positions; };
          double most = 0;
          for (std::size_t v = 0; v < clip.header().vertex_count; ++v)
            most = std::max(most, (place(frame)[v] - place(0)[v]).norm());
          return most;
        };
        EXPECT_GT(moved(at), 0.999) << fps << " " << at;
        EXPECT_NEAR(moved(at + 1), 0, 1e-9) << fps << " " << at;
      }
}

TEST_F(Convert, RefusesClipsOfTooManyFramesToCount) {
  Character endless = bending_tube();
  endless.animations[0].seconds = 1e30;
  EXPECT_TRUE(says(refusal(endless), "lower --fps"));
}

TEST_F(Convert, ComparesNamesOfClipsWithoutCaseWhereThatIsUnique) {
  Character tube = bending_tube();
  const Animation bend = tube.animations[0];
  tube.animations = {bend, bend, bend, bend};
  tube.animations[1].name = "Walk";
  tube.animations[2].name = "walk";
  tube.animations[3].name = "RUN";
  ImportOptions options;
  const auto chosen = [&](const std::string& name) {
    options.clip = name;
    converted(tube, options);
    return report.chosen_clip;
  };
  EXPECT_EQ(chosen("walk"), 2);
  EXPECT_EQ(chosen("run"), 3);
  options.clip = "WALK";
  EXPECT_TRUE(says(refusal(tube, options), "2 clips have this name"));
  tube.animations[2].name = "Walk";
  options.clip = "Walk";
  EXPECT_TRUE(says(refusal(tube, options), "choose by number: 0 'bend', 1 'Walk', 2 'Walk'"));
}

// Answers that speak of the file need the pose at rest, and where triangles and vertices come from.
TEST_F(Convert, TellsWhereTheSurfaceComesFrom) {
  Character tube = torn_tube();
  tube.parts[1].mesh = 3;
  tube.parts[1].primitive = 2;
  tube.animations[0].channels[0].rotations[0].value = tube.animations[0].channels[0].rotations[1].value;
  ImportOptions options;
  options.clip = "bend";
  const Clip clip = converted(tube, options);
  std::vector<Vec3> bound;
  skin(tube, bind_pose(tube), bound);
  ASSERT_EQ(clip.header().rest.size(), clip.header().vertex_count);
  ASSERT_EQ(report.parts.size(), 2u);
  EXPECT_EQ(report.parts[1].mesh, 3);
  EXPECT_EQ(report.parts[1].primitive, 2);
  EXPECT_EQ(report.bones, (std::vector<std::string>{"lower", "upper"}));
  for (std::size_t t = 0; t < clip.header().triangles.size(); ++t) {
    const SourceMap::Corners& from = map.triangle[t];
    ASSERT_GE(from.part, 0);
    const std::size_t offset = from.part == 0 ? 0 : tube.parts[0].positions.size();
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId v = clip.header().triangles[t][k];
      EXPECT_LT((clip.header().rest[+v] - bound[offset + static_cast<std::size_t>(from.vertex[k])]).norm(),
                1e-9);
    }
  }
  for (std::size_t v = 0; v < clip.header().vertex_count; ++v) {
    const double x = clip.header().rest[v].x();
    if (std::abs(x - 2) < 0.01) continue;
    EXPECT_EQ(map.bone[v], x < 2 ? 0 : 1) << x;
  }
}

TEST_F(Convert, RefusesASourceMapThatDoesNotFit) {
  converted(bending_tube());
  const std::filesystem::path file = root / "0.h5.sources";
  const SourceMapSizes right{map.triangle.size(), map.bone.size(), 1, 2};
  EXPECT_EQ(read_source_map(file, right), map);
  for (const SourceMapSizes& wrong : {SourceMapSizes{right.triangles + 1, right.vertices, 1, 2},
                                      {right.triangles, right.vertices, 0, 2},
                                      {right.triangles, right.vertices, 1, 1}})
    EXPECT_THROW(read_source_map(file, wrong), InputError);
  EXPECT_THROW(read_source_map(root / "none", right), InputError);
}

TEST_F(Convert, MovesToTheRestWhereThereIsNoClip) {
  Character tube = bending_tube();
  tube.animations.clear();
  tube.nodes[4].local = quarter_turn({1, 0, 0});
  ImportOptions options;
  options.from_bind_pose = true;
  const Clip clip = converted(tube, options);
  EXPECT_EQ(clip.frame_count(), 16u);
  EXPECT_EQ(report.chosen_clip, -1);
  std::vector<Vec3> at_rest;
  skin(tube, rest_pose(tube), at_rest);
  for (std::size_t v = 0; v < at_rest.size(); ++v) {
    EXPECT_LT((clip.frame(0).positions[v] - tube.parts[0].positions[v] - Vec3(0, 0, 5)).norm(), 1e-12);
    EXPECT_LT((clip.frame(15).positions[v] - at_rest[v]).norm(), 1e-12);
  }
}

TEST_F(Convert, FillsHolesAndFlipsComponents) {
  Character tube = bending_tube();
  Part& part = tube.parts[0];
  // Remove the fan of triangles at one end, and turn the rest inside out.
  const std::int32_t tip = static_cast<std::int32_t>(part.positions.size()) - 1;
  std::erase_if(part.triangles, [&](const auto& t) { return t[0] == tip || t[1] == tip || t[2] == tip; });
  for (auto& t : part.triangles) std::swap(t[1], t[2]);
  EXPECT_FALSE(mesh_of(converted(tube)).closed_and_oriented());
  ImportOptions options;
  options.fill_holes = 7;
  EXPECT_FALSE(mesh_of(converted(tube, options)).closed_and_oriented());
  EXPECT_EQ(report.filled_holes, 0u);
  options.fill_holes = 8;
  options.flip_inward = true;
  const Clip clip = converted(tube, options);
  EXPECT_TRUE(mesh_of(clip).closed_and_oriented());
  EXPECT_EQ(report.filled_holes, 1u);
  EXPECT_EQ(report.filled_triangles, 6u);
  EXPECT_EQ(report.flipped_components, 1u);
  const test::Shape shape{{clip.frame(0).positions.begin(), clip.frame(0).positions.end()},
                          clip.header().triangles};
  EXPECT_GT(test::six_volumes(shape), 0);
}

TEST_F(Convert, DropsZeroAreaAndDuplicateFacesAndSaysSo) {
  Character tube = bending_tube();
  Part& part = tube.parts[0];
  const std::size_t triangles = part.triangles.size();
  part.triangles.push_back(part.triangles[3]);
  part.triangles.push_back({5, 5, 6});
  const Clip clip = converted(tube);
  EXPECT_EQ(clip.header().triangles.size(), triangles);
  EXPECT_EQ(report.duplicate_triangles, 1u);
  EXPECT_EQ(report.collapsed_triangles, 1u);
  EXPECT_TRUE(mesh_of(clip).closed_and_oriented());
}

TEST_F(Convert, SurveysAllComponentsAndTheStartsOfClips) {
  Character tube = bending_tube();
  tube.animations.push_back(tube.animations[0]);
  tube.animations[1].start = 1;
  ImportOptions survey;
  survey.survey = true;
  const Clip clip = converted(tube, survey);
  EXPECT_EQ(clip.frame_count(), 3u);
  EXPECT_EQ(report.component_bones, std::vector<std::size_t>{2});
  EXPECT_TRUE(std::equal(clip.frame(0).positions.begin(), clip.frame(0).positions.end(),
                         clip.frame(1).positions.begin()));
  EXPECT_FALSE(std::equal(clip.frame(0).positions.begin(), clip.frame(0).positions.end(),
                          clip.frame(2).positions.begin()));
  tube.animations.clear();
  EXPECT_EQ(converted(tube, survey).frame_count(), 2u);
}

TEST_F(Convert, RefusesSkeletonsWithoutSurfaceAndTooManyFrames) {
  Character bones = bending_tube();
  bones.parts.clear();
  EXPECT_TRUE(says(refusal(bones), "5 nodes and 1 clips, but no triangles"));
  CharacterLimits few;
  few.frames = 20;
  EXPECT_TRUE(says(refusal(bending_tube(), {}, few), "lower --fps"));
  few = {};
  few.cache_bytes = 1000;
  EXPECT_TRUE(says(refusal(bending_tube(), {}, few), "lower --fps"));
  Character point = bending_tube();
  for (Vec3& x : point.parts[0].positions) x = Vec3(1, 2, 3);
  EXPECT_TRUE(says(refusal(point), "one point"));
}

// Vertices of no face are points of a sequence, and left out of a model, with a word in both.
TEST_F(Convert, SaysWhatVerticesOfNoFaceAre) {
  EXPECT_EQ(note_on_loose_vertices(1), "1 vertex is of no face and is left out: no answer is about it");
  EXPECT_EQ(note_on_loose_vertices(3), "3 vertices are of no face and are left out: no answer is about them");

  for (const char* height : {"1", "-1"}) {
    std::ofstream obj(root / (std::string("f.") + (*height == '-' ? "1" : "0") + ".obj"));
    obj << "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 " << height << "\nf 1 2 3\n";
  }
  report = import_sequence(root / "f.0.obj", {}, {}, root / "clip.h5", root / "sources");
  ASSERT_EQ(report.notes.size(), 2u);
  EXPECT_EQ(report.notes[1], note_on_points(1));
  EXPECT_EQ(read_clip(root / "clip.h5").header().vertex_count, 4u);
}

}  // namespace
}  // namespace cscd::scenes
