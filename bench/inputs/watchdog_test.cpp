#include "bench/inputs/watchdog.h"

#include <filesystem>
#include <gtest/gtest.h>
#include <unistd.h>

#include "bench/output/output.h"
#include "core/base/test_folder.h"

namespace cscd::bench {
namespace {

TEST(Watchdog, EndsAStepThatTakesTooLongAndLeavesNoFile) {
  const test::Folder folder;
  EXPECT_EXIT(
      {
        OutputFile output(folder / "out.json", false);
        const Watchdog watchdog(0.05, "too slow");
        for (;;) pause();
      },
      testing::ExitedWithCode(2), "^too slow\n$");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path));
}

TEST(Watchdog, LetsShortStepsAndTheUnwatchedBe) {
  {
    Watchdog watchdog(0.2, "too slow");
    for (int step = 0; step < 8; ++step) {
      usleep(50'000);
      watchdog.restart();
    }
  }
  usleep(300'000);
  const Watchdog never(0, "too slow");
  usleep(50'000);
}

}  // namespace
}  // namespace cscd::bench
