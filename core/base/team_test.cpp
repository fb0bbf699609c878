#include "core/base/team.h"

#include <atomic>
#include <gtest/gtest.h>
#include <vector>

namespace cscd {
namespace {

TEST(Team, DoesEveryPartOnce) {
  for (const int threads : {1, 2, 3, 7}) {
    const Team team(threads);
    for (const std::size_t parts : {0U, 1U, 2U, 100U}) {
      std::vector<std::atomic<int>> done(parts);
      std::atomic<bool> numbered = true;
      team.parallel_for(parts, [&](std::size_t part, std::size_t thread) {
        ++done[part];
        if (thread >= team.threads()) numbered = false;
      });
      for (const std::atomic<int>& times : done) EXPECT_EQ(times, 1);
      EXPECT_TRUE(numbered);
    }
  }
}

TEST(Team, RangesMakeUpTheWhole) {
  for (const int threads : {1, 2, 7})
    for (const std::size_t count : {0U, 1U, 2047U, 2048U, 5000U, 100'003U}) {
      const Team team(threads);
      std::vector<std::atomic<int>> seen(count);
      std::vector<std::atomic<int>> parts(team.ranges_of(count, 256));
      team.ranges(count, 256, [&](std::size_t first, std::size_t last, std::size_t part) {
        ++parts[part];
        for (std::size_t i = first; i < last; ++i) ++seen[i];
        if (parts.size() > 1 && last - first < 256) ++parts[part];
      });
      for (const std::atomic<int>& times : seen) ASSERT_EQ(times, 1);
      for (const std::atomic<int>& times : parts) EXPECT_EQ(times, 1);
      EXPECT_EQ(parts.size() == 1, threads == 1 || count < Team::kWorthWaking * 256);
    }
}

}  // namespace
}  // namespace cscd
