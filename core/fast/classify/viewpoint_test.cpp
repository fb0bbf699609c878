#include "core/fast/classify/viewpoint.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "core/fast/classify/test_patches.h"

namespace cscd::fast {
namespace {

// A viewpoint stands where double precision places its observer. An observer that stands off its vertices
// does so by the same at both ends. Mutations: an axis or an end is taken for another; the end of the
// interval has an offset of its own.
TEST(Viewpoint, StandsWhereItsObserverIs) {
  int stand_off = 0;
  for (const test::Patches& body : test::patches()) {
    FollowingPoint point;
    for (int i = 0; i < 5; ++i) point.add(VertexId{7 * i + 1}, i == 0 ? 0.6F : 0.1F);
    for (const float height : {0.0F, -0.75F}) {
      point.stand_off(height);
      stand_off += point.stands_off();
      const Viewpoint viewpoint = placed(point, body.local.records());
      std::vector<Vec3> corners;
      for (const VertexId v : point.vertices()) corners.push_back((body.start[+v] - body.shift) / body.unit);
      const Vec3 offset = point.offset(corners);
      for (int end = 0; end < 2; ++end) {
        Vec3 expected = offset;
        for (std::size_t i = 0; i < 5; ++i) {
          const auto& positions = end == 0 ? body.start : body.end;
          const Vec3 at = (positions[+point.vertices()[i]] - body.shift) / body.unit;
          expected += static_cast<double>(point.weights()[i]) * at;
        }
        for (int k = 0; k < 3; ++k)
          EXPECT_NEAR(static_cast<double>(viewpoint.at[end][k]), expected[k], 1e-5) << end << " " << k;
      }
    }
  }
  EXPECT_EQ(stand_off, 4);
}

// The reach is more than the sum of the largest coordinates of a vertex and of the viewpoint, and twice the
// error of a vertex. Mutations: only one end or one axis counts; the error or the room for roundings is left
// out.
TEST(Viewpoint, RuleErrorBoundReachIsMoreThanTheWayToAnyVertex) {
  for (const float error : {0x1p-24F, 0x1p-20F, 64.0F})
    for (std::size_t end = 0; end < 2; ++end)
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (const float coordinate : {0.0F, -3.0F, 1e6F}) {
          Viewpoint viewpoint{};
          viewpoint.at[end][axis] = coordinate;
          const double farthest =
              0x1p24 * static_cast<double>(error) + std::abs(static_cast<double>(coordinate));
          const auto reach = static_cast<double>(reach_of(viewpoint, error));
          EXPECT_GT(reach, farthest * (1 + 0x1p-20) + 2 * static_cast<double>(error));
          EXPECT_LT(reach, farthest * 1.001);
        }
}

}  // namespace
}  // namespace cscd::fast
