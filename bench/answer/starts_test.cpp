#include <gtest/gtest.h>
#include <limits>

#include "bench/answer/answer.h"
#include "bench/inputs/test_inputs.h"
#include "bench/strategies/catalogue.h"
#include "core/detect/start/embedding.h"
#include "core/elementary/catalogue.h"

// A query follows the motion instead of searching a start from nothing. That needs premises about the row
// that answered, and each test here breaks one of them: the row or its elementary test misses contacts that
// it does not promise. Whatever is missed, the crossings at every start have to be right.
namespace cscd::bench {
namespace {

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

enum class Reports { nothing, nothing_from_a_start_that_crosses, one_contact };

// Finds what the reference finds, and reports less.
template <Reports kReports>
class Silent : public Detector {
 public:
  explicit Silent(const StrategyInput& setup)
      : detector_(complete_reference().make(setup).detector), start_test_(setup.mesh, setup.reference) {}

  Report detect(const Step& step, ContactSet& out) override {
    const Report report = detector_->detect(step, out);
    const bool silent =
        kReports == Reports::nothing || (kReports == Reports::nothing_from_a_start_that_crosses &&
                                         !start_test_.embedded(step.motion.start()));
    const std::size_t most = silent ? 0 : kReports == Reports::one_contact ? 1 : out.contacts.size();
    out.contacts.resize(std::min(most, out.contacts.size()));
    return report;
  }

 private:
  std::unique_ptr<Detector> detector_;
  EmbeddingTest start_test_;
};

template <Reports kReports>
Prepared make_silent(const StrategyInput& setup) {
  return {std::make_unique<Silent<kReports>>(setup), {}};
}

template <class Query>
Answer says_apart(const Query&) {
  return {Verdict::apart, 0};
}
template <class Query>
Answer says_undecided(const Query&) {
  return {Verdict::undecided, 0};
}
constexpr ElementaryTest kBlind{"blind",
                                "",
                                false,
                                true,
                                one_by_one<says_apart<MovingVertexFace>>,
                                one_by_one<says_apart<MovingEdgeEdge>>};
constexpr ElementaryTest kUndecided{"undecided",
                                    "",
                                    true,
                                    true,
                                    one_by_one<says_undecided<MovingVertexFace>>,
                                    one_by_one<says_undecided<MovingEdgeEdge>>};

// One ball flies into the other, rests there, and comes out again. Asks for all intervals in order, and then
// for intervals here and there.
void expect_starts_right(const Strategy& strategy, const ElementaryTest& elementary, bool unproven = false) {
  Input input = two_balls({0.0, -0.5, -1.2, -2.2, -2.2, -1.9, -0.3, 0.1});
  Answerer answerer(input, strategy, elementary, {.unproven = unproven, .keep_rest_crossings = true});
  EmbeddingTest from_nothing(input.mesh, input.reference);
  for (const std::size_t i : {0, 1, 2, 3, 4, 5, 6, 0, 3, 1, 6, 2, 5, 4, 0}) {
    const Crossings expected = from_nothing.find_all(input.clip->load(i).motion.start(), kNoLimit);
    const IntervalAnswer answer = answerer.answer(i, input.clip->load(i));
    ASSERT_EQ(answer.start.pairs, expected.pairs) << i;
    EXPECT_EQ(answer.starts_embedded, expected.total == 0) << i;
  }
}

TEST(KnownStarts, NeedARowThatPromisesSomething) {
  expect_starts_right({"silent", "", Guarantee::heuristic, Needs::any_mesh, StrategyKind::fixed,
                       make_silent<Reports::nothing>},
                      elementary_test_named("exact"));
}

TEST(KnownStarts, NeedAnElementaryTestOfTheCallers) {
  for (const Guarantee guarantee : {Guarantee::first_contact, Guarantee::complete})
    expect_starts_right(
        {"own", "", guarantee, Needs::any_mesh, StrategyKind::fixed, make_silent<Reports::nothing>, "", true},
        elementary_test_named("exact"));
}

TEST(KnownStarts, NeedAnElementaryTestWhoseApartIsAProof) {
  expect_starts_right(complete_reference(), kBlind);
}

TEST(KnownStarts, NeedAnEmbeddedStartWhereTheFirstContactIsPromised) {
  expect_starts_right({"first", "", Guarantee::first_contact, Needs::any_mesh, StrategyKind::fixed,
                       make_silent<Reports::nothing_from_a_start_that_crosses>},
                      elementary_test_named("exact"), true);
}

// A row that promises the first contact reports one that nobody could decide, and not those after it.
TEST(KnownStarts, NeedAnswersWithoutAnythingUndecided) {
  expect_starts_right({"one", "", Guarantee::first_contact, Needs::any_mesh, StrategyKind::fixed,
                       make_silent<Reports::one_contact>},
                      kUndecided);
}

// Counts how often it is told that a start is embedded, and whether that is true.
class Trusting : public Silent<Reports::nothing_from_a_start_that_crosses> {
 public:
  explicit Trusting(const StrategyInput& setup) : Silent(setup), start_test_(setup.mesh, setup.reference) {}
  Report detect(const Step& step, ContactSet& out) override {
    told += step.starts_embedded;
    EXPECT_TRUE(!step.starts_embedded || start_test_.embedded(step.motion.start()));
    return Silent::detect(step, out);
  }
  static inline int told = 0;

 private:
  EmbeddingTest start_test_;
};
Prepared make_trusting(const StrategyInput& setup) {
  return {std::make_unique<Trusting>(setup), {}};
}

// Mutations: every known start is taken for embedded; none is.
TEST(KnownStarts, AreNotTakenForEmbeddedWhereSomethingCrosses) {
  Trusting::told = 0;
  expect_starts_right(
      {"trusting", "", Guarantee::all_from_embedded, Needs::any_mesh, StrategyKind::fixed, make_trusting},
      elementary_test_named("exact"));
  expect_starts_right(
      {"trusting", "", Guarantee::all_from_embedded, Needs::any_mesh, StrategyKind::fixed, make_trusting},
      elementary_test_named("exact"), true);
  EXPECT_GT(Trusting::told, 10);
}

// Mutations: it is told after a step with contacts too; never again after one.
TEST(KnownStarts, AreNotTakenForEmbeddedInTheStepAfterOneWithContacts) {
  // The second ball flies through the first, and on.
  Input input = two_balls({0.0, -0.1, -6.0, -6.1, -6.2, -6.3});
  const Strategy strategy{"trusting",          "",           Guarantee::complete, Needs::any_mesh,
                          StrategyKind::fixed, make_trusting};
  Answerer answerer(input, strategy, elementary_test_named("exact"), {});
  std::vector<bool> told;
  for (std::size_t i = 0; i < 5; ++i) {
    Trusting::told = 0;
    const IntervalAnswer answer = answerer.answer(i, input.clip->load(i));
    EXPECT_TRUE(answer.starts_embedded) << i;
    EXPECT_EQ(answer.found.contacts.empty(), i != 1) << i;
    told.push_back(Trusting::told > 0);
  }
  EXPECT_EQ(told, (std::vector<bool>{true, true, false, true, true}));
}

// Counts how often it is asked to see a start.
class Looking : public Detector {
 public:
  explicit Looking(const StrategyInput& setup) : detector_(complete_reference().make(setup).detector) {}
  Report detect(const Step& step, ContactSet& out) override {
    asked += step.crossings != nullptr;
    return detector_->detect(step, out);
  }
  static inline int asked = 0;

 private:
  std::unique_ptr<Detector> detector_;
};
Prepared make_looking(const StrategyInput& setup) {
  return {std::make_unique<Looking>(setup), {}};
}

// The row itself finds what crosses at rest. A start that is not known is followed to if the row looks by
// signs and nothing touches on the way, and seen if not. Mutations: rows that look by signs see, others
// follow; the pose at rest is searched apart.
TEST(KnownStarts, AreFollowedToWhereSignsPay) {
  for (const bool by_signs : {false, true}) {
    Input input = two_balls({0.0, -0.5, -0.2, -0.6, 0.3, -1.2, -2.2});
    const Strategy strategy{.name = "looking",
                            .source = "",
                            .guarantee = Guarantee::complete,
                            .needs = Needs::any_mesh,
                            .kind = StrategyKind::fixed,
                            .make = make_looking,
                            .sees_start = true,
                            .drops_by_signs = by_signs};
    Looking::asked = 0;
    Answerer answerer(input, strategy, elementary_test_named("exact"), {});
    EXPECT_EQ(Looking::asked, 1);
    EmbeddingTest from_nothing(input.mesh, input.reference);
    for (const std::size_t i : {0, 2, 4, 1, 5, 3})
      EXPECT_EQ(answerer.answer(i, input.clip->load(i)).start.pairs,
                from_nothing.find_all(input.clip->load(i).motion.start(), kNoLimit).pairs)
          << i;
    // On the ways to two of these starts the balls touch.
    EXPECT_EQ(Looking::asked, by_signs ? 3 : 6);
  }
}

TEST(KnownStarts, AreRightOfTheEngine) {
  for (const std::string_view name : {"drvbc_fast", "drvbc_fast_all", "drvbc_fast_complete"}) {
    expect_starts_right(strategy_named(name), elementary_test_named("exact"));
    expect_starts_right(strategy_named(name), kBlind);
  }
}

}  // namespace
}  // namespace cscd::bench
