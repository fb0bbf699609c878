#include "scenes/base/temporaries.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <mutex>
#include <new>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace cscd {

// Entries are never freed, so that a signal handler can walk the list at any moment. Whoever takes
// `path` out of an entry owns the text: either the handler, which then removes the file, or the
// destructor, which frees the text.
struct Temporary::Entry {
  std::atomic<char*> path{nullptr};
  std::atomic<pid_t> owner{0};
  Entry* next = nullptr;
  bool taken = false;  // guarded by the mutex
};

namespace {

std::mutex guard;
std::atomic<void*> first{nullptr};  // first entry of the list
std::atomic<pid_t> helper{0};

// The record that the kernel writes for SYS_getdents64. The system call is made directly, because opendir()
// allocates memory, which a signal handler must not do.
struct FolderEntry {
  std::uint64_t inode;
  std::int64_t offset;
  unsigned short length;
  unsigned char type;
  char name[1];
};

void remove_plain_files_in(const char* folder) noexcept {
  const int handle = open(folder, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (handle < 0) return;
  alignas(FolderEntry) char bytes[4096];
  for (;;) {
    const long got = syscall(SYS_getdents64, handle, bytes, sizeof bytes);
    if (got <= 0) break;
    for (long at = 0; at < got;) {
      const auto* entry = reinterpret_cast<const FolderEntry*>(bytes + at);
      unlinkat(handle, entry->name, 0);  // fails for "." and ".."
      at += entry->length;
    }
  }
  close(handle);
}

// Removes a file, or a folder of plain files. A helper that was killed a moment ago may still make a file in
// its folder, so this makes several attempts.
void remove_one(const char* path) noexcept {
  constexpr int kAttempts = 50;
  constexpr timespec kBetween{0, 2'000'000};
  if (unlink(path) == 0 || errno == ENOENT) return;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    remove_plain_files_in(path);
    if (rmdir(path) == 0 || errno != ENOTEMPTY) return;
    nanosleep(&kBetween, nullptr);
  }
}

// Handles a signal. The handler was reset to the default action when the signal came in, so raising the
// signal again ends the process as soon as this function returns.
void end_by(int signal) {
  remove_temporaries();
  raise(signal);
}

}  // namespace

Temporary::Temporary(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path whole = std::filesystem::absolute(path, error);
  char* text = strdup(error ? path.c_str() : whole.c_str());
  if (text == nullptr) throw std::bad_alloc();
  const std::lock_guard lock(guard);
  entry_ = static_cast<Entry*>(first.load());
  while (entry_ != nullptr && entry_->taken) entry_ = entry_->next;
  if (entry_ == nullptr) {
    entry_ = new Entry;
    entry_->next = static_cast<Entry*>(first.load());
    first.store(entry_);
  }
  entry_->taken = true;
  entry_->owner.store(getpid());
  entry_->path.store(text);
}

Temporary::~Temporary() {
  char* text = entry_->path.exchange(nullptr);
  std::free(text);
  const std::lock_guard lock(guard);
  entry_->taken = text == nullptr;  // an entry without text stays taken, as a handler still reads the text
}

TemporaryHelper::TemporaryHelper(int process) noexcept {
  helper.store(process);
}
TemporaryHelper::~TemporaryHelper() {
  helper.store(0);
}

namespace {

// Asks the helper to end, so that it can remove its own temporaries, and kills it if it takes long.
void end_helper(pid_t process) noexcept {
  constexpr int kAttempts = 100;
  constexpr timespec kBetween{0, 2'000'000};
  kill(process, SIGTERM);
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (waitpid(process, nullptr, WNOHANG) != 0) return;
    nanosleep(&kBetween, nullptr);
  }
  kill(process, SIGKILL);
}

}  // namespace

void remove_temporaries() noexcept {
  const pid_t self = getpid();
  auto* entry = static_cast<Temporary::Entry*>(first.load());
  if (const pid_t process = helper.load(); process > 0 && entry != nullptr) end_helper(process);
  for (; entry != nullptr; entry = entry->next) {
    if (entry->owner.load() != self) continue;  // registered by the process from which this one was forked
    if (const char* path = entry->path.exchange(nullptr); path != nullptr) remove_one(path);
  }
}

void remove_temporaries_at_signals() noexcept {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction present {};
    if (sigaction(number, nullptr, &present) != 0 || present.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = end_by;
    action.sa_flags = SA_RESETHAND;
    sigfillset(&action.sa_mask);
    sigaction(number, &action, nullptr);
  }
}

}  // namespace cscd
