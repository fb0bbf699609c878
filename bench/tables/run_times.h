#pragma once

#include <string>

#include "bench/records/record.h"

namespace cscd::bench {

// A small table of what each strategy of a record takes: the median total of an interval, and how many times
// faster than `base` that is. Empty for a record without times.
std::string run_times_text(const Record& record);

// Says that a record has too few repetitions to conclude anything from its times, as one of `run --smoke`
// has. Empty where it has enough.
std::string too_few_text(const Record& record);

// Says why nothing is claimed of a scene from a record: it has too few repetitions, or spans a part of the
// scene's intervals, as one of `run --smoke` does. Empty where something may be claimed. Claims of the paper
// and the factors by which one method is faster than another are about whole scenes.
std::string no_claims_text(const Record& record);

}  // namespace cscd::bench
