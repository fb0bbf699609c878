#include "scenes/sandbox/run_limited.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <optional>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "core/base/error.h"
#include "scenes/base/temporaries.h"

namespace cscd::scenes {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kMayLimitMemory = false;  // the sanitizer's shadow memory is larger than any limit
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool kMayLimitMemory = false;
#else
constexpr bool kMayLimitMemory = true;
#endif
#else
constexpr bool kMayLimitMemory = true;
#endif

constexpr std::size_t kMostErrors = 4096;
constexpr int kNotStarted = 127;

using Clock = std::chrono::steady_clock;

// Owns a file descriptor.
struct Descriptor {
  int id = -1;
  explicit Descriptor(int descriptor) : id(descriptor) {}
  ~Descriptor() {
    if (id >= 0) close(id);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
};

[[noreturn]] void fail(const std::filesystem::path& program) {
  throw InputError(program.string() + ": cannot be started (" + std::strerror(errno) + "); build it again");
}

void limit(__rlimit_resource resource, rlim_t most) {
  const rlimit both{most, most};
  setrlimit(resource, &both);
}

// Turns the child process into the program. Between fork and exec only system calls are allowed.
[[noreturn]] void become(const char* program, char* const* arguments, const Limits& limits, int errors,
                         int nothing, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kNotStarted);
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  limit_memory(limits.memory_bytes);
  limit(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(limits.seconds)));
  limit(RLIMIT_FSIZE, limits.file_bytes);
  limit(RLIMIT_NOFILE, limits.open_files);
  limit(RLIMIT_CORE, 0);
  signal(SIGXFSZ, SIG_IGN);  // a full file becomes an error that the program can report
  dup2(nothing, STDIN_FILENO);
  dup2(nothing, STDOUT_FILENO);
  dup2(errors, STDERR_FILENO);
  close_range(STDERR_FILENO + 1, ~0u, 0);
  char* const no_environment[] = {nullptr};
  execve(program, arguments, no_environment);
  _exit(kNotStarted);
}

// Appends what the pipe holds to `errors`. Returns false at the pipe's end.
bool drain(int pipe, std::string& errors) {
  char bytes[1024];
  for (;;) {
    const ssize_t got = read(pipe, bytes, sizeof bytes);
    if (got < 0) return errno == EINTR || errno == EAGAIN;
    if (got == 0) return false;
    errors.append(bytes, std::min(static_cast<std::size_t>(got), kMostErrors - errors.size()));
    if (static_cast<std::size_t>(got) < sizeof bytes) return true;
  }
}

}  // namespace

void limit_memory(std::size_t bytes) {
  if (!kMayLimitMemory) return;
  rlimit now{};
  getrlimit(RLIMIT_AS, &now);
  limit(RLIMIT_AS, std::min<rlim_t>(bytes, now.rlim_max));
}

Outcome run_limited(const std::filesystem::path& program, std::span<const std::string> arguments,
                    const Limits& limits) {
  const std::string name = program.string();
  std::vector<std::string> words{name};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);

  const Descriptor nothing(open("/dev/null", O_RDWR | O_CLOEXEC));
  int ends[2] = {-1, -1};
  if (nothing.id < 0 || access(name.c_str(), X_OK) != 0 || pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0)
    fail(program);
  const Descriptor from(ends[0]);
  const Clock::time_point started = Clock::now();
  const pid_t self = getpid();
  pid_t child;
  {
    const Descriptor to(ends[1]);
    child = fork();
    if (child < 0) fail(program);
    if (child == 0) become(name.c_str(), pointers.data(), limits, to.id, nothing.id, self);
  }
  const Descriptor handle(static_cast<int>(syscall(SYS_pidfd_open, child, 0)));

  Outcome outcome{Outcome::End::exited, 0, {}, 0, 0};
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - started).count(); };
  bool ended = false, talks = true, too_late = false;
  std::optional<TemporaryHelper> helper;
  helper.emplace(child);
  while (!ended && !too_late) {
    pollfd waits[2] = {{handle.id, POLLIN, 0}, {talks ? from.id : -1, POLLIN, 0}};
    const double left = limits.seconds - elapsed();
    // Without a handle (on an old kernel) the loop checks every few milliseconds.
    const double wait = handle.id >= 0 ? left * 1000 + 1 : 5;
    const int ready = poll(waits, 2, static_cast<int>(std::clamp(wait, 0.0, 1e6)));
    if (ready > 0 && waits[1].revents != 0) talks = drain(from.id, outcome.errors);
    ended = handle.id >= 0 ? waits[0].revents != 0 : !talks;
    too_late = !ended && elapsed() >= limits.seconds;
  }
  if (too_late) kill(child, SIGKILL);
  helper.reset();  // before its number may be given to another process
  int status = 0;
  rusage usage{};
  while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  if (talks) drain(from.id, outcome.errors);
  outcome.seconds = elapsed();
  outcome.peak_bytes = static_cast<std::size_t>(usage.ru_maxrss) * 1024;
  if (WIFSIGNALED(status)) {
    // SIGXCPU, or SIGKILL at the hard limit of processor time.
    const bool spent =
        WTERMSIG(status) == SIGXCPU ||
        static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) + 1 >= limits.seconds;
    outcome.end = too_late || spent ? Outcome::End::timed_out : Outcome::End::killed_by_signal;
    outcome.code = WTERMSIG(status);
  } else {
    outcome.code = WEXITSTATUS(status);
    if (outcome.code == kNotStarted && outcome.errors.empty()) {
      errno = EACCES;
      fail(program);
    }
  }
  return outcome;
}

std::string to_text(const Outcome& outcome) {
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.1f s", outcome.seconds);
  switch (outcome.end) {
    case Outcome::End::exited:
      return "exit status " + std::to_string(outcome.code);
    case Outcome::End::killed_by_signal:
      return "crashed with signal " + std::to_string(outcome.code) + " (" + strsignal(outcome.code) +
             ") after " + seconds;
    case Outcome::End::timed_out:
      return std::string("not done after ") + seconds;
  }
  return {};
}

}  // namespace cscd::scenes
