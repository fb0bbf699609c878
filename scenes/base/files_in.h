#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"

namespace cscd {

// The files of a folder, without those of its folders, whose names end in one of `endings`, sorted. Throws
// InputError for a folder that cannot be read.
inline std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder,
                                                   const std::vector<std::string_view>& endings) {
  std::vector<std::filesystem::path> files;
  std::error_code error, unknown;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (entry->is_regular_file(unknown) &&
        std::ranges::any_of(endings, [&](std::string_view ending) { return name.ends_with(ending); }))
      files.push_back(entry->path());
  }
  if (error)
    throw InputError("folder " + folder.string() + ": cannot be read (" + error.message() +
                     "); make it readable");
  std::ranges::sort(files);
  return files;
}

}  // namespace cscd
