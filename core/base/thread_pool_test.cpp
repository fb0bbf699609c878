#include "core/base/thread_pool.h"

#include <atomic>
#include <gtest/gtest.h>
#include <vector>

namespace cscd {
namespace {

TEST(ThreadPool, DoesEveryPartOnce) {
  for (const int threads : {1, 2, 3, 7}) {
    const ThreadPool pool(threads);
    for (const std::size_t parts : {0U, 1U, 2U, 100U}) {
      std::vector<std::atomic<int>> done(parts);
      std::atomic<bool> numbered = true;
      pool.parallel_for(parts, [&](std::size_t part, std::size_t thread) {
        ++done[part];
        if (thread >= pool.threads()) numbered = false;
      });
      for (const std::atomic<int>& times : done) EXPECT_EQ(times, 1);
      EXPECT_TRUE(numbered);
    }
  }
}

TEST(ThreadPool, RangesMakeUpTheWhole) {
  for (const int threads : {1, 2, 7})
    for (const std::size_t count : {0U, 1U, 2047U, 2048U, 5000U, 100'003U}) {
      const ThreadPool pool(threads);
      std::vector<std::atomic<int>> seen(count);
      std::vector<std::atomic<int>> parts(pool.ranges_of(count, 256));
      pool.ranges(count, 256, [&](std::size_t first, std::size_t last, std::size_t part) {
        ++parts[part];
        for (std::size_t i = first; i < last; ++i) ++seen[i];
        if (parts.size() > 1 && last - first < 256) ++parts[part];
      });
      for (const std::atomic<int>& times : seen) ASSERT_EQ(times, 1);
      for (const std::atomic<int>& times : parts) EXPECT_EQ(times, 1);
      EXPECT_EQ(parts.size() == 1, threads == 1 || count < ThreadPool::kWorthWaking * 256);
    }
}

}  // namespace
}  // namespace cscd
