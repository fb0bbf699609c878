// Checks the properties that the rope has beyond those of every scene (scene_files_test.cpp).

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "scenes/catalog/scene_cache.h"

namespace cscd::scenes {
namespace {

constexpr std::size_t kRings = 865, kSides = 28;
// Rings with numbers this far apart are more than three diameters apart along the rope.
constexpr std::size_t kFar = 28;

// A ball that holds all vertices of one ring.
struct Ball {
  Vec3 centre;
  double radius;
};

class Rope : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::unique_ptr<ClipSource> source = open_scene(load_scene("rope"));
    clip_ = std::make_unique<Clip>(source->header());
    copy_frames(*source, *clip_);
  }
  static void TearDownTestSuite() { clip_.reset(); }
  static const Clip& clip() { return *clip_; }

  static std::vector<Ball> rings(std::span<const Vec3> positions) {
    std::vector<Ball> balls(kRings, Ball{Vec3::Zero(), 0});
    for (std::size_t ring = 0; ring < kRings; ++ring) {
      const auto vertices = positions.subspan(ring * kSides, kSides);
      for (const Vec3& vertex : vertices) balls[ring].centre += vertex / kSides;
      for (const Vec3& vertex : vertices)
        balls[ring].radius = std::max(balls[ring].radius, (vertex - balls[ring].centre).norm());
    }
    return balls;
  }

 private:
  static inline std::unique_ptr<Clip> clip_;
};

// Returns the closest distance of two segments, to within rounding.
double distance(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1) {
  const Vec3 p = p1 - p0, q = q1 - q0, r = p0 - q0;
  const double a = p.squaredNorm(), b = p.dot(q), e = q.squaredNorm(), c = p.dot(r), f = q.dot(r);
  const double determinant = a * e - b * b;
  double least = 1e300;
  const auto look = [&](double s, double t) {
    least = std::min(least, (r + std::clamp(s, 0.0, 1.0) * p - std::clamp(t, 0.0, 1.0) * q).norm());
  };
  if (determinant > 0) {
    const double s = (b * f - c * e) / determinant, t = (a * f - b * c) / determinant;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) look(s, t);
  }
  for (const double end : {0.0, 1.0}) {
    look(end, (b * end + f) / e);
    look((b * end - c) / a, end);
  }
  return least;
}

// The surface between two neighbouring rings. It lies in the convex hull of the rings' balls, and so within
// the larger radius of the segment between their centres. While vertices move in straight lines, so do the
// centres, and no radius exceeds the larger of its values at both ends. So two stretches stay apart if the
// distance of their moving segments stays above the sum of their radii.
struct Stretch {
  Vec3 start[2], end[2];  // the two centres at t = 0 and t = 1
  double radius;
  Vec3 at(std::size_t i, double t) const { return (1 - t) * start[i] + t * end[i]; }
};

Stretch stretch(const std::vector<Ball>& start, const std::vector<Ball>& end, std::size_t ring) {
  return {{start[ring].centre, start[ring + 1].centre},
          {end[ring].centre, end[ring + 1].centre},
          std::max({start[ring].radius, start[ring + 1].radius, end[ring].radius, end[ring + 1].radius})};
}

// Returns a lower bound of the gap from time t0 to time t1. A positive bound proves that there is a gap.
double gap_over(const Stretch& a, const Stretch& b, double speed, double t0, double t1) {
  const double t = (t0 + t1) / 2;
  const double now = distance(a.at(0, t), a.at(1, t), b.at(0, t), b.at(1, t)) - a.radius - b.radius;
  const double sure = now - speed * (t1 - t0) / 2;
  if (sure > 0.5 * now || t1 - t0 < 1e-3) return sure;
  return std::min(gap_over(a, b, speed, t0, t), gap_over(a, b, speed, t, t1));
}

TEST_F(Rope, NeverTouchesItselfWithinAnInterval) {
  double closest = 1e300;
  std::vector<Ball> start = rings(clip().frame(0).positions);
  for (std::size_t frame = 1; frame < clip().frame_count(); ++frame) {
    const std::vector<Ball> end = rings(clip().frame(frame).positions);
    double fastest = 0;
    for (std::size_t ring = 0; ring < kRings; ++ring)
      fastest = std::max(fastest, (end[ring].centre - start[ring].centre).norm());
    for (std::size_t i = 0; i + 1 < kRings; ++i)
      for (std::size_t j = i + kFar; j + 1 < kRings;) {
        // Centres of neighbouring rings are less than 0.3 apart, so a large distance allows to skip rings.
        const double spare = (start[i].centre - start[j].centre).norm() - 2 * fastest - 2.8;
        if (spare > 0.3) {
          j += static_cast<std::size_t>(spare / 0.3);
          continue;
        }
        const Stretch a = stretch(start, end, i), b = stretch(start, end, j);
        double speed = 0;
        for (const std::size_t k : {0, 1})
          for (const std::size_t l : {0, 1})
            speed = std::max(speed, (a.end[k] - a.start[k] - b.end[l] + b.start[l]).norm());
        const double gap = gap_over(a, b, speed, 0, 1);
        ASSERT_GT(gap, 0) << "interval " << frame - 1 << ", rings " << i << " and " << j;
        closest = std::min(closest, gap);
        ++j;
      }
    start = end;
  }
  EXPECT_LT(closest, 0.2) << "the rope lies against itself";
}

TEST_F(Rope, MovesEnoughToBeAWorkloadAndNotTooFast) {
  double sum = 0, fastest = 0;
  std::size_t moving = 0;
  for (std::size_t i = 0; i < clip().interval_count(); ++i) {
    const Motion motion = clip().interval(i).motion;
    double mean = 0;
    for (std::size_t v = 0; v < motion.vertex_count(); ++v) {
      const double moved = (motion.end()[v] - motion.start()[v]).norm();
      mean += moved / static_cast<double>(motion.vertex_count());
      fastest = std::max(fastest, moved);
    }
    sum += mean;
    moving += mean > 0.1;
  }
  const double mean = sum / static_cast<double>(clip().interval_count());
  EXPECT_GT(mean, 0.1);
  EXPECT_LT(mean, 0.5);
  EXPECT_LT(fastest, 2);
  EXPECT_GT(moving, clip().interval_count() * 3 / 4);
}

TEST_F(Rope, KeepsItsThicknessAndItsBones) {
  const std::vector<Ball> at_rest = rings(clip().frame(0).positions);
  for (std::size_t frame = 0; frame < clip().frame_count(); ++frame) {
    const std::vector<Ball> balls = rings(clip().frame(frame).positions);
    for (std::size_t ring = 8; ring + 8 < kRings; ++ring) {
      const double share = balls[ring].radius / at_rest[ring].radius;
      ASSERT_GT(share, 0.94) << "frame " << frame << ", ring " << ring << ": no candy wrapper";
      ASSERT_LT(share, 1.01) << "frame " << frame << ", ring " << ring;
    }
    for (const Bone& bone : clip().frame(frame).bones)
      ASSERT_NEAR((bone.tail - bone.head).norm(), 1.88, 0.04);
  }
}

}  // namespace
}  // namespace cscd::scenes
