#include "scenes/shape/limbed_sphere.h"

#include <gtest/gtest.h>

#include "core/base/test_refusal.h"
#include "core/detect/start/embedding.h"
#include "scenes/base/test_says.h"
#include "scenes/catalog/shapes.h"
#include "scenes/shape/test_shapes.h"

namespace cscd::scenes {
namespace {

// A straight tapering limb that grows out of a face of a ball of radius 1. (u, v) is the lowest cell of its
// patch.
Limb limb(const std::string& name, BoxGrid::Face face, int u, int v, int size, int rings, int cells) {
  Vec3 out;
  out[face.axis] = face.upper ? 1 : -1;
  out[face.u()] = (2.0 * u + size) / cells - 1;
  out[face.v()] = (2.0 * v + size) / cells - 1;
  out.normalize();
  const double radius = 0.6 * size / cells;
  Limb limb;
  limb.name = name;
  limb.parent = "head";
  limb.bones = {name + "_1", name + "_2"};
  limb.form.joints = {0.8 * out, 2 * out, 3 * out};
  limb.form.sections = {{0, radius, radius, 0, 0}, {1, radius / 2, radius / 2, 0, 0}};
  limb.form.tip = radius / 2;
  limb.face = face;
  limb.cell_u = u;
  limb.cell_v = v;
  limb.size = size;
  limb.rings = rings;
  limb.collar = 0.1;
  limb.root_blend = 0.8;
  return limb;
}

LimbedSphereParameters ball(int cells) {
  LimbedSphereParameters p;
  p.cells = cells;
  p.body.sections = {{-1, 1, 1, 0, 0}, {1, 1, 1, 0, 0}};
  p.body_bones = {"head"};
  p.body_joints = {{0, 0, -0.5}, {0, 0, 0.5}};
  p.body_blend = 0.5;
  p.relax = 20;
  p.smooth = 4;
  return p;
}

// A ball with `count` limbs of size m, at most two on a face, with `rings` rings in all.
LimbedSphereParameters with_limbs(int cells, int m, int count, int rings) {
  LimbedSphereParameters p = ball(cells);
  for (int i = 0; i < count; ++i) {
    const BoxGrid::Face face = BoxGrid::faces()[static_cast<std::size_t>(i % 6)];
    p.limbs.push_back(limb("limb" + std::to_string(i), face, i < 6 ? (cells - m) / 2 : cells - 2 - m,
                           cells / 2 - 1, m, rings / count + (i < rings % count), cells));
  }
  return p;
}

LimbedSphereParameters octopus() {
  return with_limbs(30, 3, 8, 1549);
}

void expect_counts(const LimbedSphereParameters& p, std::size_t triangles, std::size_t vertices) {
  const Shape shape = limbed_sphere(p);
  EXPECT_EQ(shape.triangles.size(), triangles);
  EXPECT_EQ(shape.positions.size(), vertices);
  expect_well_formed(shape);
}

TEST(LimbedSphere, HasThePapersCounts) {
  expect_counts(with_limbs(14, 3, 5, 369), 11208, 5606);
  expect_counts(octopus(), 47976, 23990);
  expect_counts(with_limbs(20, 4, 5, 475), 20000, 10002);
  LimbedSphereParameters urchin = ball(6);
  for (const BoxGrid::Face& face : BoxGrid::faces())
    for (int i = 0; i < (face.axis == 0 && face.upper ? 8 : 7); ++i)
      urchin.limbs.push_back(
          limb("spike" + std::to_string(urchin.limbs.size()), face, 2 * (i % 3), 2 * (i / 3), 1, 7, 6));
  expect_counts(urchin, 2840, 1422);
}

TEST(LimbedSphere, IsEmbeddedAtRest) {
  for (const LimbedSphereParameters& p : {octopus(), with_limbs(14, 3, 5, 369), ball(7)}) {
    const Shape shape = limbed_sphere(p);
    const TriangleMesh mesh(shape.triangles, shape.positions.size());
    const auto met = EmbeddingTest(mesh, shape.positions).find_intersection(shape.positions);
    EXPECT_FALSE(met) << p.limbs.size() << " limbs, triangle " << +met->first << " meets " << +met->second
                      << " near " << shape.positions[+mesh.corners(met->first)[0]].transpose();
  }
}

TEST(LimbedSphere, IsABallWithoutLimbs) {
  LimbedSphereParameters p = ball(24);
  const Shape shape = limbed_sphere(p);
  for (const Vec3& x : shape.positions) EXPECT_NEAR(x.norm(), 1, 1e-6);
  EXPECT_NEAR(volume(shape), 4.18879, 0.03);
}

TEST(LimbedSphere, HasRoundLimbs) {
  LimbedSphereParameters p = ball(14);
  p.limbs = {limb("arm", {2, true}, 5, 5, 4, 60, 14)};
  const Shape shape = limbed_sphere(p);
  std::size_t on_limb = 0;
  for (const Vec3& x : shape.positions) {
    if (x.z() < 1.3 || x.z() > 2.7) continue;
    ++on_limb;
    const double share = (x.z() - 0.8) / 2.2,
                 radius = 0.6 * 4 / 14 * (1 - (3 * share * share - 2 * share * share * share) / 2);
    EXPECT_NEAR(Vec3(x.x(), x.y(), 0).norm(), radius, 1e-3) << x.transpose();
  }
  EXPECT_GT(on_limb, 300u);
}

// A cuff stands off the arm: its end is square where the sections on both sides have equal shares, and
// overhangs the arm where the arm's section has the lower share. The edge takes up one ring of quads.
TEST(LimbedSphere, HasEdgesWhereSharesDoNotRise) {
  for (const double under : {0.0, 0.05}) {
    LimbedSphereParameters p = ball(14);
    p.limbs = {limb("arm", {2, true}, 5, 5, 4, 60, 14)};
    p.limbs[0].form.sections = {
        {0, 0.17, 0.17, 0, 0}, {0.6, 0.17, 0.17, 0, 0}, {0.6 - under, 0.1, 0.1, 0, 0}, {1, 0.1, 0.1, 0, 0}};
    const Shape shape = limbed_sphere(p);
    expect_well_formed(shape);
    const TriangleMesh mesh(shape.triangles, shape.positions.size());
    EXPECT_TRUE(EmbeddingTest(mesh, shape.positions).embedded(shape.positions)) << under;
    const double edge = 0.8 + 0.6 * 2.2;  // the arm leads from z = 0.8 to z = 3
    std::size_t outer = 0, inner = 0, on_edge = 0;
    for (const Vec3& x : shape.positions) {
      const double radius = Vec3(x.x(), x.y(), 0).norm();
      outer += std::abs(x.z() - edge) < 1e-9 && std::abs(radius - 0.17) < 1e-9;
      inner += std::abs(x.z() - edge + under * 2.2) < 1e-9 && std::abs(radius - 0.1) < 1e-9;
    }
    for (const Triangle& t : shape.triangles) {
      const Vec3 &a = shape.positions[+t[0]], &b = shape.positions[+t[1]], &c = shape.positions[+t[2]];
      const Vec3 normal = (b - a).cross(c - a).normalized(), middle = (a + b + c) / 3;
      const double outward = normal.dot(Vec3(middle.x(), middle.y(), 0).normalized());
      if (middle.z() < 1.5 || middle.z() > 2.7) continue;
      on_edge += under > 0 ? outward < -0.1 : std::abs(outward) < 1e-9;
    }
    EXPECT_EQ(outer, 16u);
    EXPECT_EQ(inner, 16u);
    EXPECT_EQ(on_edge, 32u) << "faces the arm's axis, or stands on edge towards it";
  }
}

TEST(LimbedSphere, MayHaveLimbsThatShareAnEdgeOfTheirPatches) {
  LimbedSphereParameters p = ball(14);
  for (const int u : {3, 7}) p.limbs.push_back(limb("arm" + std::to_string(u), {1, true}, u, 5, 4, 30, 14));
  const Shape shape = limbed_sphere(p);
  expect_well_formed(shape);
  const TriangleMesh mesh(shape.triangles, shape.positions.size());
  EXPECT_TRUE(EmbeddingTest(mesh, shape.positions).embedded(shape.positions));
}

TEST(LimbedSphere, HasSmoothWeights) {
  const Shape shape = limbed_sphere(octopus());
  EXPECT_LT(steepest_weight(shape), 0.4);
  EXPECT_EQ(shape.bone_names.size(), 17u);
  EXPECT_EQ(shape.bone_names[1], "limb0_1");
  EXPECT_EQ(shape.rig.parent[1], BoneId{0});
  EXPECT_EQ(shape.rig.parent[2], BoneId{1});
}

std::string limb_refusal(const std::function<void(LimbedSphereParameters&)>& change) {
  LimbedSphereParameters p = ball(10);
  p.limbs = {limb("arm", {0, true}, 1, 1, 3, 8, 10), limb("leg", {0, true}, 5, 5, 3, 8, 10)};
  change(p);
  return test::refusal([&] { limbed_sphere(p); });
}

TEST(LimbedSphere, SaysWhatCannotBe) {
  using P = LimbedSphereParameters;
  EXPECT_EQ(limb_refusal([](P&) {}), "");
  EXPECT_EQ(limb_refusal([](P& p) { p.limbs[1].cell_u = p.limbs[1].cell_v = 3; }),
            "limbed_sphere: limb leg: its patch overlaps that of limb arm in cell 3, 3; move one of them");
  EXPECT_EQ(limb_refusal([](P& p) { p.limbs[0].rings = 0; }),
            "limbed_sphere: limb arm: needs at least 2 rings");
  EXPECT_EQ(
      limb_refusal([](P& p) { p.limbs[0].size = 11; }),
      "limbed_sphere: limb arm: its patch of 11 x 11 cells at 1, 1 leaves the face of 10 x 10 cells; move or "
      "shrink it");
  EXPECT_TRUE(says(limb_refusal([](P& p) { p.limbs[0].cell_v = 8; }), "leaves the face"));
  EXPECT_EQ(limb_refusal([](P& p) { p.limbs[0].parent = "tail"; }),
            "limbed_sphere: limb arm: its parent tail is no bone of the body");
  EXPECT_EQ(limb_refusal([](P& p) { p.limbs[1].bones[0] = "arm_2"; }),
            "limbed_sphere: two bones are called arm_2; give each a name of its own");
  EXPECT_EQ(limb_refusal([](P& p) { p.limbs[0].bones.pop_back(); }),
            "limbed_sphere: limb arm: needs one joint more than bones; it has 3 joints and 1 bones");
  EXPECT_EQ(limb_refusal([](P& p) { p.limbs[0].form.joints[0] *= 2; }),
            "limbed_sphere: limb arm: its first joint lies outside the body; move it inside");
  EXPECT_EQ(limb_refusal([](P& p) {
              for (Vec3& joint : p.limbs[0].form.joints) joint *= 0.3;
            }),
            "limbed_sphere: limb arm: never leaves the body; lengthen it");
  EXPECT_EQ(limb_refusal([](P& p) { p.limbs[0].collar = 5; }),
            "limbed_sphere: limb arm: no room between body, collar and tip; lengthen it");
  EXPECT_EQ(limb_refusal([](P& p) { p.limbs[0].form.joints[2] = p.limbs[0].form.joints[1]; }),
            "limbed_sphere: limb arm: two neighbouring joints are one point");
  EXPECT_EQ(limb_refusal([](P& p) { p.limbs[0].form.sections[1][0] = 2; }),
            "limbed_sphere: limb arm: sections must lie at shares from 0 to 1 and have positive radii");
  EXPECT_EQ(limb_refusal([](P& p) { p.limbs[0].form.sections[1][0] = 0; }),
            "limbed_sphere: limb arm: an edge of its sections lies in the collar or in the rounded tip");
  EXPECT_EQ(limb_refusal([](P& p) { p.limbs[0].form.tip = 9; }),
            "limbed_sphere: limb arm: the rounded tip must be shorter than the limb");
  EXPECT_TRUE(says(limb_refusal([](P& p) { p.limbs[0].collar = 0; }), "flare, collar and root_blend"));
  EXPECT_TRUE(says(limb_refusal([](P& p) { p.cells = 0; }), "cells must be from 1 to 4000"));
  EXPECT_TRUE(says(limb_refusal([](P& p) { p.body_joints.pop_back(); }), "one joint more than bones"));
  EXPECT_TRUE(says(limb_refusal([](P& p) { p.body.sections.pop_back(); }), "at least two sections"));
  EXPECT_TRUE(says(limb_refusal([](P& p) { p.body.end_power = 3; }), "must be even"));
  EXPECT_TRUE(says(limb_refusal([](P& p) { p.limbs[0].rings = 100000000; }), "more than 2^27 vertices"));
}

TEST(LimbedSphere, IsReadFromParameters) {
  using Table = Parameters::Table;
  const auto shape = [](const std::string& face) {
    const Parameters arm("here, limb", {{"name", std::string("arm")},
                                        {"joints", Table{{0, 0, 0.8}, {0, 0, 2}, {0, 0, 3}}},
                                        {"sections", Table{{0, 0.2, 0.2, 0, 0}}},
                                        {"face", face},
                                        {"cell_u", 3.0},
                                        {"cell_v", 3.0},
                                        {"size", 2.0},
                                        {"rings", 9.0},
                                        {"collar", 0.2},
                                        {"root_blend", 0.5}});
    return make_shape("limbed_sphere",
                      Parameters("here", {{"cells", 8.0},
                                          {"body_axis", std::string("z")},
                                          {"body_sections", Table{{-1, 1, 1, 0, 0}, {1, 1, 1, 0, 0}}},
                                          {"body_bones", std::string("hip chest")},
                                          {"body_joints", Table{{0, 0, -1}, {0, 0, 0}, {0, 0, 1}}},
                                          {"body_blend", 0.5},
                                          {"limbs", std::vector<Parameters>{arm}}}));
  };
  EXPECT_EQ(shape("+z").bone_names, (std::vector<std::string>{"hip", "chest", "arm_1", "arm_2"}));
  EXPECT_EQ(shape("+z").rig.parent[2], BoneId{1});
  EXPECT_EQ(shape("+z").triangles.size(), 2u * (6 * 64 + 8 * 9));
  EXPECT_EQ(test::refusal([&] { shape("up"); }),
            "here, limb: parameter face is up; it must be -x, +x, -y, +y, -z or +z");
}

}  // namespace
}  // namespace cscd::scenes
