#include "bench/output.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <unistd.h>

#include "core/base/error.h"

namespace cscd::bench {
namespace {

const char* pending = nullptr;

}  // namespace

OutputFile::OutputFile(std::filesystem::path path, bool force) : path_(std::move(path)), force_(force) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path_, ignored))
    throw InputError("output " + path_.string() + ": is a folder; name a file in it");
  if (!force_ && std::filesystem::exists(path_, ignored))
    throw InputError("output " + path_.string() +
                     ": exists; choose another name or pass --force to replace it");
  temporary_ = path_;
  temporary_ += ".writing-" + std::to_string(getpid());
  file_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file_ < 0) fail("create");
  pending = temporary_.c_str();
}

OutputFile::~OutputFile() {
  if (file_ < 0) return;
  pending = nullptr;
  close(file_);
  unlink(temporary_.c_str());
}

void OutputFile::commit(std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = write(file_, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("write");
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  if (fsync(file_) != 0) fail("write");
  // A hard link fails if somebody else has written the file meanwhile; a rename replaces it.
  if (!force_ && link(temporary_.c_str(), path_.c_str()) != 0) fail("name");
  if (force_ && rename(temporary_.c_str(), path_.c_str()) != 0) fail("name");
  pending = nullptr;
  close(file_);
  file_ = -1;
  if (!force_) unlink(temporary_.c_str());
}

void discard_pending_output() noexcept {
  if (pending != nullptr) unlink(pending);
}

void OutputFile::fail(const char* doing) const {
  throw InputError("output " + path_.string() + ": cannot " + doing + " it (" + std::strerror(errno) +
                   "); choose a folder that exists and can be written to");
}

}  // namespace cscd::bench
