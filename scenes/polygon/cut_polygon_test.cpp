#include "scenes/polygon/cut_polygon.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

namespace cscd::scenes {
namespace {

struct Case {
  const char* name;
  std::vector<Vec3> corners;
  double area;  // that the polygon encloses
};

// Areas of the triangles, signed by the direction of `up`, and without signs.
std::pair<double, double> areas(const std::vector<Vec3>& positions,
                                const std::vector<std::array<std::int32_t, 3>>& triangles, const Vec3& up) {
  double sum = 0, size = 0;
  for (const auto& t : triangles) {
    const auto at = [&](std::size_t k) { return positions[static_cast<std::size_t>(t[k])]; };
    const Vec3 normal = (at(1) - at(0)).cross(at(2) - at(0)) / 2;
    sum += normal.dot(up);
    size += normal.norm();
  }
  return {sum, size};
}

std::vector<std::int32_t> all_of(const std::vector<Vec3>& positions) {
  std::vector<std::int32_t> corners(positions.size());
  std::iota(corners.begin(), corners.end(), 0);
  return corners;
}

class Polygons : public testing::TestWithParam<Case> {};

// Whichever corner comes first, whichever way the polygon faces, and however it lies in space: the triangles
// cover its inside once. Mutations: fans; the longer way for polygons that touch themselves left out.
TEST_P(Polygons, AreCoveredOnce) {
  for (std::size_t first = 0; first < GetParam().corners.size(); ++first)
    for (const bool back : {false, true}) {
      std::vector<Vec3> positions = GetParam().corners;
      std::rotate(positions.begin(), positions.begin() + static_cast<std::ptrdiff_t>(first), positions.end());
      if (back) std::reverse(positions.begin(), positions.end());
      std::vector<std::array<std::int32_t, 3>> triangles;
      ASSERT_EQ(cut_polygon(all_of(positions), positions, triangles), PolygonCut::good);
      EXPECT_EQ(triangles.size(), positions.size() - 2);
      const auto [sum, size] = areas(positions, triangles, Vec3(0, 0, back ? -1 : 1));
      EXPECT_NEAR(sum, GetParam().area, 1e-9) << "from corner " << first;
      EXPECT_NEAR(size, GetParam().area, 1e-9) << "from corner " << first;

      const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
      for (Vec3& x : positions) x = turn * x;
      triangles.clear();
      EXPECT_NE(cut_polygon(all_of(positions), positions, triangles), PolygonCut::none);
      EXPECT_NEAR(areas(positions, triangles, turn * Vec3(0, 0, 1)).second, GetParam().area, 1e-6);
    }
}

const Case kCases[] = {
    {"dart", {{0, 0, 0}, {2, 1, 0}, {4, 0, 0}, {2, 4, 0}}, 6},
    {"square_with_corners_on_its_sides",
     {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}},
     4},
    {"triangle_with_a_corner_on_a_side", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 2, 0}}, 2},
    {"hook", {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}, 5},
    {"comb",
     {{0, 0, 0},
      {9, 0, 0},
      {9, 5, 0},
      {8, 5, 0},
      {8, 1, 0},
      {7, 1, 0},
      {7, 5, 0},
      {5, 5, 0},
      {5, 1, 0},
      {0, 5, 0}},
     31},
    {"frame",
     {{0, 0, 0},
      {4, 0, 0},
      {4, 4, 0},
      {0, 4, 0},
      {0, 0, 0},
      {1, 1, 0},
      {1, 3, 0},
      {3, 3, 0},
      {3, 1, 0},
      {1, 1, 0}},
     12},
    {"equal_corners", {{0, 0, 0}, {0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {4, 4, 0}, {0, 4, 0}}, 16},
    {"two_triangles_that_touch_in_a_corner",
     {{0, 0, 0}, {4, 0, 0}, {2, 1, 0}, {4, 2, 0}, {0, 2, 0}, {2, 1, 0}},
     4},
    {"square_with_a_tail", {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {4, 6, 0}, {4, 4, 0}, {0, 4, 0}}, 16},
    {"two_squares_that_touch_in_a_corner_of_five",
     {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {4, 2, 0}, {4, 4, 0}, {2, 4, 0}, {2, 2, 0}, {0, 2, 0}},
     8},
    {"square_with_two_holes",
     {{0, 0, 0},
      {9, 0, 0},
      {9, 4, 0},
      {0, 4, 0},
      {0, 0, 0},
      {1, 1, 0},
      {1, 3, 0},
      {3, 3, 0},
      {3, 1, 0},
      {5, 1, 0},
      {5, 3, 0},
      {7, 3, 0},
      {7, 1, 0},
      {5, 1, 0},
      {3, 1, 0},
      {1, 1, 0}},
     28},
    {"nothing", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}, {3, 0, 0}}, 0},
};
INSTANTIATE_TEST_SUITE_P(Cut, Polygons, testing::ValuesIn(kCases),
                         [](const auto& info) { return std::string(info.param.name); });

// A notch stays a notch where the polygon is not flat.
TEST(Polygons, NeedNotBeFlat) {
  const std::vector<Vec3> hook = {{0, 0, 0}, {3, 0, 0.2}, {3, 1, 0}, {1, 1, 0.1}, {1, 3, 0}, {0, 3, 0.2}};
  std::vector<std::array<std::int32_t, 3>> triangles;
  ASSERT_EQ(cut_polygon(all_of(hook), hook, triangles), PolygonCut::good);
  const auto [sum, size] = areas(hook, triangles, Vec3(0, 0, 1));
  EXPECT_NEAR(sum, 5, 1e-9);
  EXPECT_NEAR(size, 5, 0.2);
}

// Mutation: products of coordinates are taken as they are, and vanish or overflow.
TEST(Polygons, AreCutAlikeInAllSizes) {
  for (const Case& shape : kCases) {
    std::vector<std::array<std::int32_t, 3>> right;
    ASSERT_EQ(cut_polygon(all_of(shape.corners), shape.corners, right), PolygonCut::good);
    EXPECT_EQ(has_area(all_of(shape.corners), shape.corners), shape.area > 0) << shape.name;
    for (const int exponent : {-1070, -540, -300, 300, 540, 1000}) {
      std::vector<Vec3> positions = shape.corners;
      for (Vec3& x : positions)
        for (double& coordinate : x) coordinate = std::ldexp(coordinate, exponent);
      std::vector<std::array<std::int32_t, 3>> triangles;
      EXPECT_EQ(cut_polygon(all_of(positions), positions, triangles), PolygonCut::good);
      EXPECT_EQ(triangles, right) << shape.name << " times 2^" << exponent;
      EXPECT_EQ(has_area(all_of(positions), positions), shape.area > 0) << shape.name;
    }
  }
}

TEST(Polygons, ThatOverlapThemselvesAreNamed) {
  const std::vector<Vec3> bow = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 2, 0}},
                          even = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},
                          eight = {{0, 0, 0}, {2, 2, 0}, {3, 1, 0}, {2, 0, 0}, {0, 2, 0}, {-1, 1, 0}},
                          star = {{0, 10, 0}, {6, -8, 0}, {-9, 3, 0}, {9, 3, 0}, {-6, -8, 0}};
  for (const std::vector<Vec3>& corners : {bow, even, eight, star}) {
    std::vector<std::array<std::int32_t, 3>> triangles;
    EXPECT_EQ(cut_polygon(all_of(corners), corners, triangles), PolygonCut::overlapping);
    EXPECT_EQ(triangles.size(), corners.size() - 2);
  }
}

}  // namespace
}  // namespace cscd::scenes
