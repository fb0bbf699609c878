#include "bench/harness/interval_choice.h"

#include <gtest/gtest.h>

namespace cscd::bench {
namespace {

using Intervals = std::vector<std::size_t>;

TEST(IntervalChoice, EveryKthIntervalOfARange) {
  EXPECT_EQ(every_kth({3, 10}, 3), (Intervals{3, 6, 9}));
  EXPECT_EQ(every_kth({3, 4}, 5), (Intervals{3}));
}

// Mutations: intervals that are chosen already are added again, or not counted among those with contacts.
TEST(IntervalChoice, AddsAsManyIntervalsWithContactsAsAreMissing) {
  const Intervals chosen = {0, 7, 14};
  EXPECT_EQ(with_contacts(chosen, Intervals{7, 8, 9, 14, 15}, 2), chosen) << "two are there";
  EXPECT_EQ(with_contacts(chosen, Intervals{7, 8, 9, 10}, 2), (Intervals{0, 7, 9, 14}));
  EXPECT_EQ(with_contacts(chosen, Intervals{1, 2, 3, 4}, 2), (Intervals{0, 2, 4, 7, 14}));
  EXPECT_EQ(with_contacts(chosen, Intervals{5}, 3), (Intervals{0, 5, 7, 14})) << "there are no more";
  EXPECT_EQ(with_contacts(chosen, Intervals{5}, 0), chosen);
  EXPECT_EQ(with_contacts(chosen, Intervals{}, 3), chosen);
}

TEST(IntervalChoice, UnitesSetsInOrder) {
  EXPECT_EQ(united(std::vector<Intervals>{{5, 7}, {1, 7, 9}}), (Intervals{1, 5, 7, 9}));
}

}  // namespace
}  // namespace cscd::bench
