#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

namespace cscd::bench {

// A data file of this folder, carried inside the program.
struct DataFile {
  std::string_view name, text;
};
std::span<const DataFile> data_files();

nlohmann::ordered_json data_json(std::string_view name);  // of a file that is known to exist

}  // namespace cscd::bench
