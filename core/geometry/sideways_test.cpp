#include "core/geometry/sideways.h"

#include <gtest/gtest.h>

namespace cscd {
namespace {

// Whether features are apart by the points that are seen from a fourth point, which is at rest. The points
// lie in the plane of two axes, and the third axis is `across`.
bool apart(const double (&point)[3][2][2], int across, bool vertex_face) {
  SeenFromFirst<double> p{};
  for (int k = 0; k < 3; ++k)
    for (int end = 0; end < 2; ++end)
      for (int i = 0; i < 2; ++i) p[k][end][(across + 1 + i) % 3] = point[k][end][i];
  return apart_sideways(p, vertex_face);
}

// Features lie in one plane all the time, and one of them moves there. Mutations: the normal of the plane is
// not computed; an axis is taken for another; one end of the interval is left out.
TEST(Sideways, FeaturesInOnePlaneAreApartWhereTheyStayOnOneSide) {
  for (const int across : {0, 1, 2}) {
    // The corners of a face are the fourth point, (4, 0) and (0, 4). The vertex is the last of the points.
    EXPECT_TRUE(apart({{{4, 0}, {4, 0}}, {{0, 4}, {0, 4}}, {{3, 3}, {9, 2}}}, across, true));
    EXPECT_TRUE(apart({{{4, 0}, {4, 0}}, {{0, 4}, {0, 4}}, {{-1, 1}, {-2, 3}}}, across, true));
    EXPECT_FALSE(apart({{{4, 0}, {4, 0}}, {{0, 4}, {0, 4}}, {{3, 3}, {1, 1}}}, across, true));
    EXPECT_FALSE(apart({{{4, 0}, {4, 0}}, {{0, 4}, {0, 4}}, {{1, 1}, {3, 3}}}, across, true));
    // The first edge goes from the fourth point to (4, 0).
    EXPECT_TRUE(apart({{{4, 0}, {4, 0}}, {{1, 1}, {1, 1}}, {{3, 2}, {2, 3}}}, across, false));
    EXPECT_FALSE(apart({{{4, 0}, {4, 0}}, {{1, 1}, {1, 1}}, {{3, 2}, {2, -3}}}, across, false));
    EXPECT_FALSE(apart({{{4, 0}, {4, 0}}, {{1, 1}, {1, 1}}, {{2, -3}, {3, 2}}}, across, false));
  }
}

// Features that touch are not apart, and neither are those whose distance is less than rounding. Mutation:
// the bound on the rounding is left out.
TEST(Sideways, RuleErrorBoundFeaturesThatTouchAreNotApart) {
  for (const int across : {0, 1, 2})
    for (const double off : {0.0, 0x1p-53, 0x1p-52}) {
      EXPECT_FALSE(apart({{{4, 0}, {4, 0}}, {{0, 4}, {0, 4}}, {{-off, 1}, {-off, 2}}}, across, true));
      EXPECT_FALSE(apart({{{4, 0}, {4, 0}}, {{1, off}, {1, off}}, {{3, 2}, {2, 3}}}, across, false));
      EXPECT_TRUE(apart({{{4, 0}, {4, 0}}, {{0, 4}, {0, 4}}, {{-0x1p-40, 1}, {-0x1p-40, 2}}}, across, true));
    }
}

}  // namespace
}  // namespace cscd
