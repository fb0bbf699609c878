#include "scenes/sandbox/run_limited.h"

#include <chrono>
#include <csignal>
#include <gtest/gtest.h>
#include <vector>

#include "core/base/error.h"
#include "scenes/base/test_says.h"

namespace cscd::scenes {
namespace {

Outcome shell(const std::string& script, const Limits& limits = {}) {
  return run_limited("/bin/bash", std::vector<std::string>{"-c", script}, limits);
}

TEST(RunLimited, ReportsStatusAndErrors) {
  const Outcome outcome = shell("echo to nowhere; echo first >&2; echo second >&2; exit 3");
  EXPECT_EQ(outcome.end, Outcome::End::exited);
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.errors, "first\nsecond\n");
  EXPECT_GT(outcome.peak_bytes, 100'000u);
}

TEST(RunLimited, ReportsTheSignal) {
  const Outcome outcome = shell("kill -SEGV $$");
  EXPECT_EQ(outcome.end, Outcome::End::killed_by_signal);
  EXPECT_EQ(outcome.code, SIGSEGV);
  EXPECT_TRUE(says(to_text(outcome), "Segmentation fault"));
}

TEST(RunLimited, EndsWhatSleepsOrSpinsTooLong) {
  Limits limits;
  limits.seconds = 0.3;
  for (const char* script : {"sleep 20", "while :; do :; done", "exec 2>&-; sleep 20"}) {
    const auto started = std::chrono::steady_clock::now();
    const Outcome outcome = shell(script, limits);
    EXPECT_EQ(outcome.end, Outcome::End::timed_out) << script;
    EXPECT_LT(std::chrono::steady_clock::now() - started, std::chrono::seconds(10)) << script;
  }
}

TEST(RunLimited, KeepsAFloodOfErrorsShort) {
  const Outcome outcome = shell("head -c 3000000 /dev/zero | tr '\\0' 'x' >&2");
  EXPECT_EQ(outcome.end, Outcome::End::exited);
  EXPECT_EQ(outcome.errors, std::string(4096, 'x'));
}

TEST(RunLimited, LimitsFilesMemoryAndPrivileges) {
  Limits limits;
  limits.memory_bytes = std::size_t{100} << 20;
  limits.file_bytes = 4096;
  const Outcome outcome =
      shell("{ ulimit -v; ulimit -f; ulimit -c; ulimit -n; grep NoNewPrivs /proc/self/status; } >&2", limits);
#if !defined(__SANITIZE_ADDRESS__)
  EXPECT_EQ(outcome.errors, "102400\n4\n0\n64\nNoNewPrivs:\t1\n");
  const Outcome greedy = shell("x=$(head -c 300000000 /dev/zero | tr '\\0' 'x')", limits);
  EXPECT_FALSE(greedy.end == Outcome::End::exited && greedy.code == 0);
  EXPECT_LT(greedy.peak_bytes, limits.memory_bytes);
#endif
}

TEST(RunLimited, RefusesAProgramThatIsNotThere) {
  EXPECT_THROW(run_limited("/nowhere/at-all", {}, {}), InputError);
  EXPECT_THROW(run_limited("/etc/passwd", {}, {}), InputError);
}

}  // namespace
}  // namespace cscd::scenes
