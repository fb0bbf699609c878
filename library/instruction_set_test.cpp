#include "core/base/instruction_set.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <stdexcept>
#include <string>

#include "cscd/cscd.h"

namespace cscd {
namespace {

// Mutation: the constructor does not look at what the environment asks for.
TEST(InstructionSet, IsThatOfTheBuildAndNoOtherIsTaken) {
  Eigen::Matrix<int, 1, 3, Eigen::RowMajor> faces;
  faces << 0, 1, 2;
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rest = Eigen::Matrix3d::Identity();
  unsetenv("CSCD_ISA");
  EXPECT_EQ(instruction_set(), to_string(kCompiledFor));
  setenv("CSCD_ISA", kCompiledFor == InstructionSet::baseline ? "avx512" : "baseline", 1);
  EXPECT_THROW(instruction_set(), std::invalid_argument);
  // The first object of a process asks, so this needs a process of its own.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto make = [&] {
    try {
      SelfCollision(faces, rest);
    } catch (const std::invalid_argument&) {
      std::_Exit(3);
    }
    std::_Exit(0);
  };
  EXPECT_EXIT(make(), testing::ExitedWithCode(3), "");
  setenv("CSCD_ISA", std::string(to_string(kCompiledFor)).c_str(), 1);
  EXPECT_NO_THROW(SelfCollision(faces, rest));
  unsetenv("CSCD_ISA");
}

}  // namespace
}  // namespace cscd
