#include "core/base/instruction_set.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace cscd {
namespace {

using enum InstructionSet;

class ChosenInstructionSet : public ::testing::Test {
 protected:
  void TearDown() override { unsetenv("CSCD_ISA"); }

  static std::string refusal(const char* asked, const std::vector<InstructionSet>& built) {
    setenv("CSCD_ISA", asked, 1);
    try {
      return "chose " + std::string(to_string(chosen_among(built)));
    } catch (const InputError& error) {
      return error.what();
    }
  }
};

TEST_F(ChosenInstructionSet, IsTheBestThatTheMachineHas) {
  unsetenv("CSCD_ISA");
  const InstructionSet best = machine_has(avx512) ? avx512 : machine_has(avx2) ? avx2 : baseline;
  const InstructionSet all[] = {baseline, avx2, avx512};
  EXPECT_EQ(chosen_among(all), best);
  setenv("CSCD_ISA", "", 1);
  EXPECT_EQ(chosen_among(all), best);
  EXPECT_TRUE(machine_has(kCompiledFor));
}

// Mutation: the environment variable is not looked at.
TEST_F(ChosenInstructionSet, IsWhatTheEnvironmentNames) {
  for (const InstructionSet set : {baseline, avx2, avx512}) {
    if (!machine_has(set)) continue;
    setenv("CSCD_ISA", std::string(to_string(set)).c_str(), 1);
    EXPECT_EQ(chosen_among(std::vector{baseline, avx2, avx512}), set);
  }
}

TEST_F(ChosenInstructionSet, IsRefusedWhereItCannotBe) {
  // Mutation: sets that the build or the machine lacks are advised.
  EXPECT_EQ(refusal("AVX2", {baseline}),
            "CSCD_ISA=AVX2: no such instruction set; leave CSCD_ISA unset, or give baseline");
  EXPECT_EQ(refusal("sse", {baseline, avx2, avx512}),
            "CSCD_ISA=sse: no such instruction set; leave CSCD_ISA unset, or give " +
                std::string(machine_has(avx512) ? "avx512, " : "") + (machine_has(avx2) ? "avx2, " : "") +
                "baseline");
  EXPECT_EQ(refusal("avx2", {baseline}),
            "CSCD_ISA=avx2: this build has no kernels for it; leave CSCD_ISA unset, or give baseline");
  if (!machine_has(avx512)) {
    EXPECT_EQ(refusal("avx512", {avx512, baseline}),
              "CSCD_ISA=avx512: this machine lacks it; leave CSCD_ISA unset, or give baseline");
    EXPECT_EQ(refusal("sse", {avx512}),
              "CSCD_ISA=sse: no such instruction set; this build has kernels for avx512 alone, which this "
              "machine lacks");
  }
}

}  // namespace
}  // namespace cscd
