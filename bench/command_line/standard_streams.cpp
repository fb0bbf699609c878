#include "bench/command_line/standard_streams.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <initializer_list>
#include <poll.h>
#include <unistd.h>

#include "bench/output/exit_status.h"

namespace cscd::bench {
namespace {

constexpr int kNotWritten = static_cast<int>(ExitStatus::refused);

// Whether standard output is a pipe without a reader. The error of the write that found out may be long gone.
bool nobody_reads() {
  pollfd output{STDOUT_FILENO, 0, 0};
  return poll(&output, 1, 0) == 1 && (output.revents & POLLERR) != 0;
}

}  // namespace

void prepare_standard_streams() {
  // In this order each open() takes the lowest free descriptor, which is the one that is missing.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0)
      return;
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
}

void end_by_broken_pipe() {
  signal(SIGPIPE, SIG_DFL);
  raise(SIGPIPE);
  _exit(kNotWritten);  // the caller of the program has blocked the signal
}

int finish_standard_output(int status) {
  const bool failed_before = std::ferror(stdout) != 0;
  errno = 0;
  if (std::fflush(stdout) == 0 && !failed_before) return status;
  const int reason = errno;
  if (nobody_reads()) end_by_broken_pipe();
  // The reason of a write that failed long ago is gone.
  std::fprintf(stderr, "cscd: standard output: cannot be written (%s); what was printed is not complete\n",
               reason != 0 ? std::strerror(reason) : "is the disk full?");
  return status != 0 ? status : kNotWritten;
}

}  // namespace cscd::bench
