#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "scenes/base/temporaries.h"

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

// Thrown where the system does not take an output. `reason` is the system's number for it (errno), for
// callers that tell a full disk from a folder that is read-only.
class OutputError : public InputError {
 public:
  OutputError(const std::string& text, int reason) : InputError(text), reason(reason) {}
  int reason;
};

// A file in the folder of its target that is given the target's name when it is complete. Until then the file
// is a temporary (temporaries.h), and the destructor removes it.
class UnfinishedFile {
 public:
  // Creates the file, empty. If `force` is true and the target exists, the new file takes over its
  // permissions. All members that fail throw an OutputError that names `target`.
  UnfinishedFile(std::filesystem::path target, bool force);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  void write(std::string_view content);
  // Waits until the disk has the whole content, gives the file its target's name, and waits until the disk
  // has that name, too: after a power failure the file is there whole or not at all. Without `force`, it
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

// Removes the unfinished files of a folder whose process is gone and that are older than an hour: processes
// that were killed leave them. The hour spares files of processes on other machines that share the folder.
void remove_forsaken_files(const std::filesystem::path& folder);

// Writes all of `text` to a file descriptor. Returns false, and leaves the reason in errno, if the
// descriptor does not take all of it.
bool write_all(int descriptor, std::string_view text);

}  // namespace cscd
