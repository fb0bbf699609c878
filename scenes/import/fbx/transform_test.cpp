#include <cmath>
#include <gtest/gtest.h>

#include "scenes/import/fbx/test_fbx.h"

namespace cscd::scenes {
namespace {

// Compares the triangle of FbxText with the triangle that a map gives.
void expect_triangle(const std::vector<Vec3>& was, const Transform& map, const std::string& what) {
  ASSERT_EQ(was.size(), 3u);
  for (std::size_t v = 0; v < 3; ++v) expect_at(was[v], map(kPoints[v]), what);
}

const Vec3 kMove(1, 2, 3), kTurn(20, 35, -50), kScale(1.5, 0.5, 2), kPre(10, 80, 15), kPost(-25, 5, 40),
    kTurnOffset(0.5, 0, 1), kTurnPivot(0, 1, -1), kScaleOffset(1, 1, 0), kScalePivot(-1, 0.5, 2);

std::string full_properties(int order, int active) {
  const auto three = [](const char* name, const Vec3& v) { return property(name, {v.x(), v.y(), v.z()}); };
  return property("RotationOrder", {static_cast<double>(order)}) +
         property("RotationActive", {static_cast<double>(active)}) + property("InheritType", {1}) +
         three("Lcl Translation", kMove) + three("Lcl Rotation", kTurn) + three("Lcl Scaling", kScale) +
         three("PreRotation", kPre) + three("PostRotation", kPost) + three("RotationOffset", kTurnOffset) +
         three("RotationPivot", kTurnPivot) + three("ScalingOffset", kScaleOffset) +
         three("ScalingPivot", kScalePivot);
}

Transform by_formula(const Vec3& move, const Transform& turn, const Vec3& scale) {
  return product({moved(move), moved(kTurnOffset), moved(kTurnPivot), turn, moved(-kTurnPivot),
                  moved(kScaleOffset), moved(kScalePivot), scaled_by(scale), moved(-kScalePivot)});
}

constexpr std::array<int, 3> kOrders[] = {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}, {1, 0, 2}, {2, 0, 1}, {2, 1, 0}};

TEST(FbxTransform, FollowsTheFormulaInEveryOrder) {
  for (int order = 0; order < 6; ++order)
    for (const bool animated : {false, true}) {
      FbxText file = triangle_file(full_properties(order, 1));
      if (animated) {
        file.clip(0, 1);
        file.curve_node(60, 51, 20, "Lcl Rotation", property("d|Y", {kTurn.y()}));
        file.curve(61, 60, "d|X", {0, 1}, {kTurn.x(), kTurn.x() + 90}, {4, 4});
        file.curve(62, 60, "d|Z", {0.25, 0.75}, {kTurn.z(), kTurn.z() - 60}, {4, 4});
        file.curve_node(70, 51, 20, "Lcl Translation", "");
        file.curve(71, 70, "d|Z", {0, 1}, {3, 7}, {4, 4});
        file.curve_node(80, 51, 20, "Lcl Scaling", "");
        file.curve(81, 80, "d|X", {0, 1}, {1.5, 2.5}, {4, 4});
      }
      const Character character = read(file);
      for (const double time : {0.0, 0.4, 1.0}) {
        const double late = animated ? time : 0, z = std::clamp((late - 0.25) / 0.5, 0.0, 1.0);
        const Transform turn =
            product({turned(kPre), turned(kTurn + Vec3(90 * late, 0, animated ? -60 * z : 0), kOrders[order]),
                     inverse(turned(kPost))});
        expect_triangle(vertices_at(character, time),
                        by_formula(kMove + Vec3(0, 0, 4 * late), turn, kScale + Vec3(late, 0, 0)),
                        "order " + std::to_string(order));
      }
    }
}

TEST(FbxTransform, AnInactiveSpaceOfRotationHasNoOrderAndNoRotationsAroundIt) {
  expect_triangle(vertices_at(read(triangle_file(full_properties(4, 0))), 0),
                  by_formula(kMove, turned(kTurn), kScale), "inactive");
}

TEST(FbxTransform, TheGeometricTransformMovesTheMeshButNoChildren) {
  FbxText file;
  file.model(20, "node", 0,
             property("Lcl Translation", {1, 0, 0}) + property("GeometricTranslation", {0, 5, 0}) +
                 property("GeometricRotation", {0, 0, 90}) + property("GeometricScaling", {2, 1, 1}),
             "Mesh");
  file.model(21, "child", 20, property("Lcl Translation", {0, 0, 7}), "Mesh");
  file.triangle(10, 20);
  file.triangle(11, 21);
  const std::vector<Vec3> all = vertices_at(read(file), 0);
  ASSERT_EQ(all.size(), 6u);
  expect_triangle({all.begin(), all.begin() + 3},
                  product({moved({1, 0, 0}), moved({0, 5, 0}), turned(2, 90), scaled_by({2, 1, 1})}), "mesh");
  expect_triangle({all.begin() + 3, all.end()}, moved({1, 0, 7}), "child");
}

// A parent that scales unevenly and a child that turns. Each inherit type puts the scale elsewhere.
FbxText uneven(int type, bool animated, const std::string& more = {}) {
  FbxText file;
  file.model(20, "parent", 0, property("Lcl Scaling", {3, 1, 0.5}) + property("InheritType", {1}));
  file.model(21, "child", 20,
             property("Lcl Translation", {1, 2, 0}) + property("Lcl Rotation", {0, 0, 30}) +
                 property("Lcl Scaling", {1, 2, 1}) + property("InheritType", {static_cast<double>(type)}) +
                 more,
             "Mesh");
  file.triangle(10, 21);
  if (animated) {
    file.clip(0, 1);
    file.curve_node(60, 51, 20, "Lcl Scaling", "");
    file.curve(61, 60, "d|X", {0, 1}, {3, 5}, {4, 4});
    file.curve_node(70, 51, 21, "Lcl Rotation", "");
    file.curve(71, 70, "d|Z", {0, 1}, {30, 80}, {4, 4});
  }
  return file;
}

TEST(FbxTransform, EveryInheritTypePutsTheParentsScaleInItsPlace) {
  for (const bool animated : {false, true})
    for (int type = 0; type < 3; ++type) {
      const Character character = read(uneven(type, animated));
      for (const double time : {0.0, 0.7}) {
        const double late = animated ? time : 0;
        const Vec3 parent(3 + 2 * late, 1, 0.5);
        const Transform place = moved(scaled_by(parent)({1, 2, 0})), turn = turned(2, 30 + 50 * late),
                        own = scaled_by({1, 2, 1});
        const Transform expected = type == 0   ? product({place, turn, scaled_by(parent), own})
                                   : type == 1 ? product({place, scaled_by(parent), turn, own})
                                               : product({place, turn, own});
        expect_triangle(vertices_at(character, time), expected, "type " + std::to_string(type));
      }
    }
}

TEST(FbxTransform, InheritTypesThatNoChainExpressesAreRefusedByName) {
  EXPECT_TRUE(
      says(refusal_of(uneven(2, false, property("RotationPivot", {0, 1, 0}))), "'child': inherit type Rrs"));
  FbxText sheared = uneven(1, false);
  sheared.model(22, "hand", 21, property("Lcl Rotation", {0, 45, 0}) + property("InheritType", {0}));
  EXPECT_TRUE(says(refusal_of(sheared), "'hand': inherit type RrSs below nodes"));
}

TEST(FbxTransform, RefusesSphericRotationAndNumbersThatAreNone) {
  FbxText spheric;
  spheric.model(20, "hip", 0, property("RotationActive", {1}) + property("RotationOrder", {6}));
  spheric.triangle(10, 20);
  EXPECT_TRUE(says(refusal_of(spheric), "'hip': its rotation order is spheric"));
  for (const char* name : {"Lcl Rotation", "Lcl Translation", "PreRotation"}) {
    FbxText nan;
    nan.model(20, "hip", 0, property("RotationActive", {1}) + property(name, {0, std::nan(""), 0}));
    nan.triangle(10, 20);
    EXPECT_TRUE(says(refusal_of(nan), "'hip': its " + std::string(name) + " is not finite"));
  }
}

}  // namespace
}  // namespace cscd::scenes
