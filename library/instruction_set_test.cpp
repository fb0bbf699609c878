#include "core/base/instruction_set.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <stdexcept>
#include <string>

#include "cscd/cscd.h"

namespace cscd {
namespace {

void set_environment(const char* name, std::string_view value) {
#if defined(_WIN32)
  _putenv_s(name, std::string(value).c_str());
#else
  setenv(name, std::string(value).c_str(), 1);
#endif
}

// The choice holds for the process, and one that fails is made again. So what the environment asks for is
// refused first, in a process of its own. Mutation: the constructor does not look at what the environment
// asks for.
TEST(InstructionSet, IsThatOfTheBuildAndNoOtherIsTaken) {
  const auto ask = [] {
    Eigen::Matrix<int, 1, 3, Eigen::RowMajor> faces;
    faces << 0, 1, 2;
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rest = Eigen::Matrix3d::Identity();
    set_environment("CSCD_ISA", kCompiledFor == InstructionSet::baseline ? "avx512" : "baseline");
    EXPECT_THROW(SelfCollision(faces, rest), std::invalid_argument);
    EXPECT_THROW(instruction_set(), std::invalid_argument);
    set_environment("CSCD_ISA", to_string(kCompiledFor));
    EXPECT_NO_THROW(SelfCollision(faces, rest));
    EXPECT_EQ(instruction_set(), to_string(kCompiledFor));
    std::_Exit(testing::Test::HasFailure() ? 1 : 0);
  };
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(ask(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace cscd
