#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/records/record.h"

namespace cscd::bench {

// A file that holds a record, and the JSON in it.
struct RecordFile {
  std::filesystem::path path;
  nlohmann::ordered_json document;
};
// Such files by what their schema is of: "run" for "cscd.run/2".
using RecordFiles = std::map<std::string, std::vector<RecordFile>>;

// Sorts files and the .json and .json.gz files of folders by their schema. `wanted` is what the command reads
// records of, in any version: an outdated one is refused where it is read, and says why. A file of another
// schema of this project, such as tables.json, is left out, as is any JSON without a schema in a folder; if
// it was named by itself, standard error says so. Throws InputError if a file cannot be read, is no JSON, or
// was named by itself and has no schema of this project, and if no record of the first that is wanted is
// left; with `any`, if no record at all is left.
RecordFiles record_files(const std::vector<std::string>& named, const std::vector<std::string>& wanted,
                         bool any = false);

// Makes records of files: those of different scenes whose verifications passed: those of the paper's scenes
// in the paper's order, those of their variants with contacts, then others in the given order, each in the
// pipeline `today` first. Leaves the files in the order of the records. Throws InputError for a failed
// verification, and for two records of a scene in one pipeline.
std::vector<Record> read_records(std::vector<RecordFile>& files);

}  // namespace cscd::bench
