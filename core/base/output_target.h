#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "core/base/temporaries.h"

namespace cscd {

// Where an output goes once symbolic links have been followed.
struct OutputTarget {
  std::filesystem::path path;  // the path behind all links; nothing may stand there yet
  // A character device or a pipe: it is written to as it is, and nothing ever takes its place.
  bool is_stream = false;
};

// Follows the links of `path`. Throws InputError for a folder, for what cannot be written to (a socket, a
// disk), for links in a circle, and for a file that exists unless `force`.
OutputTarget find_output_target(const std::filesystem::path& path, bool force);

// A file beside its target that gets the target's name when it is complete. Until then it is a temporary
// (temporaries.h), and the destructor removes it.
class UnfinishedFile {
 public:
  // Makes the file, empty. The errors of all members are InputErrors that name `target`. A file that replaces
  // another one takes over its permissions.
  UnfinishedFile(std::filesystem::path target, bool force);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  void write(std::string_view content);
  // Waits until the disk has it all, then names it. Unless forced, never replaces what has come in between.
  void finish();

 private:
  [[noreturn]] void fail(const char* doing) const;
  void make();
  std::filesystem::path target_, path_;
  bool force_;
  int file_ = -1;
  std::optional<Temporary> registered_;
};

// Writes all of a text to a file descriptor. False, with errno, where that does not take it.
bool write_all(int descriptor, std::string_view text);

}  // namespace cscd
