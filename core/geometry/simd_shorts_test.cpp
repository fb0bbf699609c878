#include "core/geometry/simd_shorts.h"

#include <gtest/gtest.h>

namespace cscd {
namespace {

// The numbers of a pair stand side by side, the first one first, with their signs. Mutations: one of the two
// is lost; they are exchanged; the sign of the first one runs over into the second.
TEST(Shorts32, RoundedPairsHoldBothNumbers) {
  Float16 a{}, b{};
  for (std::size_t l = 0; l < kLanes16; ++l) {
    a[l] = 1000.3F * static_cast<float>(l) - 8000;
    b[l] = 7000 - 900.3F * static_cast<float>(l);
  }
  for (const float scale : {1.0F, 0.25F, 4.0F}) {
    const Short32 pairs = rounded_pairs(a, b, scale);
    for (std::size_t l = 0; l < kLanes16; ++l) {
      EXPECT_NEAR(static_cast<float>(pairs[2 * l]), scale * a[l], 0.51F) << l;
      EXPECT_NEAR(static_cast<float>(pairs[2 * l + 1]), scale * b[l], 0.51F) << l;
    }
  }
}

}  // namespace
}  // namespace cscd
