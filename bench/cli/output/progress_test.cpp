#include "bench/cli/output/progress.h"

#include <gtest/gtest.h>

namespace cscd::bench {
namespace {

TEST(Progress, SaysHowLongItWillStillTake) {
  EXPECT_EQ(time_left(0, 10, 5), "");
  EXPECT_EQ(time_left(10, 10, 5), "");
  EXPECT_EQ(time_left(1, 10, 2), ", about 18 s left");
  EXPECT_EQ(time_left(1, 10, 60), ", about 9 min left");
  EXPECT_EQ(time_left(1, 10, 3600), ", about 9.0 h left");
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

TEST(Progress, IsSilentAboutShortWork) {
  EXPECT_EQ(shown(3600, 4), "");
}

}  // namespace
}  // namespace cscd::bench
