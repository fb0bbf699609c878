#pragma once

#include <filesystem>
#include <string_view>

namespace cscd::bench {

// A result file that appears whole or not at all: opened beside its final place before any work begins, so
// that an unwritable folder is found at once, and given its name when everything has been written.
class OutputFile {
 public:
  // Throws InputError if something stands at `path` (unless `force`) or the folder cannot be written to.
  OutputFile(std::filesystem::path path, bool force);
  ~OutputFile();  // without commit, leaves nothing behind
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // Throws InputError if the disk does not take it.
  void commit(std::string_view content);

 private:
  [[noreturn]] void fail(const char* doing) const;
  std::filesystem::path path_, temporary_;
  bool force_;
  int file_ = -1;
};

// Removes what the OutputFile made last has written so far, if it has not been committed. For signal
// handlers: system calls only.
void discard_pending_output() noexcept;

}  // namespace cscd::bench
