#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/measure/shards/plan.h"

namespace cscd::bench {

inline constexpr std::string_view kShardSchema = "cscd.shard/1";

// Shard `number` of `count`, counted from 1. The cells of a plan are dealt to its shards in turn.
struct ShardNumber {
  std::size_t number = 1, count = 1;
};
// Reads "1/3". Throws InputError for any other text.
ShardNumber parse_shard(const std::string& text);

// What has become of a cell. `broken_promise`: its result is there and says that a strategy broke its
// promise. After every status from `time_limit` on there is no result, and the next run measures the cell
// again.
enum class CellStatus {
  pending,
  done,
  broken_promise,
  time_limit,
  memory_limit,
  disk_full,
  read_only,
  failed
};
const char* to_string(CellStatus status);

// The exit status of the process that measures one cell.
int exit_status(CellStatus status);
// The status for what the system said when it refused a result (errno).
CellStatus status_of_refusal(int reason);

struct CellLimits {
  std::optional<double> seconds;          // of the clock, and of processor time
  std::optional<std::size_t> memory_mib;  // of address space
};

struct CellState {
  const PlanCell* cell;
  CellStatus status = CellStatus::pending;
  std::string text;  // one line on why there is no result
};

// Measures those cells of a shard that have no result in the folder, one after the other, each in a process
// of its own: this program, called with the plan's file and the cell's id. A cell that fails does not keep
// the others from being measured. After each cell the state of the shard is written into the folder as
// PLAN-shard-NUMBER-of-COUNT.json. Says on standard output what became of each cell. Throws OutputError if
// the folder takes nothing at all.
std::vector<CellState> run_shard(const Plan& plan, const std::filesystem::path& plan_file, ShardNumber shard,
                                 const std::filesystem::path& folder, const CellLimits& limits);

}  // namespace cscd::bench
