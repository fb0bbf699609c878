#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "bench/measure/record/record.h"
#include "bench/measure/shards/plan.h"

namespace cscd::bench {

// The cells of a plan that have no result in any of the folders, in the plan's order.
std::vector<const PlanCell*> missing_cells(const Plan& plan, std::span<const std::filesystem::path> folders);

// Joins the results of all cells of a plan into one record, as a single run of the whole range would have
// written it. The record depends on the results alone, and not on who measured them, in which order or how
// they were spread over folders. Lists by interval are joined, sums and maxima are taken of what is one
// number a run, and the environment is that of the plan's first cell. Throws InputError if a result is
// missing, is not its cell's, or comes from another version of the code, another build or, where there are
// times, another machine than the other results.
Record merge(const Plan& plan, std::span<const std::filesystem::path> folders);

}  // namespace cscd::bench
