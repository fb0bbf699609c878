#include "core/fast/descend/patch_descent.h"

#include <gtest/gtest.h>

namespace cscd::fast {
namespace {

// Whatever was asked for before; and of two of which the first is asked for twice, both are still there.
TEST(PatchDescent, WhatIsMadeOnDemandIsOfThePatch) {
  constexpr std::size_t kPatches = 300;
  OnDemand<std::size_t> squares(kPatches);
  std::size_t made = 0;
  const auto square = [&](std::size_t p) -> const std::size_t& {
    return squares.of(p, [&] {
      ++made;
      return p * p;
    });
  };
  for (int interval = 0; interval < 3; ++interval) {
    squares.start_interval();
    made = 0;
    for (std::size_t p = 0; p < kPatches; ++p) EXPECT_EQ(square(p), p * p);
    EXPECT_EQ(made, kPatches);
    for (std::size_t p = kPatches; p-- > 0;) EXPECT_EQ(square(p), p * p);
    EXPECT_GT(made, kPatches);      // few are kept
    EXPECT_LT(made, 2 * kPatches);  // the last are
    for (std::size_t p = 0; p < kPatches; ++p) {
      const std::size_t q = (7 * p + 3) % kPatches;
      square(p);
      const std::size_t &second = square(q), &first = square(p);
      EXPECT_EQ(first, p * p);
      EXPECT_EQ(second, q * q);
    }
  }
}

TEST(PatchDescent, NothingMadeOutlastsItsInterval) {
  OnDemand<int> numbers(2);
  EXPECT_EQ(numbers.of(0, [] { return 1; }), 1);
  EXPECT_EQ(numbers.of(0, [] { return 2; }), 1);
  numbers.start_interval();
  EXPECT_EQ(numbers.of(0, [] { return 3; }), 3);
}

}  // namespace
}  // namespace cscd::fast
