#pragma once

#include <filesystem>

#include "bench/measure/shards/plan.h"

namespace cscd::bench {

// Measures a cell in this process and writes its result, a run record, into the folder. A result that is
// there already, or that appears in the meantime, stays. Returns whether every strategy kept its promise.
// Throws InputError if the input is not the plan's, OutputError if the folder does not take the result.
bool run_cell(const Plan& plan, const PlanCell& cell, const std::filesystem::path& folder);

}  // namespace cscd::bench
