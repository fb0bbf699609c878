#include "scenes/shape/surface_details.h"

#include <cmath>
#include <gtest/gtest.h>

#include "core/base/test_refusal.h"
#include "core/mesh/test_shapes.h"

namespace cscd::scenes {
namespace {

Shape plain_tube() {
  const test::Shape given = test::uneven_tube(24, 40, 10, [](double) { return 1.0; });
  Shape shape;
  shape.positions = given.positions;
  const TriangleMesh mesh = given.mesh();
  shape.triangles.assign(mesh.triangles().begin(), mesh.triangles().end());
  return shape;
}

TEST(SurfaceDetails, RaiseAndDentWithinTheirReachAlone) {
  const Shape before = plain_tube();
  for (const double height : {0.3, -0.3}) {
    Shape shape = before;
    const SurfaceDetail detail{{5, 1, 0}, {1, 0.8, 0.8}, height, 0, Vec3::Zero()};
    add_details(std::span(&detail, 1), shape);
    std::size_t moved = 0;
    for (std::size_t v = 0; v < shape.positions.size(); ++v) {
      const Vec3 off = before.positions[v] - detail.at, by = shape.positions[v] - before.positions[v];
      EXPECT_EQ(by.norm() > 0, off.cwiseQuotient(detail.reach).norm() < 1);
      EXPECT_LE(by.norm(), std::abs(height) * (1 + 1e-12));
      if (by.norm() == 0) continue;
      ++moved;
      const Vec3 out = Vec3(0, before.positions[v].y(), before.positions[v].z());
      EXPECT_GT(by.dot(out) * height, 0) << "along the outward normal, or against it";
    }
    EXPECT_GT(moved, 10u);
  }
}

// Mutation: the cosine of the folds is left out.
TEST(SurfaceDetails, FoldsRiseAndFallAcrossTheirDirection) {
  const Shape before = plain_tube();
  Shape shape = before;
  const SurfaceDetail detail{{5, 0, 0}, {4, 9, 9}, 0.1, 2, Vec3::UnitX()};
  add_details(std::span(&detail, 1), shape);
  for (std::size_t v = 0; v < shape.positions.size(); ++v) {
    const Vec3& x = before.positions[v];
    const double off = std::abs(x.x() - 5), radius = std::hypot(x.y(), x.z());
    if (off > 3 || radius < 0.9) continue;
    const double rise = std::hypot(shape.positions[v].y(), shape.positions[v].z()) - radius;
    const double phase = off - 2 * std::floor(off / 2);  // folds stand at 0 and 2, furrows at 1
    if (phase < 0.4 || phase > 1.6) {
      EXPECT_GT(rise, 0);
    } else if (phase > 0.6 && phase < 1.4) {
      EXPECT_LT(rise, 0);
    }
  }
}

// A flap has one height up to its rim. It leans along x, so that its edge hangs over the surface beside it.
// Mutation: the lean is left out.
TEST(SurfaceDetails, LeanOverTheSurfaceBesideThem) {
  const Shape before = plain_tube();
  Shape shape = before;
  SurfaceDetail detail{{5, 0, 0}, {2, 9, 9}, 0.3, 0, Vec3::Zero()};
  detail.rim = 0.25;
  detail.lean = Vec3(2, 0, 0);
  add_details(std::span(&detail, 1), shape);
  for (std::size_t v = 0; v < shape.positions.size(); ++v) {
    const Vec3& x = before.positions[v];
    const double off = std::hypot((x.x() - 5) / 2, x.y() / 9, x.z() / 9);
    if (std::hypot(x.y(), x.z()) < 0.9) continue;
    const Vec3 by = shape.positions[v] - x;
    const double rise = std::hypot(by.y(), by.z());
    EXPECT_NEAR(by.x(), 2 * rise, 1e-9);
    EXPECT_EQ(rise > 0.3 - 1e-9, off <= 0.75) << "at full height up to the rim";
  }
  std::size_t beneath = 0;
  for (const Triangle& t : shape.triangles) {
    const Vec3 &a = shape.positions[+t[0]], &b = shape.positions[+t[1]], &c = shape.positions[+t[2]];
    const Vec3 middle = (a + b + c) / 3;
    beneath += std::hypot(middle.y(), middle.z()) > 0.9 &&
               (b - a).cross(c - a).dot(Vec3(0, middle.y(), middle.z())) < 0;
  }
  EXPECT_GT(beneath, 10u) << "triangles that face the tube's axis";
}

TEST(SurfaceDetails, AreReadAndMirrored) {
  const Parameters one("here", {{"at", std::vector<double>{1, 2, 3}},
                                {"reach", std::vector<double>{1, 1, 2}},
                                {"height", -0.5},
                                {"wave_length", 4.0},
                                {"across", std::vector<double>{2, 0, 0}},
                                {"lean", std::vector<double>{3, 4, 5}},
                                {"rim", 0.5},
                                {"mirrored", 1.0}});
  const std::vector<SurfaceDetail> details = read_details(std::span(&one, 1));
  ASSERT_EQ(details.size(), 2u);
  EXPECT_EQ(details[0].at, Vec3(1, 2, 3));
  EXPECT_EQ(details[1].at, Vec3(-1, 2, 3));
  EXPECT_EQ(details[0].across, Vec3(1, 0, 0));
  EXPECT_EQ(details[1].across, Vec3(-1, 0, 0));
  EXPECT_EQ(details[1].height, -0.5);
  EXPECT_EQ(details[0].lean, Vec3(3, 4, 5));
  EXPECT_EQ(details[1].lean, Vec3(-3, 4, 5));
  EXPECT_EQ(details[1].rim, 0.5);
}

TEST(SurfaceDetails, RefuseWhatIsNoPlace) {
  const auto refusal = [](const std::string& name, Parameters::Value value) -> std::string {
    Parameters p(
        "here",
        {{"at", std::vector<double>{1, 2, 3}}, {"reach", std::vector<double>{1, 1, 2}}, {"height", 0.5}});
    p = p.with(name, std::move(value));
    return test::refusal([&] {
      const Parameters whole = checked(p, detail_rows());
      read_details(std::span(&whole, 1));
    });
  };
  EXPECT_EQ(refusal("height", 1.0), "");
  EXPECT_EQ(refusal("reach", std::vector<double>{1, 0, 1}),
            "here: parameter reach must be positive along x, y and z");
  EXPECT_EQ(refusal("wave_length", 2.0),
            "here: folds need both wave_length and a direction across that is not zero");
  EXPECT_EQ(refusal("across", std::vector<double>{1, 0, 0}),
            "here: folds need both wave_length and a direction across that is not zero");
}

}  // namespace
}  // namespace cscd::scenes
