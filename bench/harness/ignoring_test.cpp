#include <gtest/gtest.h>
#include <random>

#include "bench/harness/test_trial.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"
#include "core/detect/start/crossings.h"

// Detectors that are measured leave out what the input says is ignored, and nothing else.
namespace cscd::bench {
namespace {

const ElementaryTest& filtered_exact() {
  return elementary_test_named("filtered_exact");
}

// A random interval, whose triangles are in four groups of which some ignore each other.
struct Subject {
  Input input;
  std::vector<std::int32_t> group;
  std::vector<std::pair<std::int32_t, std::int32_t>> ignoring;

  explicit Subject(std::uint64_t seed) : input(random_input(seed)) {
    std::mt19937_64 random(seed);
    // Neighbours are often of one group, as triangles of one bone are, and often of two, as at joints.
    for (std::size_t t = 0; t < input.mesh.triangle_count(); ++t)
      group.push_back(t > 0 && random() % 3 != 0 ? group.back() : static_cast<std::int32_t>(random() % 4));
    for (const std::int32_t g : {0, 1, 2, 3}) group[static_cast<std::size_t>(g)] = g;
    for (int pair = 0; pair < 4; ++pair)
      ignoring.emplace_back(static_cast<std::int32_t>(random() % 4), static_cast<std::int32_t>(random() % 4));
    auto ignored = std::make_shared<Ignored>();
    ignored->triangles.set_triangle_groups(input.mesh, group, ignoring);
    input.ignored = std::move(ignored);
  }

  bool ignores(TriangleId s, TriangleId t) const {
    return std::ranges::any_of(ignoring, [&](const auto& pair) {
      return pair == std::pair(group[+s], group[+t]) || pair == std::pair(group[+t], group[+s]);
    });
  }
  ContactSet ask(const Prepared& prepared) const {
    ContactSet found;
    const scenes::ClipInterval interval = input.clip->load(0);
    prepared.detector->detect({interval.motion, interval.bones ? &*interval.bones : nullptr}, found);
    found.sort();
    return found;
  }
};

// Mutation: a feature pair is dropped with the ignored pair of triangles that it is assigned to, though
// others carry it too.
TEST(Ignoring, EveryRowThatIsMeasuredLeavesTheOtherContacts) {
  std::size_t ignored = 0, kept = 0, rows = 0;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    const Subject subject(seed);
    const Strategy& oracle = strategy_named("brute");
    ContactSet expected = subject.ask(oracle.make(subject.input.setup(filtered_exact())));
    ignored += std::erase_if(expected.contacts, [&](const Contact& contact) {
      return std::ranges::all_of(carriers(subject.input.mesh, contact.pair), [&](const CrossingPair& pair) {
        return subject.ignores(pair.first, pair.second);
      });
    });
    kept += expected.contacts.size();
    std::vector<std::string> names;
    for (const StrategyRow& row : chosen_rows(subject.input, {})) names.push_back(row.name());
    names.emplace_back("brute");
    for (const std::string& name : names) {
      const Strategy& strategy = strategy_named(name);
      const Prepared prepared = strategy.make(measured_setup(subject.input, strategy, filtered_exact()));
      EXPECT_EQ(digest(subject.ask(prepared)), digest(expected)) << name << ", seed " << seed;
    }
    rows = std::max(rows, names.size());
  }
  EXPECT_GT(ignored, 200u);
  EXPECT_GT(kept, 500u);
  EXPECT_GE(rows, 7u);
}

TEST(Ignoring, RowsThatCannotAreLeftOutOrRefused) {
  const Subject subject(1);
  for (const StrategyRow& row : chosen_rows(subject.input, {}))
    EXPECT_TRUE(row.strategy->guarantee == Guarantee::complete ||
                row.strategy->guarantee == Guarantee::all_from_embedded)
        << row.name();
  for (const char* name : {"drvbc", "drvbc_fast", "drvbc_one_vertex"}) {
    const std::vector<std::string> asked{name};
    EXPECT_THROW(chosen_rows(subject.input, asked), InputError) << name;
  }
}

}  // namespace
}  // namespace cscd::bench
