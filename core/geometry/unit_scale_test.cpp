#include "core/geometry/unit_scale.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <new>
#include <random>

namespace cscd {
namespace {

// Mutation: Eigen's stableNorm(), where registers hold four numbers.
TEST(UnitScale, LengthsDoNotDependOnWhereAVectorLies) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 v(number(random), number(random), number(random));
    alignas(64) std::array<double, 11> memory{};
    for (std::size_t at = 0; at < 8; ++at)
      EXPECT_EQ(stable_length(*new (memory.data() + at) Vec3(v)), stable_length(v)) << at;
    EXPECT_NEAR(stable_length(v), v.norm(), 1e-15);
  }
}

TEST(UnitScale, LengthsNeitherOverflowNorVanish) {
  for (const double size : {0x1p-1074, 0x1p-600, 0x1p600, 0x1p1022})
    EXPECT_NEAR(stable_length(size * Vec3(0, 1, 1)) / size, std::sqrt(2.0), size < 0x1p-1000 ? 1 : 1e-12)
        << size;
  EXPECT_EQ(stable_length(Vec3::Zero()), 0);
}

}  // namespace
}  // namespace cscd
