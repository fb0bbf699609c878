#include "core/mesh/rig.h"

#include <gtest/gtest.h>
#include <limits>
#include <string>

#include "core/base/test_refusal.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

std::string error_of(const Rig& rig) {
  return test::refusal([&] { validate(rig); });
}

Rig chain() {
  return test::straight_chain(4, {0, 0, 0}, {4, 0, 0});
}

TEST(Rig, ChainsForestsAndNoBonesAreValid) {
  EXPECT_NO_THROW(validate(chain()));
  EXPECT_NO_THROW(validate(Rig{}));
  Rig forest = chain();
  forest.parent = {BoneId{3}, BoneId{-1}, BoneId{-1}, BoneId{2}};
  EXPECT_NO_THROW(validate(forest));
}

TEST(Rig, RefusesCountsThatDiffer) {
  Rig rig = chain();
  rig.reference.pop_back();
  EXPECT_NE(error_of(rig).find("4 parents but 3 bones"), std::string::npos);
}

TEST(Rig, RefusesParentsOutOfRange) {
  for (const int parent : {-2, 4}) {
    Rig rig = chain();
    rig.parent[2] = BoneId{parent};
    EXPECT_NE(error_of(rig).find("bone 2 has parent " + std::to_string(parent)), std::string::npos);
  }
}

TEST(Rig, RefusesCycles) {
  Rig rig = chain();
  rig.parent[1] = BoneId{3};
  EXPECT_NE(error_of(rig).find("is its own ancestor"), std::string::npos);
  rig = chain();
  rig.parent[2] = BoneId{2};
  EXPECT_NE(error_of(rig).find("is its own ancestor"), std::string::npos);
}

TEST(Rig, RefusesJointsThatAreNotFinite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Rig rig = chain();
    rig.reference[3].tail.z() = bad;
    EXPECT_NE(error_of(rig).find("bone 3 has a joint that is not finite"), std::string::npos);
  }
}

}  // namespace
}  // namespace cscd
