#pragma once

#include <filesystem>

// Files and folders with unfinished output, which have to be gone when the process ends in the middle.
namespace cscd {

// Registers a file, or a folder of plain files, as unfinished for as long as this lives. If a signal or the
// watchdog ends the process meanwhile, the file or folder is removed. The destructor removes nothing.
class Temporary {
 public:
  explicit Temporary(const std::filesystem::path& path);
  ~Temporary();
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

 private:
  struct Entry;
  Entry* entry_;
  friend void remove_temporaries() noexcept;
};

// Names the process that writes into a temporary folder for as long as this lives: remove_temporaries() ends
// that process first. One at a time.
class TemporaryHelper {
 public:
  explicit TemporaryHelper(int process) noexcept;
  ~TemporaryHelper();
  TemporaryHelper(const TemporaryHelper&) = delete;
  TemporaryHelper& operator=(const TemporaryHelper&) = delete;
};

// Removes all that this process has registered. Makes system calls only, so a signal handler may call it.
void remove_temporaries() noexcept;

// From here on SIGINT, SIGTERM and SIGHUP remove the temporaries before they end the process. A signal that
// the caller of the program ignores stays ignored.
void remove_temporaries_at_signals() noexcept;

}  // namespace cscd
