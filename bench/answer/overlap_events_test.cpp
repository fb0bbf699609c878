#include "bench/answer/overlap_events.h"

#include <gtest/gtest.h>

#include "bench/inputs/test_inputs.h"
#include "bench/strategies/catalogue.h"
#include "core/elementary/catalogue.h"

namespace cscd::bench {
namespace {

// Balls of radius 1 in one row. Frame by frame, the second ball lies at the given distance from the first.
Input balls_at(std::initializer_list<double> distances) {
  const test::Shape ball = test::icosphere(2);
  const test::Shape balls = test::together(ball, ball);
  std::vector<std::vector<Vec3>> frames;
  for (const double distance : distances)
    frames.push_back(moved_part(balls, ball.positions.size(), {distance, 0.01, 0.02}));
  return input_of(balls, frames);
}

std::vector<OverlapEvent> events_of(Input& input, std::size_t& contacts_within, bool keep_rest = false) {
  const SurfaceNames names(input);
  Answerer answerer(input, complete_reference(), elementary_test_named("exact"),
                    {.keep_rest_crossings = keep_rest});
  OverlapEvents events(input, names, answerer);
  contacts_within = 0;
  for (std::size_t i = 0; i < input.clip->interval_count(); ++i) {
    IntervalAnswer answer = answerer.answer(i, input.clip->load(i));
    const OverlapEvents::Here here = events.add(answer, input.clip->load(i).motion.start(), {});
    EXPECT_EQ(answer.event_of_contact.size(), answer.found.contacts.size());
    for (const std::size_t event : answer.event_of_contact) contacts_within += event != OverlapEvents::kNone;
  }
  return events.all();
}

// A ball dips into the other twice. What goes in belongs to no event yet; what comes out does.
TEST(OverlapEvents, BeginAreDeepestAndEnd) {
  Input input = balls_at({2.5, 1.9, 1.6, 1.8, 2.5, 2.4, 1.7, 2.5, 2.5});
  std::size_t within = 0;
  const std::vector<OverlapEvent> events = events_of(input, within);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(std::tuple(events[0].first, events[0].deepest, events[0].last), std::tuple(1u, 2u, 3u));
  EXPECT_EQ(std::tuple(events[1].first, events[1].deepest, events[1].last), std::tuple(6u, 6u, 6u));
  // The tip of one ball lies as deep in the other as the balls overlap, up to the balls' facets.
  EXPECT_NEAR(events[0].depth.lower, 0.4, 0.08);
  EXPECT_NEAR(events[1].depth.lower, 0.3, 0.08);
  EXPECT_GE(events[0].depth.upper, 0.4);
  EXPECT_GT(events[0].depth.out.normalized().cwiseAbs().x(), 0.9);
  ASSERT_EQ(events[0].depth_at.size(), 3u);
  EXPECT_EQ(events[0].depth_at[1], events[0].depth.lower);
  EXPECT_GT(events[0].depth_at[2], events[0].depth_at[0]);
  EXPECT_EQ(events[0].side, CrossingRegion::Side::behind);
  EXPECT_FALSE(events[0].other_is_open);
  EXPECT_EQ(events[0].curves, 1u);
  EXPECT_EQ(within, events[0].contacts + events[1].contacts);
  EXPECT_GT(events[0].contacts, 0u);
}

TEST(OverlapEvents, AreNoneOfWhatCrossesAtRest) {
  Input input = balls_at({1.6, 1.61, 1.62, 1.62});
  std::size_t within = 0;
  EXPECT_TRUE(events_of(input, within).empty());
  EXPECT_EQ(events_of(input, within, true).size(), 1u);
}

// An edge of a bar lies half a unit deep in a plate, and no vertex of either lies in the other. Mutations:
// the side is that of the first curve; what touches a wall from within is no event.
TEST(OverlapEvents, NameWhatLiesInWhatInEitherOrder) {
  const test::Shape plate = test::box({-10, 0, 0}, {10, 4, 4});
  const test::Shape bar = {
      {{0, -1, 3.5}, {3, -1, 6.5}, {-3, -1, 6.5}, {0, 5, 3.5}, {3, 5, 6.5}, {-3, 5, 6.5}},
      {test::corners(0, 2, 1), test::corners(3, 4, 5), test::corners(0, 1, 4), test::corners(0, 4, 3),
       test::corners(1, 2, 5), test::corners(1, 5, 4), test::corners(2, 0, 3), test::corners(2, 3, 5)}};
  const test::Shape peg = test::box({0, 1, 1}, {2, 3, 3});  // stands on a wall of the plate from within
  const test::Shape room = test::box({0, 0, 0}, {4, 4, 4});
  for (const auto& [inner, outer, depth] : {std::tuple(bar, plate, 0.5), std::tuple(peg, room, 2.0)})
    for (const bool inner_first : {false, true}) {
      const test::Shape both = inner_first ? test::together(inner, outer) : test::together(outer, inner);
      Input input = input_of(both, {both.positions, both.positions});
      std::size_t within = 0;
      const std::vector<OverlapEvent> events = events_of(input, within, true);
      ASSERT_EQ(events.size(), 1u);
      EXPECT_EQ(events[0].names.first.back(), inner_first ? '0' : '1') << events[0].names.first;
      EXPECT_EQ(events[0].names.second.back(), inner_first ? '1' : '0') << events[0].names.second;
      EXPECT_NEAR(events[0].depth.lower, depth, 1e-12);
      EXPECT_TRUE(events[0].crosses);
    }
}

}  // namespace
}  // namespace cscd::bench
