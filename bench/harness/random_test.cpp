#include <algorithm>
#include <filesystem>
#include <gtest/gtest.h>
#include <map>

#include "bench/harness/random_verification.h"
#include "bench/strategies/catalogue.h"
#include "bench/testing/saboteurs.h"
#include "core/base/test_folder.h"
#include "scenes/clip/point_cache.h"
#include "scenes/random/random_interval.h"

namespace cscd::bench {
namespace {

TEST(RandomIntervals, DependOnTheirSeedAlone) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const scenes::RandomInterval a = scenes::make_random_interval(seed),
                                 b = scenes::make_random_interval(seed);
    for (const std::size_t frame : {std::size_t{0}, std::size_t{1}}) {
      const auto x = a.clip.frame(frame).positions, y = b.clip.frame(frame).positions;
      EXPECT_TRUE(std::equal(x.begin(), x.end(), y.begin(), y.end()));
    }
    EXPECT_EQ(a.clip.header().triangles, b.clip.header().triangles);
  }
}

TEST(RandomIntervals, AreClosedOrientedAndRigged) {
  std::map<std::string, int> families;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    scenes::RandomInterval random = scenes::make_random_interval(seed);
    ++families[std::string(random.family)];
    const TriangleMesh mesh(random.clip.header().triangles, random.clip.header().vertex_count);
    EXPECT_TRUE(mesh.closed_and_oriented()) << random.family;
    EXPECT_TRUE(scenes::rig_of(random.clip).has_value()) << random.family;
  }
  EXPECT_EQ(families.size(), scenes::random_families().size());
}

// Every family has contacts that start embedded; radial culling drops pairs in every row and, over all rows,
// contacts too (a row that certifies a triangle only with all around it drops next to none on meshes this
// small), or the run shows nothing.
TEST(RandomVerification, EveryStrategyHoldsOnThreeHundredIntervals) {
  std::vector<StrategyRow> rows = rows_of(strategies());
  std::ranges::copy(
      rows_called(std::vector<std::string>{"drvbc_fast --first", "drvbc_fast_complete --first"}),
      std::back_inserter(rows));
  const RandomSummary summary = verify_random({300, 1, 10}, rows);
  for (const RandomFailure& failure : summary.failures)
    ADD_FAILURE() << failure.strategy << ", seed " << failure.seed << ": " << failure.what;
  EXPECT_EQ(summary.intervals, 400u);
  EXPECT_EQ(summary.torn, 100u);
  // Of the torn ones a quarter are sheets, which mostly start embedded.
  EXPECT_LT(summary.embedded, 360u) << "torn ones mostly start by meeting themselves";
  EXPECT_GT(summary.embedded_with_contacts, 100u);
  EXPECT_EQ(summary.embedded_hits_of.size(), scenes::random_families().size());
  const RandomRow& all = summary.rows.at(std::string(complete_reference().name));
  std::size_t found = 0, expected = 0;
  for (const Strategy& strategy : strategies()) {
    const RandomRow& row = summary.rows.at(std::string(strategy.name));
    if (strategy.guarantee != Guarantee::first_contact) continue;
    EXPECT_LT(row.triangle_pairs, all.triangle_pairs * 3 / 4)
        << strategy.name << " culls too little to be put to the test";
    found += row.contacts_found;
    expected += row.contacts_expected;
  }
  EXPECT_LT(found, expected) << "no contact is ever dropped";
}

// The same at random thicknesses, for the rows that know distances.
TEST(RandomVerification, RowsThatKnowDistancesHoldAtRandomThicknesses) {
  const RandomSummary summary = verify_random({.intervals = 60, .thick = true}, rows_of(strategies()));
  for (const RandomFailure& failure : summary.failures)
    ADD_FAILURE() << failure.strategy << ", seed " << failure.seed << ": " << failure.what;
  EXPECT_EQ(summary.intervals, 80u);
  EXPECT_GT(summary.embedded_with_contacts, 20u) << "clear starts with close pairs";
  std::size_t known = 0;
  for (const Strategy& strategy : strategies()) known += strategy.knows_distance;
  EXPECT_EQ(summary.rows.size(), known);
}

TEST(RandomVerification, AFailureNamesItsSeedAndLeavesAFileThatReplays) {
  const Strategy saboteur[] = {
      {"uncertain_is_positive", "for tests", Guarantee::first_contact, Needs::closed_mesh_with_bones,
       StrategyKind::fixed,
       test::make_radial<test::Flaw::uncertain_called_positive, radial::ObserverKind::bone_centre>}};
  const RandomSummary summary = verify_random({60, 7, 10}, rows_of(saboteur));
  ASSERT_FALSE(summary.failures.empty());
  EXPECT_NE(describe(summary).find(std::to_string(summary.failures.size()) + " failures"), std::string::npos);

  const RandomFailure& failure = summary.failures.front();
  const test::Folder folder;
  const std::string line = write_failure(failure, folder.path);
  EXPECT_NE(line.find("seed " + std::to_string(failure.seed)), std::string::npos) << line;
  EXPECT_NE(line.find("uncertain_is_positive"), std::string::npos) << line;
  const auto file = std::filesystem::directory_iterator(folder.path)->path();
  EXPECT_NE(line.find(file.string()), std::string::npos) << line;

  // The file holds the very interval: the saboteur fails on it again.
  scenes::PointCacheReader reader(file);
  const scenes::RandomInterval random = scenes::make_random_interval(failure.seed);
  const scenes::FrameView written = random.clip.frame(1);
  const scenes::FrameView read = reader.load_frame(1);
  EXPECT_TRUE(std::equal(read.positions.begin(), read.positions.end(), written.positions.begin(),
                         written.positions.end()));
  const TriangleMesh mesh(reader.header().triangles, reader.header().vertex_count);
  const std::optional<Rig> rig = scenes::rig_of(reader);
  ASSERT_TRUE(rig);
  const scenes::FrameView first = reader.load_frame(0);
  const std::vector<Vec3> reference(first.positions.begin(), first.positions.end());
  const auto ask = [&](const Strategy& strategy) {
    const auto detector = strategy.make({mesh, reference, &*rig, elementary_test_named("exact")}).detector;
    const scenes::ClipInterval interval = reader.load(0);
    ContactSet found;
    detector->detect({interval.motion, &*interval.bones}, found);
    found.sort();
    return found;
  };
  const Verification replayed =
      verify(ask(complete_reference()), ask(saboteur[0]), Guarantee::first_contact, true);
  EXPECT_FALSE(replayed.ok);
  EXPECT_EQ(replayed.failure, failure.what);
}

}  // namespace
}  // namespace cscd::bench
