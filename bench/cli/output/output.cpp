#include "bench/cli/output/output.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <unistd.h>

#include "bench/cli/output/gzip.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

// Keeps standard output for the answer, and lets all that is printed go to standard error. Returns the
// descriptor of the answer.
int take_standard_output() {
  std::fflush(stdout);
  const int answer = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  if (answer < 0 || dup2(STDERR_FILENO, STDOUT_FILENO) < 0)
    throw InputError(std::string("output -: standard output cannot be used (") + std::strerror(errno) +
                     "); name a file");
  return answer;
}

[[noreturn]] void fail(const std::filesystem::path& path) {
  throw InputError("output " + path.string() + ": cannot be written (" + std::strerror(errno) +
                   "); choose another place");
}

void write_to_stream(const std::filesystem::path& path, std::string_view content) {
  const int stream = open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  if (stream < 0) fail(path);
  const bool good = write_all(stream, content);
  const int reason = errno;
  close(stream);
  errno = reason;
  if (!good) fail(path);
}

}  // namespace

bool is_standard_output(const std::filesystem::path& path) {
  return path == "-" || path == "/dev/stdout" || path == "/dev/fd/1" || path == "/proc/self/fd/1";
}

OutputFile::OutputFile(std::filesystem::path path, bool force, std::string_view extension)
    : path_(std::move(path)) {
  if (is_standard_output(path_)) {
    standard_output_ = take_standard_output();
    return;
  }
  const OutputTarget target = find_output_target(path_, force);
  is_stream_ = target.is_stream;
  if (is_stream_) {
    if (access(path_.c_str(), W_OK) != 0) fail(path_);
    return;
  }
  is_compressed_ = path_.extension() == ".gz";
  const std::filesystem::path named = is_compressed_ ? path_.parent_path() / path_.stem() : path_;
  if (named.has_extension()) require_format(named, std::span(&extension, 1));
  file_.emplace(target.path, force);
}

OutputFile::~OutputFile() {
  if (standard_output_ >= 0) close(standard_output_);
}

void OutputFile::commit(std::string_view content) {
  if (standard_output_ >= 0) {
    if (write_all(standard_output_, content)) return;
    if (errno == EPIPE) throw NobodyReads();
    fail(path_);
  }
  if (is_stream_) {
    write_to_stream(path_, content);
    return;
  }
  file_->write(is_compressed_ ? gzipped(content) : content);
  file_->finish();
}

std::string require_format(const std::filesystem::path& output, std::span<const std::string_view> known) {
  std::string extension = output.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (std::find(known.begin(), known.end(), extension) != known.end()) return extension;
  std::string names;
  for (const std::string_view name : known) names += (names.empty() ? "" : " or ") + std::string(name);
  throw InputError(
      "output " + output.string() + ": " +
      (extension.empty() ? "has no extension, which names the format" : extension + " is not written here") +
      "; let its name end in " + names);
}

}  // namespace cscd::bench
