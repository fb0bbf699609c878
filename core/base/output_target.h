#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "core/base/temporaries.h"

namespace cscd {

// The place an output goes to, once symbolic links have been followed.
struct OutputTarget {
  std::filesystem::path path;  // the path behind all links; nothing may stand there yet
  // A character device or a pipe: it is written to as it is, and nothing ever takes its place.
  bool is_stream = false;
};

// Follows the symbolic links of `path` and returns their target. Throws InputError for an empty path, for a
// folder, for a socket or a disk (they cannot be written to), for links that lead in a circle or cannot be
// read, and, unless `force` is true, for a regular file that exists.
OutputTarget find_output_target(const std::filesystem::path& path, bool force);

// A file in the folder of its target that is given the target's name when it is complete. Until then the file
// is a temporary (temporaries.h), and the destructor removes it.
class UnfinishedFile {
 public:
  // Creates the file, empty. If `force` is true and the target exists, the new file takes over its
  // permissions. All members that fail throw an InputError that names `target`.
  UnfinishedFile(std::filesystem::path target, bool force);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  void write(std::string_view content);
  // Waits until the disk has the whole content, then gives the file its target's name. Without `force`, it
  // throws if a file of that name has appeared in the meantime, and leaves that file as it is.
  void finish();

 private:
  [[noreturn]] void fail(const char* doing) const;
  void make();
  std::filesystem::path target_, path_;
  bool force_;
  int file_ = -1;
  std::optional<Temporary> registered_;
};

// Writes all of `text` to a file descriptor. Returns false, and leaves the reason in errno, if the
// descriptor does not take all of it.
bool write_all(int descriptor, std::string_view text);

}  // namespace cscd
