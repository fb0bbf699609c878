#pragma once

#include <filesystem>

// Files and folders with unfinished output, which have to be gone when the process ends in the middle.
namespace cscd {

// Registers a file, or a folder of plain files, as unfinished for as long as this object lives. If a signal
// or the watchdog ends the process in that time, the file or folder is removed. The destructor ends the
// registration and leaves the file in place. The constructor throws std::bad_alloc if memory runs out.
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

// Registers the process that writes into a temporary folder, for as long as this object lives.
// remove_temporaries() ends that process first, by SIGTERM, so that it can remove its own, and by SIGKILL if
// that takes long. At most one such object may exist at a time.
class TemporaryHelper {
 public:
  explicit TemporaryHelper(int process) noexcept;
  ~TemporaryHelper();
  TemporaryHelper(const TemporaryHelper&) = delete;
  TemporaryHelper& operator=(const TemporaryHelper&) = delete;
};

// Removes all files and folders that this process has registered. It makes system calls only,
// so a signal handler may call it.
void remove_temporaries() noexcept;

// Makes SIGINT, SIGTERM and SIGHUP remove the temporaries before they end the process. A signal that the
// process was started to ignore stays ignored.
void remove_temporaries_at_signals() noexcept;

}  // namespace cscd
