#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "bench/measure/replay/replay.h"

// Long work is divided so that it can be interrupted, spread over machines and resumed. A *plan* is one
// replay divided into *cells*: each is a range of the replay's intervals, measured by a process of its own,
// with a result file of its own. A *shard* is the part of a plan's cells that one worker measures.
namespace cscd::bench {

inline constexpr std::string_view kPlanSchema = "cscd.plan/1";

struct PlanCell {
  // The digest of everything that decides what the cell's result is: the input's content, the strategies and
  // all parameters, the intervals, the kind, and the version of the code. 16 hex digits.
  std::string id;
  ChosenIntervals intervals;  // counts at least one interval
};

struct Plan {
  Replay replay;                // of the whole range
  nlohmann::ordered_json code;  // the version of the program that made the plan (code_version.h)
  std::string frames_digest;    // of the input's frames
  std::string surface_digest;   // of what all frames share: triangles, bones, pose at rest
  std::vector<PlanCell> cells;  // in the order of their intervals
};

// Divides a replay of the input into cells of `cell_intervals` intervals, the last of fewer. A part of the
// range in which nothing is counted has no cell.
// `code` is the version of the program that is to measure them (code_version.h).
Plan make_plan(Input& input, Replay replay, std::size_t cell_intervals, nlohmann::ordered_json code);

nlohmann::ordered_json to_json(const Plan& plan);
// Throws InputError, naming the file, unless it holds a whole plan in which every id is that of its cell.
Plan read_plan(const std::filesystem::path& path);

// A digest of all of the plan's cells. 16 hex digits.
std::string plan_id(const Plan& plan);
// "frames A:B" of a cell.
std::string frames_text(const PlanCell& cell);
// The name of a cell's result in the folder of results.
std::string result_name(const PlanCell& cell);

// Opens the input of a plan. Throws InputError if its surface is another than the plan was made for.
Input open_input_of(const Plan& plan);

}  // namespace cscd::bench
