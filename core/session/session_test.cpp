#include "core/session/session.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "core/base/error.h"
#include "core/detect/compose.h"
#include "core/detect/exclusions.h"
#include "core/detect/plain_culler.h"
#include "core/elementary/catalogue.h"
#include "core/fast/drvbc_fast.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

Prepared make_plain(const StrategyInput& setup) {
  return {compose(std::make_unique<PlainCuller<Kdop16>>(setup), setup), {}};
}
const Strategy kPlain{.name = "plain",
                      .source = "",
                      .guarantee = Guarantee::complete,
                      .needs = Needs::any_mesh,
                      .kind = StrategyKind::fixed,
                      .make = make_plain,
                      .sees_start = true,
                      .knows_distance = true};

// One ball rests, and another lies along the x axis where a test puts it.
class SessionTest : public testing::Test {
 protected:
  std::vector<Vec3> pose(double x) const {
    std::vector<Vec3> out = shape_.positions;
    for (std::size_t v = out.size() / 2; v < out.size(); ++v) out[v] += Vec3(x, 0.1, 0.2);
    return out;
  }
  StrategyInput setup() const {
    return {mesh_, reference_, nullptr, *find_elementary_test("filtered_exact")};
  }
  Session session(const Strategy& strategy, const SessionOptions& options = {}) const {
    return {"test", setup(), strategy, kDrvbcFastComplete, reference_, options};
  }
  ContactSet contacts_of(const Motion& motion, const Thickness& thickness = {}) const {
    ContactSet out;
    make_plain(setup()).detector->detect({.motion = motion, .thickness = thickness}, out);
    out.sort();
    return out;
  }
  std::vector<CrossingPair> crossings_of(std::span<const Vec3> pose) const {
    return EmbeddingTest(mesh_, reference_).find_all(pose, std::numeric_limits<std::size_t>::max()).pairs;
  }

  test::Shape shape_ = test::together(test::icosphere(1), test::icosphere(1, 0.7));
  TriangleMesh mesh_ = shape_.mesh();
  std::vector<Vec3> reference_ = pose(4);
  StepAnswer answer_;
};

// Steps follow each other, and sometimes begin elsewhere. Whatever a session knows of their starts, its
// answers are those of a search from nothing.
TEST_F(SessionTest, AnswersAsIfEachStepWereTheFirst) {
  const std::vector<double> places = {4, 3, 2.5, 1.2, 0.9, 1.2, 2.5, 2.6, 1.5, -3, -2.4, -2.5, -1};
  for (const Strategy* strategy : {&kPlain, &kDrvbcFast, &kDrvbcFastComplete})
    for (const bool first : {false, true}) {
      Session session = this->session(*strategy, {.first = first});
      std::mt19937 random(5);
      std::size_t touched = 0, crossed = 0, free = 0;
      for (std::size_t i = 0; i < 40; ++i) {
        const std::size_t place = i % 7 == 3 ? random() % (places.size() - 1) : i % (places.size() - 1);
        const std::vector<Vec3> from = pose(places[place]), to = pose(places[place + 1]);
        session.step({from, to}, nullptr, answer_);
        const ContactSet truth = contacts_of({from, to});
        EXPECT_EQ(answer_.start.pairs, crossings_of(from)) << strategy->name << i;
        EXPECT_EQ(answer_.starts_embedded, answer_.start.total == 0);
        EXPECT_TRUE(answer_.proven);
        ASSERT_EQ(answer_.time().has_value(), !truth.contacts.empty()) << strategy->name << i;
        if (answer_.time()) {
          EXPECT_EQ(*answer_.time(), truth.contacts.front().time) << strategy->name << i;
        }
        if (!first && answer_.strategy->guarantee == Guarantee::complete) {
          EXPECT_EQ(digest(answer_.found), digest(truth)) << strategy->name << i;
        }
        // From a start that is not known, the fallback may answer too, because it sees the start.
        if (strategy != &kDrvbcFast || !answer_.starts_embedded) {
          EXPECT_EQ(answer_.strategy, strategy == &kDrvbcFast ? &kDrvbcFastComplete : strategy) << i;
        }
        touched += !truth.contacts.empty();
        crossed += !answer_.starts_embedded;
        free += truth.contacts.empty() && answer_.starts_embedded;
      }
      EXPECT_GT(touched, 5u);
      EXPECT_GT(crossed, 5u);
      EXPECT_GT(free, 5u);
    }
}

// The same with a thickness. A clear start takes the place of an embedded one, and what is close at the start
// is known to be.
TEST_F(SessionTest, AnswersCloseStepsAsIfEachWereTheFirst) {
  const std::vector<double> places = {4,   3,   2.5, 1.85, 1.8, 2.5,  1.2, 0.9,
                                      1.8, 2.5, 2.6, 1.82, -3,  -2.4, -2.5};
  const std::vector<double> by_vertex(mesh_.vertex_count(), 0.06);
  for (const Thickness& thickness : {Thickness(0.2), Thickness(0.05, by_vertex)})
    for (const Strategy* strategy : {&kPlain, &kDrvbcFast, &kDrvbcFastComplete})
      for (const bool first : {false, true}) {
        Session session = this->session(*strategy, {.first = first, .thickness = thickness});
        std::mt19937 random(5);
        std::size_t touched = 0, close_at_start = 0, quick = 0;
        for (std::size_t i = 0; i < 24; ++i) {
          const std::size_t place = i % 9 == 3 ? random() % (places.size() - 1) : i % (places.size() - 1);
          const std::vector<Vec3> from = pose(places[place]), to = pose(places[place + 1]);
          session.step({from, to}, nullptr, answer_);
          const ContactSet truth = contacts_of({from, to}, thickness);
          const ContactSet at_start = contacts_of({from, from}, thickness);
          EXPECT_EQ(answer_.start.pairs, crossings_of(from)) << strategy->name << i;
          EXPECT_EQ(answer_.starts_clear, answer_.start.total == 0 && at_start.contacts.empty()) << i;
          EXPECT_TRUE(answer_.proven);
          ASSERT_EQ(answer_.time().has_value(), !truth.contacts.empty()) << strategy->name << i;
          if (answer_.time()) {
            EXPECT_EQ(*answer_.time(), truth.contacts.front().time) << strategy->name << i;
          }
          EXPECT_EQ(std::ranges::count(answer_.found.contacts, 0.0, &Contact::time),
                    static_cast<std::ptrdiff_t>(at_start.contacts.size()));
          if (!first && answer_.strategy->guarantee == Guarantee::complete) {
            EXPECT_EQ(digest(answer_.found), digest(truth)) << strategy->name << i;
          }
          quick += answer_.strategy == &kDrvbcFast;
          touched += !truth.contacts.empty();
          close_at_start += !at_start.contacts.empty();
        }
        EXPECT_GT(touched, 5u);
        EXPECT_GT(close_at_start, 5u);
        EXPECT_EQ(quick > 5, strategy == &kDrvbcFast) << quick;
      }
}

// After a step without a close pair, the next one is told that its start is clear. Where the start is not
// known, the way to it from the clear pose is asked about.
TEST_F(SessionTest, KnowsTheEndOfAClearStepToBeClear) {
  Session session = this->session(kDrvbcFast, {.first = true, .thickness = Thickness(0.2)});
  const std::vector<Vec3> far = pose(4), near = pose(2.5), close = pose(1.75), between = pose(2.2);
  session.step({far, near}, nullptr, answer_);
  EXPECT_EQ(answer_.strategy, &kDrvbcFastComplete) << "nothing is known of the first start";
  EXPECT_TRUE(answer_.starts_clear);
  session.step({near, close}, nullptr, answer_);
  EXPECT_EQ(answer_.strategy, &kDrvbcFast);
  EXPECT_TRUE(answer_.time());
  session.step({between, far}, nullptr, answer_);
  EXPECT_EQ(answer_.strategy, &kDrvbcFast) << "the way from `near` is clear";
  session.step({close, far}, nullptr, answer_);
  EXPECT_EQ(answer_.strategy, &kDrvbcFastComplete) << "embedded, and not clear";
  EXPECT_TRUE(answer_.starts_embedded);
  EXPECT_FALSE(answer_.starts_clear);
  EXPECT_EQ(answer_.time(), 0.0);
}

TEST_F(SessionTest, RefusesAThicknessThatNoProofCovers) {
  Strategy blind = kPlain;
  blind.knows_distance = false;
  EXPECT_THROW(session(blind, {.thickness = Thickness(0.1)}), InputError);
  const StrategyInput cubic{mesh_, reference_, nullptr, *find_elementary_test("cubic")};
  EXPECT_THROW(Session("test", cubic, kPlain, kDrvbcFastComplete, reference_, {.thickness = Thickness(0.1)}),
               InputError);
  EXPECT_NO_THROW(session(blind));
  std::vector<double> of_vertex(mesh_.vertex_count(), 0.1);
  of_vertex[0] = 0.2;
  const SessionOptions uneven{.thickness = Thickness(0, of_vertex)};
  EXPECT_THROW(session(kDrvbcFast, uneven), InputError) << "signs speak of one thickness";
  EXPECT_NO_THROW(session(kDrvbcFastComplete, uneven));
}

TEST_F(SessionTest, LeavesOutWhatCrossesAtRest) {
  reference_ = pose(1.2);
  const std::vector<Vec3> further = pose(1.25);
  for (const bool keep : {false, true}) {
    Session session = this->session(kDrvbcFast, {.keep_rest_crossings = keep});
    session.step({reference_, further}, nullptr, answer_);
    EXPECT_EQ(session.rest_crossings().pairs, crossings_of(reference_));
    EXPECT_FALSE(answer_.starts_embedded);
    EXPECT_EQ(answer_.rest_pairs, keep ? 0 : crossings_of(reference_).size());
    EXPECT_EQ(answer_.start.pairs, keep ? crossings_of(reference_) : std::vector<CrossingPair>{});
    const ContactSet all = contacts_of({reference_, further});
    ASSERT_FALSE(all.contacts.empty());
    EXPECT_EQ(answer_.rest_contacts + answer_.found.contacts.size(), all.contacts.size());
    EXPECT_EQ(answer_.rest_contacts > 0, !keep);
  }
}

TEST_F(SessionTest, CountsWhatIsIgnored) {
  Exclusions ignored;
  std::vector<int> group(mesh_.vertex_count());
  for (std::size_t v = 0; v < group.size(); ++v) group[v] = v < group.size() / 2 ? 0 : 1;
  ignored.set_groups(mesh_, group, std::vector<std::pair<int, int>>{{0, 1}});
  const std::vector<Vec3> from = pose(4), to = pose(1);
  for (const Strategy* strategy : {&kDrvbcFast, &kDrvbcFastComplete}) {
    Session session = this->session(*strategy, {.ignored = &ignored});
    session.step({from, to}, nullptr, answer_);
    EXPECT_TRUE(answer_.found.contacts.empty());
    EXPECT_EQ(digest(answer_.ignored), digest(contacts_of({from, to}))) << strategy->name;
    session.step({to, to}, nullptr, answer_);
    EXPECT_EQ(answer_.ignored_pairs, crossings_of(to)) << strategy->name;
    EXPECT_FALSE(answer_.starts_embedded);
  }
}

TEST_F(SessionTest, IsAsItWasAfterPositionsThatAreNotFinite) {
  Session session = this->session(kDrvbcFastComplete, {.check_finite = true});
  const std::vector<Vec3> from = pose(4), to = pose(2.5);
  std::vector<Vec3> broken = to;
  broken.back().z() = std::nan("");
  session.step({from, from}, nullptr, answer_);
  EXPECT_THROW(session.step({from, broken}, nullptr, answer_), InputError);
  EXPECT_THROW(session.step({broken, to}, nullptr, answer_), InputError);
  session.step({from, to}, nullptr, answer_);
  EXPECT_TRUE(answer_.starts_embedded);
  EXPECT_TRUE(answer_.found.contacts.empty());
}

TEST_F(SessionTest, SaysNothingOfStartsThatItIsToIgnore) {
  Session session = this->session(kDrvbcFastComplete, {.ignore_starts = true});
  const std::vector<Vec3> from = pose(1.2), to = pose(1.5);
  session.step({from, to}, nullptr, answer_);
  EXPECT_TRUE(answer_.starts_embedded);
  EXPECT_TRUE(answer_.start.pairs.empty());
  EXPECT_EQ(digest(answer_.found), digest(contacts_of({from, to})));
}

}  // namespace
}  // namespace cscd
