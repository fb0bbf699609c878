#include "bench/measure/studies/tally.h"

#include <gtest/gtest.h>

#include "bench/strategies/catalogue.h"
#include "core/base/error.h"
#include "scenes/hard/disturbance.h"

namespace cscd::bench {
namespace {

namespace hard = scenes::hard;

const hard::Family& crossing() {
  for (const hard::Family& family : hard::families())
    if (family.name == "through_border") return family;
  throw std::logic_error("no such family");
}

template <Verdict verdict, class Query>
Answer lie(const Query&) {
  return {verdict, 1};
}

// Says the same to everything, and claims to have proved it.
template <Verdict verdict>
constexpr ElementaryTest kLiar{"liar",
                               "",
                               true,
                               true,
                               one_by_one<lie<verdict, MovingVertexFace>>,
                               one_by_one<lie<verdict, MovingEdgeEdge>>};

struct Measured {
  std::vector<Question> queries;
  std::vector<Truth> truths;
  std::vector<Tally> tallies;
  std::size_t contacts = 0;

  explicit Measured(std::vector<const ElementaryTest*> tests) : tallies(tests.size()) {
    for (std::size_t i = 0; i < 300; ++i) {
      queries.push_back({hard::suite_query(crossing(), Kind::vertex_face, i, 1)});
      truths.push_back(truth_of(queries.back(), Kind::vertex_face));
      contacts += truths.back().contact.has_value();
    }
    std::vector<Tally*> places;
    for (Tally& tally : tallies) places.push_back(&tally);
    std::mt19937_64 random(1);
    measure(queries, truths, Kind::vertex_face, tests, 2, random, places);
  }
};

TEST(Tally, CountsWhatIsWrong) {
  const ElementaryTest &yes = kLiar<Verdict::contact>, &no = kLiar<Verdict::apart>,
                       &shrug = kLiar<Verdict::undecided>, &exact = elementary_test_named("exact");
  const Measured m({&yes, &no, &shrug, &exact});
  ASSERT_GT(m.contacts, 50u);
  ASSERT_LT(m.contacts, 250u);
  const std::size_t others = m.queries.size() - m.contacts;
  EXPECT_EQ(m.tallies[0].false_positives, others);
  EXPECT_EQ(m.tallies[0].false_negatives, 0u);
  EXPECT_GT(m.tallies[0].largest_late, 0.4) << "contacts are at 1/2, it said 1";
  EXPECT_EQ(m.tallies[1].false_negatives, m.contacts);
  EXPECT_EQ(m.tallies[1].false_positives, 0u);
  EXPECT_EQ(m.tallies[2].undecided_contacts, m.contacts);
  EXPECT_EQ(m.tallies[2].undecided_apart, others);
  EXPECT_TRUE(m.tallies[0].breaks(yes));
  EXPECT_TRUE(m.tallies[1].breaks(no));
  EXPECT_FALSE(m.tallies[2].breaks(shrug)) << "undecided breaks no promise";
  EXPECT_FALSE(m.tallies[3].breaks(exact));
  for (const Tally& tally : m.tallies) {
    EXPECT_EQ(tally.queries, m.queries.size());
    EXPECT_EQ(tally.timed[0] + tally.timed[1] + tally.timed[2], m.queries.size());
    EXPECT_EQ(tally.ns[2].size(), 2u) << "one sample a pass";
  }
}

TEST(Tally, TheDistanceOfFalseAlarmsIsMeasured) {
  const auto still = [](double x, double y, double z) { return MovingPoint{{x, y, z}, {x, y, z}}; };
  // Falls past the border at a hundredth of its extent.
  const Query query{
      {MovingPoint{{-0.04, 1, 3.7}, {-0.04, 1, -0.3}}, still(0, 0, 0), still(3.96, 0, 0), still(0, 3, 0)},
      {}};
  EXPECT_NEAR(least_distance({query}, Kind::vertex_face), 0.01, 1e-9);
  EXPECT_NEAR(least_distance({query, 0.03}, Kind::vertex_face), 0.0025, 1e-9) << "an extent is 4";
  EXPECT_FALSE(truth_of({query, 0.0399}, Kind::vertex_face).contact);
  EXPECT_TRUE(truth_of({query, 0.0401}, Kind::vertex_face).contact);
}

TEST(Tally, SumsAreSums) {
  const Measured one({&kLiar<Verdict::apart>}), two({&kLiar<Verdict::apart>});
  Tally sum = one.tallies[0];
  sum.add(two.tallies[0]);
  EXPECT_EQ(sum.false_negatives, 2 * one.contacts);
  EXPECT_EQ(sum.queries, 2 * one.queries.size());
}

TEST(ElementaryRows, ParametersAreChosenByName) {
  const ElementaryTest& fine = elementary_test_named("inclusion@1e-4:123");
  EXPECT_EQ(fine.name, "inclusion@1e-4:123");
  EXPECT_EQ(fine.parameters.tolerance, 1e-4);
  EXPECT_EQ(fine.parameters.steps, 123);
  EXPECT_EQ(&fine, &elementary_test_named("inclusion@1e-4:123")) << "lives on";
  EXPECT_EQ(elementary_test_named("cubic@0").parameters.tolerance, 0);
  EXPECT_EQ(elementary_tests_named("all,cubic@1e-3").size(), all_elementary_tests().size() + 1);
  for (const char* wrong : {"exact@1e-3", "cubic@", "cubic@x", "cubic@-1", "cubic@1", "cubic@1e-3:5",
                            "inclusion@1e-3:", "inclusion@1e-3:0", "inclusion@1e-3:1.5", "none", ""})
    EXPECT_THROW(elementary_test_named(wrong), InputError) << wrong;
}

}  // namespace
}  // namespace cscd::bench
