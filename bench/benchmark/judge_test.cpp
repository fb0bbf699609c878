#include "bench/benchmark/judge.h"

#include <cmath>
#include <gtest/gtest.h>

namespace cscd::bench {
namespace {

const PairName kFace = PairName::vertex_face(0, 7), kEdges = PairName::edge_edge(2, 1, 9, 8),
               kNone = PairName::vertex_face(3, 6);

// Two contacts, of which the edges touch first, at a time that is no double.
IntervalTruth touching() {
  IntervalTruth truth;
  truth.id = "one";
  truth.contacts = {{kEdges, {0.25, std::nextafter(0.25, 1.0)}}, {kFace, {0.5, 0.5}}};
  return truth;
}

IntervalTruth crossing() {
  IntervalTruth truth;
  truth.id = "crossing";
  truth.start_pairs = {{TriangleId{1}, TriangleId{4}}, {TriangleId{2}, TriangleId{5}}};
  return truth;
}

IntervalAnswers answer(Claim claim, std::vector<AnsweredContact> contacts) {
  IntervalAnswers out;
  out.id = "one";
  out.claim = claim;
  out.contacts = std::move(contacts);
  return out;
}

Score judged(const IntervalTruth& truth, const IntervalAnswers& one, double tolerance = 0) {
  std::vector<Fault> faults;
  const Score score = judge_interval(truth, one, tolerance, faults);
  // Each counted fault has its line, but for pairs at starts, which share one.
  const bool starts = score.start_pairs_missed + score.start_pairs_invented > 0;
  EXPECT_EQ(faults.size(),
            score.misses + score.inventions + score.late + score.early + score.starts_wrong + starts);
  return score;
}

TEST(PairName, HasOneOrder) {
  EXPECT_EQ(PairName::edge_edge(9, 8, 1, 2), kEdges);
  EXPECT_EQ(PairName::edge_edge(1, 2, 8, 9).index, (std::array<std::int32_t, 4>{1, 2, 8, 9}));
  EXPECT_EQ(PairName::edge_edge(5, 1, 1, 3).index, (std::array<std::int32_t, 4>{1, 3, 1, 5}));
}

TEST(Judge, FindsNothingWrongWithTheTruth) {
  for (const Claim claim : {Claim::complete, Claim::none, Claim::first_contact}) {
    const Score score = judged(touching(), answer(claim, {{kFace, 0.5}, {kEdges, 0.25}}));
    EXPECT_EQ(score.expected, claim == Claim::first_contact ? 1u : 2u);
    EXPECT_EQ(score.misses + score.inventions + score.late + score.early + score.broken, 0u);
    EXPECT_EQ(score.timed, 2u);
  }
}

// Mutation: without count_missed_pairs() a lost contact goes unseen.
TEST(Judge, CountsALostContact) {
  const Score score = judged(touching(), answer(Claim::complete, {{kEdges, 0.25}}));
  EXPECT_EQ(score.misses, 1u);
  EXPECT_EQ(score.broken, 1u);
  EXPECT_EQ(judged(touching(), answer(Claim::complete, {})).misses, 2u);
  const Score unpromised = judged(touching(), answer(Claim::none, {}));
  EXPECT_EQ(unpromised.misses, 2u);
  EXPECT_EQ(unpromised.broken, 0u);
}

// Mutation: with the pairs of the truth alone looked at, an invented one goes unseen.
TEST(Judge, CountsAnInventedContact) {
  const Score score =
      judged(touching(), answer(Claim::complete, {{kEdges, 0.25}, {kFace, 0.5}, {kNone, 0.1}}));
  EXPECT_EQ(score.inventions, 1u);
  EXPECT_EQ(score.misses + score.broken, 0u);
}

// Mutation: with hi taken for lo in look_at_time(), times inside of an enclosure are called late
// and early.
TEST(Judge, CountsWrongTimes) {
  const double hi = std::nextafter(0.25, 1.0);
  const Score exact = judged(touching(), answer(Claim::complete, {{kEdges, hi}, {kFace, 0.5}}));
  EXPECT_EQ(exact.late + exact.early, 0u);
  const Score wrong = judged(touching(), answer(Claim::complete, {{kEdges, 0.375}, {kFace, 0.4375}}));
  EXPECT_EQ(wrong.late, 1u);
  EXPECT_EQ(wrong.early, 1u);
  EXPECT_NEAR(wrong.latest, 0.125, 1e-15);
  EXPECT_EQ(wrong.earliest, 0.0625);
  EXPECT_EQ(wrong.misses + wrong.inventions, 0u);
  // A tolerated error is told, and not counted.
  const Score tolerated =
      judged(touching(), answer(Claim::complete, {{kEdges, 0.375}, {kFace, 0.4375}}), 0.1);
  EXPECT_EQ(tolerated.late, 1u);
  EXPECT_EQ(tolerated.early, 0u);
  EXPECT_EQ(tolerated.earliest, 0.0625);
}

// Mutation: with any contact of the truth taken for the first, the later pair alone is no miss.
TEST(Judge, AsksAFirstContactForTheEarliestTimeAlone) {
  const Score first = judged(touching(), answer(Claim::first_contact, {{kEdges, 0.25}}));
  EXPECT_EQ(first.misses, 0u);
  const Score later = judged(touching(), answer(Claim::first_contact, {{kFace, 0.5}}));
  EXPECT_EQ(later.misses, 1u);
  EXPECT_EQ(later.broken, 1u);
  EXPECT_EQ(judged(touching(), answer(Claim::first_contact, {})).misses, 1u);
  // Two pairs that touch at one instant: either will do.
  IntervalTruth both = touching();
  both.contacts[1].time = {0.25, 0.25};
  EXPECT_EQ(judged(both, answer(Claim::first_contact, {{kFace, 0.25}})).misses, 0u);
  EXPECT_EQ(judged(both, answer(Claim::first_contact, {{kEdges, 0.25}})).misses, 0u);
}

TEST(Judge, TakesAFirstTimeAlone) {
  IntervalAnswers one;
  one.claim = Claim::first_contact;
  one.first_time.emplace(0.25);
  EXPECT_EQ(judged(touching(), one).misses, 0u);
  EXPECT_EQ(judged(crossing(), one).inventions, 1u);
  *one.first_time = 0.3;
  EXPECT_EQ(judged(touching(), one).late, 1u);
  *one.first_time = std::nullopt;
  EXPECT_EQ(judged(touching(), one).misses, 1u);
  EXPECT_EQ(judged(crossing(), one).misses, 0u);
}

TEST(Judge, TakesYesOrNo) {
  IntervalAnswers one;
  one.claim = Claim::collides;
  one.collides = false;
  EXPECT_EQ(judged(touching(), one).misses, 1u);
  EXPECT_EQ(judged(crossing(), one).misses, 1u) << "a start that is not embedded collides";
  EXPECT_EQ(judged(IntervalTruth{}, one).misses, 0u);
  one.collides = true;
  EXPECT_EQ(judged(touching(), one).inventions, 0u);
  const Score invented = judged(IntervalTruth{}, one);
  EXPECT_EQ(invented.inventions, 1u);
  EXPECT_EQ(invented.collides_wrong, 1u);
}

// Mutation: with undecided pairs left out of those that are named, they are missed.
TEST(Judge, CountsWhatIsUndecidedApart) {
  const Score score = judged(
      touching(), answer(Claim::complete, {{kEdges, std::nullopt}, {kFace, 0.5}, {kNone, std::nullopt}}));
  EXPECT_EQ(score.undecided, 2u);
  EXPECT_EQ(score.misses + score.inventions, 0u);
  EXPECT_EQ(score.timed, 1u);
}

TEST(Judge, ComparesStarts) {
  IntervalAnswers one = answer(Claim::complete, {});
  EXPECT_EQ(judged(crossing(), one).starts_told, 0u);
  one.starts_embedded = true;
  EXPECT_EQ(judged(crossing(), one).starts_wrong, 1u);
  one.starts_embedded = false;
  one.start_pairs = {{TriangleId{2}, TriangleId{5}}, {TriangleId{0}, TriangleId{9}}};
  const Score score = judged(crossing(), one);
  EXPECT_EQ(score.starts_wrong, 0u);
  EXPECT_EQ(score.start_pairs_missed, 1u);
  EXPECT_EQ(score.start_pairs_invented, 1u);
}

TEST(Judge, SumsScores) {
  Score sum, one;
  one.misses = 2, one.latest = 0.5, one.milliseconds = {3};
  sum.add(one);
  one.misses = 1, one.latest = 0.25, one.milliseconds = {4};
  sum.add(one);
  EXPECT_EQ(sum.misses, 3u);
  EXPECT_EQ(sum.latest, 0.5);
  EXPECT_EQ(sum.milliseconds, (std::vector<double>{3, 4}));
}

}  // namespace
}  // namespace cscd::bench
