#pragma once

#include <filesystem>
#include <span>

#include "bench/measure/cells/cells.h"
#include "bench/measure/record/record.h"

namespace cscd::bench {

// Joins the results of all cells into one record, as a single run of the whole range would have written it.
// The record depends on the results alone, and not on who measured them or in which order. Lists by interval
// are joined, sums and maxima are taken of what is one number a run, and the environment is that of the first
// cell. `whole` is the replay that was divided. Throws InputError if a result is missing, is not its cell's,
// or comes from another build or, where there are times, from another machine than the others.
Record join(const Replay& whole, std::span<const RunCell> cells, const std::filesystem::path& folder);

}  // namespace cscd::bench
