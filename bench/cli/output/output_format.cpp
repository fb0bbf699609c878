#include "bench/cli/output/output_format.h"

#include <algorithm>

#include "core/base/error.h"

namespace cscd::bench {

std::string require_format(const std::filesystem::path& output, std::span<const std::string_view> known) {
  std::string extension = output.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (std::find(known.begin(), known.end(), extension) != known.end()) return extension;
  std::string names;
  for (const std::string_view name : known) names += (names.empty() ? "" : " or ") + std::string(name);
  throw InputError(
      "output " + output.string() + ": " +
      (extension.empty() ? "has no extension, which names the format" : extension + " is not written here") +
      "; let its name end in " + names);
}

}  // namespace cscd::bench
