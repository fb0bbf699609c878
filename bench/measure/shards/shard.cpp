#include "bench/measure/shards/shard.h"

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>

#include "bench/cli/output/json_text.h"
#include "core/base/error.h"
#include "scenes/base/output_target.h"
#include "scenes/sandbox/run_limited.h"

namespace cscd::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using scenes::Outcome;

struct StatusRow {
  CellStatus status;
  const char* name;
  int exit;  // of the process that measures one cell
};
constexpr StatusRow kStatuses[] = {{CellStatus::pending, "pending", 2},
                                   {CellStatus::done, "done", 0},
                                   {CellStatus::broken_promise, "broken_promise", 1},
                                   {CellStatus::time_limit, "time_limit", 2},
                                   {CellStatus::memory_limit, "memory_limit", 6},
                                   {CellStatus::disk_full, "disk_full", 4},
                                   {CellStatus::read_only, "read_only", 5},
                                   {CellStatus::failed, "failed", 2}};

const StatusRow& row(CellStatus status) {
  return kStatuses[static_cast<std::size_t>(status)];
}

// Notes may stand before what ended a process.
std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

// Whether a process that a signal ended may have been short of memory. The kernel kills what it has no memory
// for. Under a limit of its own, a process crashes where its stack cannot grow or a library does not look at
// what it gets.
bool may_lack_memory(int signal, const CellLimits& limits) {
  return signal == SIGKILL ||
         (limits.memory_mib && (signal == SIGSEGV || signal == SIGBUS || signal == SIGABRT));
}

// What became of a cell, from how its process ended.
void judge(const Outcome& outcome, const CellLimits& limits, CellState& state) {
  state.text = last_line(outcome.errors);
  if (outcome.end == Outcome::End::timed_out) {
    state.status = CellStatus::time_limit;
    state.text = to_text(outcome) + "; raise --cell-seconds, or plan smaller cells";
    return;
  }
  state.status = CellStatus::failed;
  if (outcome.end == Outcome::End::killed_by_signal) {
    state.text = to_text(outcome);
    if (!may_lack_memory(outcome.code, limits)) return;
    state.status = CellStatus::memory_limit;
    state.text += ", as where memory is short; raise --cell-memory, or use a machine with more";
    return;
  }
  for (const CellStatus status : {CellStatus::done, CellStatus::broken_promise, CellStatus::memory_limit,
                                  CellStatus::disk_full, CellStatus::read_only})
    if (outcome.code == row(status).exit) state.status = status;
  if (state.status == CellStatus::done || state.status == CellStatus::broken_promise) state.text.clear();
  if (state.text.empty() && state.status == CellStatus::failed) state.text = to_text(outcome);
}

void measure(const fs::path& plan_file, const fs::path& folder, const CellLimits& wanted, CellState& state) {
  constexpr double kNoLimit = 1e9;  // seconds
  scenes::Limits limits;
  limits.keeps_environment = true;
  limits.seconds = wanted.seconds.value_or(kNoLimit);
  limits.memory_bytes = ~std::size_t{0};  // the process limits itself, once it can tell that it met the limit
  limits.file_bytes = ~std::size_t{0};
  std::vector<std::string> words = {"run",          "--plan", plan_file.string(), "--cell",
                                    state.cell->id, "--into", folder.string()};
  if (wanted.memory_mib) words.insert(words.end(), {"--cell-memory", std::to_string(*wanted.memory_mib)});
  judge(run_limited("/proc/self/exe", words, limits), wanted, state);
}

bool has_result(const PlanCell& cell, const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / result_name(cell), ignored);
}

ordered_json to_json(const Plan& plan, ShardNumber shard, const std::vector<CellState>& states) {
  ordered_json cells = ordered_json::array();
  for (const CellState& state : states)
    cells.push_back({{"id", state.cell->id},
                     {"frames", {state.cell->intervals.range.first, state.cell->intervals.range.last}},
                     {"status", row(state.status).name},
                     {"text", state.text}});
  return {{"schema", kShardSchema},
          {"plan", plan_id(plan)},
          {"shard", {shard.number, shard.count}},
          {"cells", std::move(cells)}};
}

void write_state(const Plan& plan, ShardNumber shard, const std::vector<CellState>& states,
                 const fs::path& folder) {
  UnfinishedFile file(folder / (plan_id(plan) + "-shard-" + std::to_string(shard.number) + "-of-" +
                                std::to_string(shard.count) + ".json"),
                      true);
  file.write(json_text(to_json(plan, shard, states)));
  file.finish();
}

void say(const CellState& state) {
  std::printf("cell %s, %s: %s%s%s\n", state.cell->id.c_str(), frames_text(*state.cell).c_str(),
              row(state.status).name, state.text.empty() ? "" : ": ", state.text.c_str());
  std::fflush(stdout);
}

}  // namespace

const char* to_string(CellStatus status) {
  return row(status).name;
}

int exit_status(CellStatus status) {
  return row(status).exit;
}

CellStatus status_of_refusal(int reason) {
  switch (reason) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return CellStatus::disk_full;
    case EROFS:
    case EACCES:
    case EPERM:
      return CellStatus::read_only;
    default:
      return CellStatus::failed;
  }
}

ShardNumber parse_shard(const std::string& text) {
  ShardNumber shard{0, 0};
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, shard.number);
  if (first.ec == std::errc{} && first.ptr != end && *first.ptr == '/') {
    const auto second = std::from_chars(first.ptr + 1, end, shard.count);
    if (second.ec == std::errc{} && second.ptr == end && 1 <= shard.number && shard.number <= shard.count)
      return shard;
  }
  throw InputError("--shard " + text + ": is no shard; write I/N with 1 <= I <= N, such as 1/3");
}

std::vector<CellState> run_shard(const Plan& plan, const fs::path& plan_file, ShardNumber shard,
                                 const fs::path& folder, const CellLimits& limits) {
  remove_forsaken_files(folder);
  std::vector<CellState> states;
  for (std::size_t i = shard.number - 1; i < plan.cells.size(); i += shard.count) {
    const PlanCell& cell = plan.cells[i];
    states.push_back({&cell, has_result(cell, folder) ? CellStatus::done : CellStatus::pending, {}});
  }
  write_state(plan, shard, states, folder);
  for (CellState& state : states) {
    if (state.status == CellStatus::done) continue;
    measure(plan_file, folder, limits, state);
    say(state);
    try {
      write_state(plan, shard, states, folder);
    } catch (const OutputError& error) {
      std::fprintf(stderr, "cscd: %s\n", error.what());
    }
  }
  return states;
}

}  // namespace cscd::bench
