#include "core/radial/segmentation.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/mesh/test_shapes.h"
#include "core/radial/atomic_clusters.h"
#include "core/radial/distance_field.h"

namespace cscd::radial {

namespace {

using test::Shape;
using test::straight_chain;

constexpr HeatOptions kFine{40, 0}, kCoarse{10, 3};

std::vector<BoneId> segment(const Shape& shape, const Rig& rig, const HeatOptions& options) {
  return nearest_bone_by_heat(shape.mesh(), shape.positions, rig, options);
}

Rig rig_of(std::vector<Bone> bones) {
  Rig rig;
  rig.parent.assign(bones.size(), BoneId{-1});
  rig.reference = std::move(bones);
  return rig;
}

double centroid_x(const Shape& shape, std::size_t t) {
  const Triangle& c = shape.triangles[t];
  return (shape.positions[+c[0]].x() + shape.positions[+c[1]].x() + shape.positions[+c[2]].x()) / 3;
}

TEST(NearestBoneByHeat, SymmetricDumbBellSplitsAtTheMiddle) {
  const Shape shape =
      test::uneven_tube(14, 40, 4, [](double x) { return 0.3 + 0.5 * std::pow(x / 2 - 1, 2); });
  for (const HeatOptions& options : {kFine, kCoarse}) {
    const std::vector<BoneId> bone = segment(shape, straight_chain(2, {0.3, 0, 0}, {3.7, 0, 0}), options);
    for (std::size_t t = 0; t < bone.size(); ++t)
      EXPECT_EQ(bone[t], BoneId{centroid_x(shape, t) > 2 ? 1 : 0}) << t;
  }
}

TEST(NearestBoneByHeat, TubeFallsIntoOneBandABone) {
  const Shape shape = test::capped_tube(10, 90, 0.4, 9);
  const TriangleMesh mesh = shape.mesh();
  for (const int bones : {1, 2, 5, 9})
    for (const HeatOptions& options : {kFine, kCoarse}) {
      const std::vector<BoneId> bone = segment(shape, straight_chain(bones, {0, 0, 0}, {9, 0, 0}), options);
      std::vector<double> low(static_cast<std::size_t>(bones), 1e9),
          high(static_cast<std::size_t>(bones), -1e9);
      for (std::size_t t = 0; t < bone.size(); ++t) {
        ASSERT_LT(+bone[t], static_cast<std::size_t>(bones));
        low[+bone[t]] = std::min(low[+bone[t]], centroid_x(shape, t));
        high[+bone[t]] = std::max(high[+bone[t]], centroid_x(shape, t));
      }
      constexpr double ring = 0.1;
      for (std::size_t b = 0; b < low.size(); ++b) {
        EXPECT_NEAR(low[b], 9.0 / bones * static_cast<double>(b), ring);
        EXPECT_NEAR(high[b], 9.0 / bones * static_cast<double>(b + 1), ring);
      }
      const AtomicClusters atomic = make_atomic_clusters(mesh, bone);
      ASSERT_EQ(atomic.clusters.size(), static_cast<std::size_t>(bones));
      for (int b = 0; b < bones; ++b) {
        std::vector<std::int32_t> expected;
        if (b > 0) expected.push_back(b - 1);
        if (b + 1 < bones) expected.push_back(b + 1);
        EXPECT_EQ(atomic.neighbours[static_cast<std::size_t>(b)], expected);
      }
    }
}

TEST(NearestBoneByHeat, HeatDoesNotJumpAcrossAGap) {
  // The bone in the hole of a torus is nearest to the inner side, yet lies outside of the body.
  const Shape shape = test::torus(40, 16, 2, 0.5);
  std::vector<Bone> bones{{{1.2, -0.2, 0}, {1.2, 0.2, 0}}};
  const auto joint = [](int k) {
    return Vec3(2 * std::cos(std::numbers::pi * k / 8), 2 * std::sin(std::numbers::pi * k / 8), 0);
  };
  for (int k = 0; k < 16; ++k) bones.push_back({joint(k), joint(k + 1)});
  for (const BoneId bone : segment(shape, rig_of(bones), {60, 0})) EXPECT_NE(bone, BoneId{0});
}

TEST(NearestBoneByHeat, UnitAndOriginDoNotMatter) {
  const Shape shape = test::uneven_tube(9, 37, 4, [](double x) { return 0.4 + 0.1 * std::sin(2 * x); });
  const Rig rig = rig_of(
      {{{0.11, 0, 0}, {1.13, 0.02, 0}}, {{1.13, 0.02, 0}, {2.77, 0, 0.05}}, {{2.77, 0, 0.05}, {3.9, 0, 0}}});
  for (const HeatOptions& options : {kFine, kCoarse}) {
    const std::vector<BoneId> expected = segment(shape, rig, options);
    for (const auto& [by, scale] : {std::pair<Vec3, double>{{1e6, -1e6, 1e6}, 1},
                                    {{0, 0, 0}, 1e-6},
                                    {{0, 0, 0}, 1e-150},
                                    {{0, 0, 0}, 1e150},
                                    {{1, 1, 1}, 1e-6}}) {
      Rig moved = rig;
      for (Bone& b : moved.reference) b = {scale * b.head + by, scale * b.tail + by};
      EXPECT_EQ(segment(test::moved(shape, by, scale), moved, options), expected)
          << by.transpose() << " " << scale;
    }
  }
}

TEST(NearestBoneByHeat, OddScenesGetAValidBoneForEveryTriangleTwice) {
  Shape inside_out = test::octahedron(0.3);
  for (Triangle& t : inside_out.triangles) std::swap(t[0], t[1]);
  Shape point = test::octahedron();
  for (Vec3& p : point.positions) p = {3, 3, 3};
  Shape flat = test::icosphere(1);
  for (Vec3& p : flat.positions) p.z() = 0;
  Shape spare = test::octahedron();
  spare.positions.emplace_back(1e12, 0, 0);
  const Shape shapes[] = {
      test::octahedron(),
      test::icosphere(1),
      test::box(),
      point,
      flat,
      spare,
      test::together(test::octahedron(), inside_out),
      test::together(test::octahedron(), test::octahedron(0.3)),
      test::together(test::octahedron(), test::moved(test::octahedron(), {1e4, 0, 0}, 1e-4)),
      test::moved(test::torus(), {1e6, 1e6, 1e6}),
      test::moved(test::torus(), {0, 0, 0}, 1e-6),
      test::uneven_tube(5, 8, 2, [](double x) { return x * (2 - x); })};
  const double huge = std::numeric_limits<double>::max();
  const Rig rigs[] = {straight_chain(1, {0, 0, 0}, {0.5, 0, 0}),
                      straight_chain(7, {-0.5, 0, 0}, {0.5, 0.1, 0}),
                      straight_chain(4, {0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}),         // length zero
                      rig_of({{{1, 0, 0}, {0, 1, 0}}, {{-1, 0, 0}, {-1, 0, 0}}}),  // through vertices
                      straight_chain(3, {1e3, 0, 0}, {1e3, 9, 9}),                 // no bone inside
                      straight_chain(3, {1e9, 0, 0}, {1e15, 0, 0}),
                      rig_of({{{huge, 0, 0}, {-huge, 0, 0}}, {{huge, huge, huge}, {huge, huge, huge}}})};
  int s = 0;
  for (const Shape& shape : shapes) {
    int r = 0;
    for (const Rig& rig : rigs) {
      SCOPED_TRACE("shape " + std::to_string(s) + ", rig " + std::to_string(r++));
      for (const HeatOptions& options : {HeatOptions{1, 0}, HeatOptions{12, 2}, HeatOptions{30, 0}}) {
        const std::vector<BoneId> bone = segment(shape, rig, options);
        ASSERT_EQ(bone.size(), shape.triangles.size());
        for (const BoneId b : bone) ASSERT_LT(+b, rig.reference.size());
        EXPECT_EQ(segment(shape, rig, options), bone);
      }
    }
    ++s;
  }
}

TEST(NearestBoneByHeat, EqualBonesGoToTheSmallerIndex) {
  const Bone bone{{-0.2, 0, 0}, {0.3, 0, 0}};
  for (const BoneId b : segment(test::icosphere(2), rig_of({bone, bone, bone}), kFine))
    EXPECT_EQ(b, BoneId{0});
}

TEST(NearestBoneByHeat, EachComponentGoesToTheBoneInIt) {
  const Shape shape = test::together(test::octahedron(), test::moved(test::octahedron(), {3, 0, 0}));
  const std::vector<BoneId> bone =
      segment(shape, rig_of({{{2.9, 0, 0}, {3.1, 0, 0}}, {{-0.1, 0, 0}, {0.1, 0, 0}}}), kFine);
  for (std::size_t t = 0; t < 16; ++t) EXPECT_EQ(bone[t], BoneId{t < 8 ? 1 : 0});
}

TEST(NearestBoneByHeat, CoarseAgreesWithFineExceptAtTheBorders) {
  const Shape shape = test::capped_tube(12, 80, 0.5, 10);
  const Rig rig = straight_chain(5, {0, 0, 0}, {10, 0, 0});
  const std::vector<BoneId> fine = segment(shape, rig,
                                           {resolution_of_mean_edge(shape.mesh(), shape.positions), 0}),
                            coarse = segment(shape, rig, kCoarse);
  std::size_t differ = 0;
  for (std::size_t t = 0; t < fine.size(); ++t) differ += fine[t] != coarse[t];
  EXPECT_LE(differ, 4u * 24u);  // four borders, one ring of 24 triangles each
}

TEST(NearestBoneByHeat, RefusesWhatItCannotUse) {
  const Shape shape = test::octahedron();
  EXPECT_THROW(segment(shape, Rig{}, kFine), InputError);
  Shape broken = shape;
  broken.positions[2].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(segment(broken, straight_chain(1, {0, 0, 0}, {1, 0, 0}), kFine), InputError);
  const double huge = std::numeric_limits<double>::max();
  EXPECT_THROW(segment(test::moved(shape, {0, 0, 0}, huge), straight_chain(1, {0, 0, 0}, {1, 0, 0}), kFine),
               InputError);
}

TEST(Smoothing, NoPassChangesNothing) {
  const Shape shape = test::torus();
  EXPECT_EQ(smoothed(shape.mesh(), shape.positions, 0), shape.positions);
}

TEST(Smoothing, HalvesAnOctahedronAboutItsCentre) {
  // The neighbours of each corner have their mean at the origin.
  const Shape shape = test::octahedron();
  const std::vector<Vec3> result = smoothed(shape.mesh(), shape.positions, 3);
  for (std::size_t v = 0; v < 6; ++v) EXPECT_LE((result[v] - shape.positions[v] / 8).norm(), 1e-15);
}

TEST(Smoothing, FlattensASpikeAndMovesAllAtOnce) {
  Shape shape = test::icosphere(2);
  shape.positions[0] *= 2;
  const TriangleMesh mesh = shape.mesh();
  const std::vector<Vec3> result = smoothed(mesh, shape.positions, 1);
  EXPECT_LT(result[0].norm(), 1.6);
  // Relabelling the vertices relabels the result, because no vertex sees a neighbour that has already moved.
  const auto n = shape.positions.size();
  Shape reversed = shape;
  for (std::size_t v = 0; v < n; ++v) reversed.positions[n - 1 - v] = shape.positions[v];
  for (Triangle& t : reversed.triangles)
    for (VertexId& v : t) v = VertexId{static_cast<std::int32_t>(n - 1 - +v)};
  const std::vector<Vec3> other = smoothed(reversed.mesh(), reversed.positions, 1);
  for (std::size_t v = 0; v < n; ++v) EXPECT_LE((result[v] - other[n - 1 - v]).norm(), 1e-15);
}

TEST(Smoothing, LeavesUnusedVertices) {
  Shape shape = test::octahedron();
  shape.positions.emplace_back(3, 4, 5);
  EXPECT_EQ(smoothed(shape.mesh(), shape.positions, 4)[6], Vec3(3, 4, 5));
}

}  // namespace

}  // namespace cscd::radial
