#include "scenes/shape/box.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "scenes/shape/test_shapes.h"

namespace cscd::scenes {
namespace {

TEST(Box, HasThePapersCounts) {
  const Shape shape = box({});
  EXPECT_EQ(shape.positions.size(), 12546u);
  EXPECT_EQ(shape.triangles.size(), 25088u);
}

TEST(Box, IsWellFormedAndFillsItsSize) {
  for (const std::array<int, 3>& cells :
       {std::array{1, 1, 1}, std::array{2, 3, 4}, std::array{1, 5, 2}, BoxParameters{}.cells}) {
    BoxParameters p;
    p.cells = cells;
    p.size = Vec3(2, 3, 7);
    p.bones = 3;
    const Shape shape = box(p);
    expect_well_formed(shape);
    EXPECT_EQ(shape.positions.size(), shape.triangles.size() / 2 + 2);
    EXPECT_NEAR(volume(shape), 42, 1e-9);
  }
}

TEST(Box, HasAChainOfBonesFromBottomToTop) {
  const Shape shape = box({});
  EXPECT_EQ(shape.rig.reference.front().head, Vec3::Zero());
  EXPECT_EQ(shape.rig.reference.back().tail, Vec3(0, 0, 10.25));
  EXPECT_EQ(shape.bone_names[7], "bone_7");
  EXPECT_LT(steepest_weight(shape), 0.3);
}

TEST(Box, RefusesWhatIsNoBox) {
  const auto refused = [](auto change) {
    BoxParameters p;
    change(p);
    EXPECT_THROW(box(p), InputError);
  };
  refused([](BoxParameters& p) { p.cells[1] = 0; });
  refused([](BoxParameters& p) { p.cells = {20000, 20000, 20000}; });
  refused([](BoxParameters& p) { p.size.z() = 0; });
  refused([](BoxParameters& p) { p.bones = 0; });
}

}  // namespace
}  // namespace cscd::scenes
