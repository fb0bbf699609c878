#include "bench/output/progress.h"

#include <chrono>
#include <gtest/gtest.h>
#include <thread>

namespace cscd::bench {
namespace {

TEST(Progress, SaysHowLongItWillStillTake) {
  EXPECT_EQ(time_left(0, 10, 5), "");
  EXPECT_EQ(time_left(10, 0, 5), "");
  EXPECT_EQ(time_left(1, 9, 2), ", about 18 s left");
  EXPECT_EQ(time_left(1, 9, 60), ", about 9 min left");
  EXPECT_EQ(time_left(1, 9, 3600), ", about 9.0 h left");
}

std::string shown(double seconds_between_lines, int steps) {
  testing::internal::CaptureStderr();
  {
    Progress progress("work", 4, Progress::Seconds(seconds_between_lines));
    for (int step = 0; step < steps; ++step) progress.advance();
  }
  return testing::internal::GetCapturedStderr();
}

TEST(Progress, WritesLinesWhereThereIsNoTerminal) {
  const std::string lines = shown(0, 2);
  EXPECT_EQ(lines.find("work: 1 of 4, about"), 0u) << lines;
  EXPECT_NE(lines.find("s left\nwork: 2 of 4"), std::string::npos) << lines;
  EXPECT_EQ(lines.find('\r'), std::string::npos);
}

// One slow step, then many fast ones: the estimate follows the fast ones, although the mean of the whole run
// would be dominated by the slow one.
TEST(Progress, TakesARecentRate) {
  using namespace std::chrono_literals;
  testing::internal::CaptureStderr();
  {
    Progress progress("work", 20000, 1ms);
    std::this_thread::sleep_for(2s);
    progress.set(1);
    for (std::size_t done = 1; done <= 10000; done += 1000) {
      std::this_thread::sleep_for(2ms);
      progress.set(done);
    }
  }
  const std::string lines = testing::internal::GetCapturedStderr();
  EXPECT_NE(lines.find("9001 of 20000, about 1 s left"), std::string::npos) << lines;
}

TEST(Progress, IsSilentAboutShortWork) {
  EXPECT_EQ(shown(3600, 4), "");
}

}  // namespace
}  // namespace cscd::bench
