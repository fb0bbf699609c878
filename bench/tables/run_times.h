#pragma once

#include <string>

#include "bench/record/record.h"

namespace cscd::bench {

// A small table of what each strategy of a record takes: the median total of an interval, and how many times
// faster than `base` that is. Empty for a record without times.
std::string run_times_text(const Record& record);

}  // namespace cscd::bench
