#include "core/session/surface_motion.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <random>

namespace cscd {
namespace {

class SurfaceMotionTest : public testing::Test {
 protected:
  Vec3 draw() { return Vec3(some_(random_), some_(random_), some_(random_)); }
  std::vector<Vec3> points(std::size_t count) {
    std::vector<Vec3> out(count);
    for (Vec3& p : out) p = draw();
    return out;
  }
  // The points turned about an axis through the origin and shifted, each up to `noise` astray.
  std::vector<Vec3> moved(const std::vector<Vec3>& from, double angle, const Vec3& axis, const Vec3& shift,
                          double noise) {
    std::vector<Vec3> out;
    for (const Vec3& p : from)
      out.push_back(Eigen::AngleAxisd(angle, axis) * p + shift + noise * draw().normalized());
    return out;
  }
  static SurfaceMotion motion(const std::vector<Vec3>& from, const std::vector<Vec3>& start,
                              const std::vector<Vec3>& end, double enough) {
    return surface_motion({start, end}, from, sampled_vertices(from.size()), enough);
  }

  std::mt19937 random_{3};
  std::uniform_real_distribution<double> some_{-1, 1};
};

// On straight lines from one turn to another, points come nearer to each other than they were in the pose, by
// the noise and, half-way through, by the cosine of half the angle. Mutations: `kept` is 1; the deviation of
// one end alone; half of it.
TEST_F(SurfaceMotionTest, SaysHowNearPointsMayCome) {
  double tightest = 1;
  for (int n = 0; n < 300; ++n) {
    SCOPED_TRACE(n);
    const std::vector<Vec3> from = points(3 + n % 60);
    const Vec3 axis = draw().normalized();
    const double angle = n % 3 == 0 ? 0 : 1.2 * some_(random_), noise = n % 2 == 0 ? 0 : 0.02;
    const auto start = moved(from, n % 4 == 0 ? -angle : 0, axis, draw(), n % 5 == 0 ? 0 : noise);
    const auto end = moved(from, angle, axis, draw(), n % 7 == 0 ? 0 : noise);
    const SurfaceMotion all = motion(from, start, end, 1);
    ASSERT_LE(all.most, 1);
    for (std::size_t a = 0; a < from.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
          const double before = (from[a] - from[b]).norm();
          const double at = ((1 - t) * (start[a] - start[b]) + t * (end[a] - end[b])).norm();
          // Within `reach` of the distance that is left is every pair that comes so near.
          ASSERT_LE(before, all.reach(at) * (1 + 1e-12));
          tightest = std::min(tightest, all.reach(at) / before - 1);
        }
  }
  EXPECT_LT(tightest, 1e-3);
}

// A surface that turns keeps its shape, wherever its middle is.
TEST_F(SurfaceMotionTest, LeavesOutRotationsAndShifts) {
  const std::vector<Vec3> from = points(200);
  for (const double far : {0.0, 1e6}) {
    const auto start = moved(from, 2, Vec3::UnitZ(), Vec3(far, 0, 0), 0);
    const auto end = moved(from, 2.01, Vec3::UnitZ(), Vec3(far, 0, 1), 0);
    const SurfaceMotion all = motion(from, start, end, 1e-6);
    EXPECT_LT(all.most, far > 0 ? 1e-8 : 1e-12);
    EXPECT_GT(all.most, 0);
    EXPECT_NEAR(all.kept, std::sqrt(std::cos(0.01)), 1e-7);
  }
}

// Where shifts are enough, none turns, and distances are kept whole.
TEST_F(SurfaceMotionTest, TakesShiftsWhereTheyAreEnough) {
  const std::vector<Vec3> from = points(200);
  const auto start = moved(from, 0, Vec3::UnitZ(), Vec3(1, 0, 0), 0.1);
  const auto end = moved(from, 0, Vec3::UnitZ(), Vec3(1, 0, 1), 0.1);
  const SurfaceMotion all = motion(from, start, end, 0.2);
  EXPECT_EQ(all.kept, 1);
  EXPECT_GT(all.most, 0.099);
  EXPECT_LT(all.most, 0.2);
}

// What moves farther than was asked for needs a reach without end.
TEST_F(SurfaceMotionTest, SaysNothingOfWhatMovesFar) {
  const std::vector<Vec3> from = points(200), to = points(200);
  EXPECT_EQ(motion(from, from, to, 0.5).reach(0), std::numeric_limits<double>::infinity());
  std::vector<Vec3> one = from;
  one[101] += Vec3(1, 0, 0);  // which is not in the sample
  EXPECT_EQ(motion(from, from, one, 0.3).reach(0), std::numeric_limits<double>::infinity());
  EXPECT_LT(motion(from, from, one, 0.7).reach(0), 1.2);
  std::vector<Vec3> huge = from;
  for (Vec3& p : huge) p *= 1e300;
  EXPECT_EQ(motion(huge, huge, from, 0.5).reach(0), std::numeric_limits<double>::infinity());
}

// One vertex, or points on a line, have no best rotation.
TEST_F(SurfaceMotionTest, TakesFewPointsAndLines) {
  for (const std::size_t count : {1, 2, 3, 10}) {
    std::vector<Vec3> from(count), to(count);
    for (std::size_t i = 0; i < count; ++i)
      from[i] = Vec3(static_cast<double>(i), 0, 0), to[i] = Vec3(0, static_cast<double>(i), 5);
    EXPECT_LT(motion(from, from, to, 1e-9).most, 1e-12) << count;
  }
}

}  // namespace
}  // namespace cscd
