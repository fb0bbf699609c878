// Looking for the earliest contact only changes what is asked, not what the earliest time is.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/strategies/catalogue.h"
#include "bench/strategies/strategy_row.h"
#include "bench/testing/test_program.h"
#include "core/base/error.h"
#include "scenes/clip/point_cache.h"
#include "scenes/random/random_interval.h"

namespace cscd::bench {
namespace {

// Every strategy, promises or not: the contacts of its earliest time are those of its full answer.
TEST(FirstOnly, EveryStrategyKeepsItsContactsOfTheEarliestTime) {
  const ElementaryTest& test = elementary_test_named("filtered_exact");
  std::size_t colliding = 0;
  for (std::uint64_t seed = 1; seed <= 66; ++seed) {
    scenes::RandomInterval random = scenes::make_random_interval(seed);
    const TriangleMesh mesh(random.clip.header().triangles, random.clip.header().vertex_count);
    const std::optional<Rig> rig = scenes::rig_of(random.clip);
    const scenes::ClipInterval interval = random.clip.interval(0);
    for (const Strategy& strategy : strategies()) {
      StrategyInput setup{mesh, random.clip.frame(0).positions, &*rig, test};
      const auto all = strategy.make(setup).detector;
      setup.first_only = true;
      if (strategy.own_test) {
        EXPECT_THROW(strategy.make(setup), InputError) << strategy.name;
        continue;
      }
      const auto first = strategy.make(setup).detector;
      ContactSet expected, found;
      all->detect({interval.motion, &*interval.bones}, expected);
      first->detect({interval.motion, &*interval.bones}, found);
      for (ContactSet* set : {&expected, &found}) {
        set->sort();
        keep_first(*set);
      }
      EXPECT_EQ(digest(found), digest(expected)) << strategy.name << ", seed " << seed;
      colliding += !found.contacts.empty();
    }
  }
  EXPECT_GT(colliding, 100u);
}

// All contacts of the earliest time where all were promised, one of them where one was, and none of a later.
TEST(FirstOnly, ARowIsHeldToWhatItWasAskedFor) {
  const auto rows = rows_called(std::vector<std::string>{"base --first", "drvbc --first", "base"});
  ASSERT_EQ(rows.size(), 3u);
  const StrategyRow &all = rows[0], &one = rows[1], &every = rows[2];
  EXPECT_EQ(all.name(), "base --first");
  const auto contact = [](int vertex, double time) {
    return Contact{{FeaturePair::Kind::vertex_face, vertex, 9}, Verdict::contact, time};
  };
  const ContactSet truth{{contact(1, 0.25), contact(2, 0.25), contact(3, 0.5)}};
  const ContactSet earliest{{contact(1, 0.25), contact(2, 0.25)}}, half{{contact(2, 0.25)}},
      later{{contact(3, 0.5)}};
  EXPECT_TRUE(verify(truth, earliest, all, true).ok);
  EXPECT_FALSE(verify(truth, half, all, true).ok);
  EXPECT_TRUE(verify(truth, half, one, true).ok);
  EXPECT_NE(verify(truth, later, one, true).failure.find("lost the first contact"), std::string::npos);
  EXPECT_NE(verify(truth, later, all, false).failure.find("lost the first contact"), std::string::npos);
  EXPECT_TRUE(verify(truth, later, one, false).ok) << "nothing is promised";
  EXPECT_FALSE(verify(truth, truth, all, true).ok);
  EXPECT_TRUE(verify(truth, truth, every, true).ok);
  EXPECT_FALSE(verify(truth, earliest, every, true).ok);
}

TEST(FirstOnly, QueryReportsTheEarliestTimeAloneAndRefusesWhatMayBeWrong) {
  const Scratch scratch;
  const std::string file = scratch / "ball.h5";
  scenes::RandomInterval random = scenes::make_random_interval(11);
  scenes::PointCacheWriter writer(file, random.clip.header(), false);
  scenes::copy_frames(random.clip, writer);
  writer.finish();
  const nlohmann::json all = document_of({"query", file}), first = document_of({"query", file, "--first"});
  EXPECT_EQ(first["first_only"], true);
  const nlohmann::json &from = all["intervals"][0], &left = first["intervals"][0];
  ASSERT_EQ(from["collides"], true);
  EXPECT_EQ(left["time"], from["time"]);
  nlohmann::json expected = nlohmann::json::array();
  for (const nlohmann::json& contact : from["contacts"])
    if (contact["time"] == from["time"]) expected.push_back(contact);
  EXPECT_EQ(left["contacts"], expected);

  expect_refused({"query", file, "--first", "--elementary", "newton"}, "newton");
}

}  // namespace
}  // namespace cscd::bench
