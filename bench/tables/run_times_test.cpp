#include "bench/tables/run_times.h"

#include <gtest/gtest.h>
#include <string>

#include "bench/tables/test_tables.h"

namespace cscd::bench {
namespace {

// Mutation: a row is called faster than the reference by what two repetitions took.
TEST(RunTimes, CallNoRowFasterThatWasTimedTooLittle) {
  Record record = wide_record("rope", Pipeline::vectorised);
  EXPECT_NE(run_times_text(record).find(" times slower than base"), std::string::npos)
      << run_times_text(record);
  for (StrategyRecord& row : record.strategies)
    for (auto& [stage, repetitions] : row.ms) repetitions.resize(2);
  const std::string text = run_times_text(record);
  EXPECT_EQ(text.find("times are of 2 repetitions of 1 intervals, too few to conclude anything from\n"), 0u)
      << text;
  EXPECT_NE(text.find(" ms\n"), std::string::npos) << text;
  EXPECT_EQ(text.find(" than base"), std::string::npos) << text;
}

}  // namespace
}  // namespace cscd::bench
