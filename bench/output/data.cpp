#include "bench/output/data.h"

#include <algorithm>
#include <stdexcept>

namespace cscd::bench {

nlohmann::ordered_json data_json(std::string_view name) {
  const auto files = data_files();
  const auto file =
      std::find_if(files.begin(), files.end(), [&](const DataFile& row) { return row.name == name; });
  if (file == files.end()) throw std::logic_error("no data file " + std::string(name));
  return nlohmann::ordered_json::parse(file->text);
}

}  // namespace cscd::bench
