#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/records/record.h"

namespace cscd::bench {

// Files that hold records, by the schema that each names: "cscd.run/2" and so on.
using RecordFiles = std::map<std::string, std::vector<std::filesystem::path>>;

// Sorts files and the .json and .json.gz files of folders by their schema. `wanted` are schemas of records
// that the command reads. A file of another schema of this project, such as tables.json, is left out, as is
// any JSON without a schema in a folder; if it was named by itself, standard error says so. Throws InputError
// if a file cannot be read, is no JSON, or was named by itself and has no schema of this project, and if no
// record of `wanted`'s first schema is left; with `any`, if no record of any schema is left.
RecordFiles record_files(const std::vector<std::string>& named, std::span<const std::string_view> wanted,
                         bool any = false);

// Reads records of different scenes whose verifications passed: those of the paper's scenes in the paper's
// order, those of their variants with contacts, then others in the given order, each in the pipeline `today`
// first. Leaves the paths in the order of the records. Throws InputError for a failed verification, and for
// two records of a scene in one pipeline.
std::vector<Record> read_records(std::vector<std::filesystem::path>& paths);

}  // namespace cscd::bench
