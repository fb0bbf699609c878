#pragma once

#include <string>
#include <vector>

#include "bench/record/record.h"

namespace cscd::bench {

// Reads records of different scenes whose verifications passed. Throws InputError for any other.
std::vector<Record> read_records(const std::vector<std::string>& paths);

}  // namespace cscd::bench
