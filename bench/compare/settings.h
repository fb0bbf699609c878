#pragma once

#include <map>
#include <string>

#include "bench/records/record.h"

namespace cscd::bench {

// What a run was asked, as far as that changes answers, counters and times by intent: the elementary test,
// the pipeline, the thickness, what is ignored, how a model file is read, and how large the surface is, since
// the digest of a scene is of its positions alone. Maps the name of each setting
// to its value; a setting that the run left out is missing. An option of `cscd run` that this project does
// not know counts as a setting.
using Settings = std::map<std::string, std::string>;
Settings settings_of(const Record& record);

// Says in which settings two records differ, as in "--elementary is newton and filtered_exact"; empty where
// they are equal. Answers and counters are compared between equal settings only.
std::string other_settings(const Record& one, const Record& other);

// The name of a record's scene without the thickness that it may end with, whichever way that is written.
std::string bare_name(const Record& record);
// Whether two records are of one scene and of equal thickness and pipeline, by which records of a scene are
// told apart.
bool asks_the_same(const Record& one, const Record& other);

// Says in which settings that belong to a row it differs between two records: how many intervals were played
// to it before each measured one. Empty where they are equal.
std::string other_row_settings(const StrategyRecord& one, const StrategyRecord& other);

}  // namespace cscd::bench
