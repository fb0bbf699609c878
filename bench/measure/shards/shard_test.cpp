#include "bench/measure/shards/shard.h"

#include <cerrno>
#include <gtest/gtest.h>

#include "core/base/error.h"

namespace cscd::bench {
namespace {

TEST(ShardStatus, FollowsWhatTheSystemSaid) {
  EXPECT_EQ(status_of_refusal(ENOSPC), CellStatus::disk_full);
  EXPECT_EQ(status_of_refusal(EDQUOT), CellStatus::disk_full);
  EXPECT_EQ(status_of_refusal(EROFS), CellStatus::read_only);
  EXPECT_EQ(status_of_refusal(EACCES), CellStatus::read_only);
  EXPECT_EQ(status_of_refusal(EIO), CellStatus::failed);
}

TEST(ShardStatus, IsToldByTheExitStatusOfACell) {
  EXPECT_EQ(exit_status(CellStatus::done), 0);
  EXPECT_EQ(exit_status(CellStatus::broken_promise), 1);
  EXPECT_EQ(exit_status(CellStatus::failed), 2);
  EXPECT_EQ(exit_status(CellStatus::disk_full), 4);
  EXPECT_EQ(exit_status(CellStatus::read_only), 5);
  EXPECT_EQ(exit_status(CellStatus::memory_limit), 6);
}

TEST(ShardNumber, IsOneOfSoMany) {
  EXPECT_EQ(parse_shard("2/3").number, 2u);
  EXPECT_EQ(parse_shard("2/3").count, 3u);
  for (const char* text :
       {"0/2", "3/2", "1", "1/", "/2", "a/b", "1/2x", "-1/2", "", "1//2", "99999999999999999999/2"})
    EXPECT_THROW(parse_shard(text), InputError) << text;
}

}  // namespace
}  // namespace cscd::bench
