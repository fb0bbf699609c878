#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "bench/command_line/command.h"
#include "bench/strategies/catalogue.h"
#include "bench/strategies/verify.h"
#include "bench/testing/rule_case.h"
#include "core/base/test_folder.h"
#include "core/base/test_refusal.h"
#include "core/detect/start/embedding.h"
#include "scenes/clip/point_cache.h"
#include "scenes/random/random_interval.h"

// Rules embedded-start, closed-mesh and fresh-detector: an overlapping start, a surface without an inside,
// state kept from one interval to the next.
namespace cscd::bench {
namespace {

using namespace rules;

nlohmann::json query(const std::filesystem::path& input, const std::filesystem::path& output,
                     const std::string& options) {
  CLI::App app;
  add_query(app);
  app.parse("query " + input.string() + " --json " + output.string() + " --force " + options);
  return nlohmann::json::parse(std::ifstream(output)).at("intervals").at(0);
}

// Mutation: query never falls back (`may_fall_back` false).
TEST(Rules, EmbeddedStartAnOverlappingStartIsAnsweredByACompleteStrategy) {
  Shape shape = test::together(test::octahedron(), test::moved(test::octahedron(), {0.5, 0.4, 0.3}));
  std::vector<Vec3> end = shape.positions;
  for (std::size_t i = 6; i < 12; ++i)
    end[i] = Eigen::AngleAxisd(25 * std::numbers::pi / 180, Vec3(1, 2, 3).normalized()) * end[i];
  const Case scene(shape, end, {{0.2, 0.2, 0.1}, {0.3, 0.2, 0.2}});
  EXPECT_FALSE(scene.embedded());
  const ContactSet truth = scene.ask(all_pairs());
  ASSERT_FALSE(truth.contacts.empty());
  // All is positive from inside both: with one cluster for both, nothing would be reported.
  EXPECT_LT(scene.in_one_cluster<Flaw::clusters_span_components>(ObserverKind::bone_centre).contacts.size(),
            truth.contacts.size());

  const test::Folder folder;
  scenes::PointCacheWriter writer(folder / "overlap.h5",
                                  {shape.triangles, shape.positions.size(), scene.rig.parent, false}, false);
  writer.append({scene.start, scene.rig.reference});
  writer.append({scene.end, scene.bones_end});
  writer.finish();
  for (const Strategy* row : with_guarantee()) {
    const Strategy& strategy = *row;
    const std::string named = "--keep-rest-crossings --strategy " + std::string(strategy.name);
    const nlohmann::json answer = query(folder / "overlap.h5", folder / "out.json", named);
    EXPECT_FALSE(answer.at("starts_embedded").get<bool>());
    EXPECT_TRUE(answer.at("proven").get<bool>());
    EXPECT_EQ(answer.at("contacts").size(), truth.contacts.size());
    if (strategy.guarantee == Guarantee::complete) continue;
    EXPECT_EQ(answer.at("strategy"), std::string(complete_fallback().name));
    const nlohmann::json as_it_is = query(folder / "overlap.h5", folder / "out.json", named + " --unproven");
    EXPECT_FALSE(as_it_is.at("proven").get<bool>());
    EXPECT_EQ(as_it_is.at("strategy"), std::string(strategy.name));
  }
}

// Mutation: require_closed_and_oriented, or the test for bones, left out of require_radial_setup; the former
// left out of make_drvbc_fast.
TEST(Rules, ClosedMeshSurfacesWithoutAnInsideAreRefusedByThoseThatNeedOne) {
  const Shape ball = test::icosphere(1);
  Shape open = ball, flipped = ball, doubled = ball, fin = ball;
  open.triangles.pop_back();
  std::swap(flipped.triangles[3][0], flipped.triangles[3][1]);
  doubled.triangles.push_back(doubled.triangles[5]);
  fin.positions.emplace_back(0, 0, 3);
  const Triangle& base = fin.triangles[0];
  fin.triangles.push_back({base[0], base[1], VertexId{static_cast<std::int32_t>(fin.positions.size()) - 1}});
  for (const Shape* shape : {&open, &flipped, &doubled, &fin}) {
    std::vector<Vec3> end = shape->positions;
    for (Vec3& p : end) p.z() *= 0.5;
    const Case scene(*shape, end, {{-0.1, 0, 0}, {0.1, 0, 0}});
    const ContactSet truth = scene.ask(all_pairs());
    for (const Strategy& strategy : strategies()) {
      if (strategy.guarantee == Guarantee::complete) {
        EXPECT_EQ(digest(scene.ask(strategy)), digest(truth)) << strategy.name;
        continue;
      }
      if (strategy.needs == Needs::any_mesh) continue;
      const std::string text = test::refusal([&] { strategy.make(scene.setup()); });
      EXPECT_NE(text.find(strategy.name), std::string::npos) << text;
    }
  }
}

TEST(Rules, ClosedMeshMissingBonesAreRefusedByThoseThatNeedThem) {
  const Shape ball = test::icosphere(1);
  const TriangleMesh mesh = ball.mesh();
  const Rig none;
  for (const Strategy& strategy : strategies())
    for (const Rig* rig : {static_cast<const Rig*>(nullptr), &none}) {
      const StrategyInput setup{mesh, ball.positions, rig, exact()};
      if (strategy.needs != Needs::closed_mesh_with_bones) {
        EXPECT_NO_THROW(strategy.make(setup));
        continue;
      }
      EXPECT_NE(test::refusal([&] { strategy.make(setup); }).find("bones"), std::string::npos)
          << strategy.name << " took it";
    }
}

std::vector<std::uint64_t> counters(const Report& report) {
  const RadialCounts radial = report.cull.radial.value_or(RadialCounts{});
  return {report.cull.bvot.value_or(0),
          report.cull.pctp,
          report.cull.contour_box_tests.value_or(0),
          radial.positive,
          radial.negative,
          radial.uncertain,
          radial.clusters,
          report.pairs.adjacent_pctp,
          report.pairs.relative_dropped,
          report.pairs.feature_pairs,
          report.pairs.elementary_tests};
}

// Mutations: MegaClusters::regrow does not reset its labels; `fits` accepts once the suspects have passed;
// FeaturePairSet's epoch stays; finish_classes or the refit of the vertices happens once only.
// For those that follow the surface: forget() leaves the clusters as they are.
TEST(Rules, FreshDetectorAnyOrderOfIntervalsGivesTheAnswersOfFreshDetectors) {
  const ElementaryTest &newton = elementary_test_named("newton"),
                       &exact = elementary_test_named("filtered_exact");
  std::size_t kept = 0;
  for (std::uint64_t seed = 1; seed <= 22; ++seed) {
    const scenes::RandomInterval random = scenes::make_random_interval(seed);
    const scenes::FrameView first = random.clip.frame(0), last = random.clip.frame(1);
    const TriangleMesh mesh(random.clip.header().triangles, random.clip.header().vertex_count);
    const Rig rig{random.clip.header().bone_parent, {first.bones.begin(), first.bones.end()}};
    // Poses on the way, and intervals between any two of them.
    std::vector<std::vector<Vec3>> poses;
    std::vector<std::vector<Bone>> bones;
    for (const double t : {0.0, 0.3, 0.6, 1.0}) {
      poses.emplace_back();
      bones.emplace_back();
      for (std::size_t i = 0; i < first.positions.size(); ++i)
        poses.back().push_back((1 - t) * first.positions[i] + t * last.positions[i]);
      for (std::size_t i = 0; i < first.bones.size(); ++i)
        bones.back().push_back({(1 - t) * first.bones[i].head + t * last.bones[i].head,
                                (1 - t) * first.bones[i].tail + t * last.bones[i].tail});
    }
    const StrategyInput exactly{mesh, first.positions, &rig, exact};
    const auto reference = complete_reference().make(exactly).detector;
    EmbeddingTest embedding(mesh, first.positions);
    const auto judged = [&](std::size_t from, std::size_t to) {
      ContactSet truth;
      reference->detect({Motion(poses[from], poses[to])}, truth);
      truth.sort();
      return std::pair{embedding.embedded(poses[from]), truth};
    };
    for (const Strategy& strategy : strategies()) {
      // A promise holds with a test that is right.
      const StrategyInput setup{mesh, first.positions, &rig,
                                strategy.kind == StrategyKind::adaptive ? exact : newton};
      const auto ask = [&](Detector& detector, std::size_t from, std::size_t to) {
        const Rig::Interval pose{bones[from], bones[to]};
        ContactSet found;
        const Report report = detector.detect({Motion(poses[from], poses[to]), &pose}, found);
        found.sort();
        return std::pair{digest(found), counters(report)};
      };
      const auto used = strategy.make(setup).detector;
      std::mt19937 order(static_cast<unsigned>(seed));
      for (int visit = 0; visit < 8; ++visit) {
        const std::size_t from = order() % 4, to = order() % 4;
        // What follows the surface is like a new detector once it has forgotten, and without that keeps its
        // promise.
        if (strategy.kind == StrategyKind::adaptive && visit % 2 == 0) {
          const auto [embedded, truth] = judged(from, to);
          ContactSet found;
          const Rig::Interval pose{bones[from], bones[to]};
          used->detect({Motion(poses[from], poses[to]), &pose}, found);
          found.sort();
          kept += embedded && !truth.contacts.empty();
          EXPECT_TRUE(verify(truth, found, strategy.guarantee, embedded).ok)
              << strategy.name << ", seed " << seed << ", visit " << visit;
          used->forget();
        }
        if (strategy.kind == StrategyKind::adaptive && visit % 2 != 0) used->forget();
        EXPECT_EQ(ask(*used, from, to), ask(*strategy.make(setup).detector, from, to))
            << strategy.name << ", seed " << seed << ", visit " << visit;
      }
    }
  }
  EXPECT_GT(kept, 50u);
}

}  // namespace
}  // namespace cscd::bench
