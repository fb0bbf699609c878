#include "bench/output/output.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <unistd.h>

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

}  // namespace

bool is_standard_output(const std::filesystem::path& path) {
  return path == "-" || path == "/dev/stdout" || path == "/dev/fd/1" || path == "/proc/self/fd/1";
}

OutputFile::OutputFile(std::filesystem::path path, bool force, std::string_view extension)
    : path_(std::move(path)) {
  if (path_.empty()) return;
  if (is_standard_output(path_)) {
    standard_output_ = take_standard_output();
    return;
  }
  const OutputTarget target = find_output_target(path_, force);
  if (target.is_stream) {
    if (access(path_.c_str(), W_OK) != 0) fail(path_);
    return;
  }
  const bool is_compressed = path_.extension() == ".gz";
  const std::filesystem::path named = is_compressed ? path_.parent_path() / path_.stem() : path_;
  if (named.has_extension()) require_format(named, std::span(&extension, 1));
  file_.emplace(target.path, force);
  if (is_compressed) gzip_.emplace();
}

OutputFile::~OutputFile() {
  if (standard_output_ >= 0) close(standard_output_);
}

void OutputFile::write(std::string_view piece) {
  if (path_.empty()) return;
  if (file_) {
    file_->write(gzip_ ? gzip_->add(piece, false) : piece);
    return;
  }
  if (!waiting_) waiting_.reset(std::tmpfile());
  if (!waiting_ || std::fwrite(piece.data(), 1, piece.size(), waiting_.get()) != piece.size())
    throw InputError("output " + path_.string() + ": there is no room for it among temporary files (" +
                     std::strerror(errno) + "); name a file instead");
}

void OutputFile::copy_to(int descriptor) {
  std::string room(std::size_t{1} << 16, '\0');
  if (!waiting_) return;
  std::rewind(waiting_.get());
  while (const std::size_t count = std::fread(room.data(), 1, room.size(), waiting_.get())) {
    if (write_all(descriptor, std::string_view(room).substr(0, count))) continue;
    if (descriptor == standard_output_ && errno == EPIPE) throw NobodyReads();
    const int reason = errno;
    if (descriptor != standard_output_) close(descriptor);
    errno = reason;
    fail(path_);
  }
}

void OutputFile::commit() {
  if (path_.empty()) return;
  if (file_) {
    if (gzip_) file_->write(gzip_->add({}, true));
    file_->finish();
    return;
  }
  if (standard_output_ >= 0) {
    copy_to(standard_output_);
    return;
  }
  const int stream = open(path_.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  if (stream < 0) fail(path_);
  copy_to(stream);
  close(stream);
}

void make_folder(const std::filesystem::path& folder, std::string_view option) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError("folder " + folder.string() + ": cannot be made: " + error.message() +
                     "; choose another with " + std::string(option));
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
