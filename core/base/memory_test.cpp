#include "core/base/memory.h"

#include <array>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "core/base/test_memory.h"
#include "core/base/test_refusal.h"

namespace cscd {
namespace {

// Mutation: the limit on the address space is not looked at.
TEST(Memory, IsWhatTheLimitOnTheAddressSpaceLeaves) {
  if (!test::memory_can_be_limited()) GTEST_SKIP() << "memory cannot be limited here";
  EXPECT_GT(available_memory(), std::uint64_t{1} << 20);
  const test::MemoryLimit limit(64 << 20);
  EXPECT_LE(available_memory(), std::uint64_t{64} << 20);
  EXPECT_GT(available_memory(), std::uint64_t{32} << 20);
}

// Mutations: a watch never looks, or forgets to look again once it has.
TEST(Memory, IsLookedAtAsPairsGrow) {
  if (!test::memory_can_be_limited()) GTEST_SKIP() << "memory cannot be limited here";
  constexpr std::size_t kBytes = 8 * 48;
  const test::MemoryLimit limit(64 << 20);
  MemoryWatch watch;
  std::size_t pairs = 0;
  const std::string why = test::refusal<std::bad_alloc>([&] {
    for (watch.start(); pairs < 4 << 20; ++pairs) watch.look(pairs, kBytes);
  });
  EXPECT_GT(pairs * 64, std::size_t{32} << 20);
  EXPECT_LT(pairs * 64, std::size_t{80} << 20);
  EXPECT_EQ(
      why.find(std::to_string(pairs) + " pairs of features are near enough so far, and going on takes "), 0u)
      << why;
  EXPECT_NE(why.find(" MB are left; give a smaller thickness"), std::string::npos) << why;
  watch.start();
  EXPECT_NO_THROW(watch.look(1000, kBytes));
}

// Mutation: what a list takes while it grows is left out.
TEST(Memory, IsEnoughForAListToGrow) {
  if (!test::memory_can_be_limited()) GTEST_SKIP() << "memory cannot be limited here";
  const test::MemoryLimit limit(64 << 20);
  std::vector<std::array<char, 64>> list;
  MemoryWatch watch;
  const std::string why = test::refusal<MemoryShortage>([&] {
    for (;;) {
      watch.look(list);
      list.emplace_back();
    }
  });
  EXPECT_GT(list.size(), std::size_t{200'000}) << why;
  EXPECT_NO_THROW(require_memory(list.size(), 1 << 20));
}

TEST(Memory, IsNamedWithoutAdvice) {
  const MemoryShortage shortage(7, 5'000'000, 4'000'000);
  EXPECT_EQ(
      shortage.finding(),
      "7 pairs of features are near enough so far, and going on takes 5 MB more memory, of which 4 MB are "
      "left");
  EXPECT_EQ(MemoryShortage(0, 5'000'000, 4'000'000).finding(),
            "testing the pairs of features that may be near takes 5 MB more memory, of which 4 MB are left");
}

}  // namespace
}  // namespace cscd
