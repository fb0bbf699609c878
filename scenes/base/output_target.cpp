#include "scenes/base/output_target.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"

namespace cscd {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLinks = 40;  // the system's own limit
constexpr char kUnfinished[] = ".cscd-unfinished-";

fs::path follow_links(const fs::path& named) {
  fs::path path = named;
  for (int links = 0; links < kMostLinks; ++links) {
    std::error_code error;
    if (!fs::is_symlink(fs::symlink_status(path, error))) return path;
    const fs::path to = fs::read_symlink(path, error);
    if (error)
      throw InputError("output " + named.string() + ": its link cannot be read; choose another name");
    path = to.is_absolute() ? to : path.parent_path() / to;
  }
  throw InputError("output " + named.string() + ": its links lead in a circle; choose another name");
}

// Renames a file but never replaces another. If the file system cannot do that in one step, the file is given
// a second name, and then its first name is removed.
bool rename_to_new(const char* from, const char* to) {
  if (renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_NOREPLACE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  return link(from, to) == 0 && unlink(from) == 0;
}

// Waits until the disk has the names of a folder's files. Some file systems have no such operation on
// folders, which counts as success.
bool sync_folder(const fs::path& folder) {
  const int handle = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle < 0) return errno == EACCES;  // a folder that may be written to but not read
  const bool good = fsync(handle) == 0 || errno == EINVAL || errno == ENOTSUP;
  const int reason = errno;
  close(handle);
  errno = reason;
  return good;
}

}  // namespace

OutputTarget find_output_target(const fs::path& path, bool force) {
  const std::string name = "output " + path.string();
  if (path.empty()) throw InputError("output: its name is empty; give one");
  std::error_code ignored;
  switch (fs::status(path, ignored).type()) {
    case fs::file_type::character:
    case fs::file_type::fifo:
      return {path, true};
    case fs::file_type::directory:
      throw InputError(name + ": is a folder; name a file in it");
    case fs::file_type::socket:
      throw InputError(name + ": is a socket; choose a file, a pipe or a device");
    case fs::file_type::block:
      throw InputError(name + ": is a disk; choose a file, a pipe or a device");
    case fs::file_type::regular:
      if (!force) throw InputError(name + ": exists; choose another name or pass --force to replace it");
      break;
    default:
      if (!path.has_filename()) throw InputError(name + ": names a folder; name a file in it");
  }
  return {follow_links(path), false};
}

UnfinishedFile::UnfinishedFile(fs::path target, bool force) : target_(std::move(target)), force_(force) {
  try {
    make();
  } catch (...) {
    if (file_ >= 0) close(file_);
    throw;
  }
}

void UnfinishedFile::make() {
  // The file has a short name of its own, because the target's name may already be as
  // long as the file system allows.
  static std::atomic<unsigned> serial{0};
  path_ = target_.parent_path() / (kUnfinished + std::to_string(getpid()) + "-" + std::to_string(serial++));
  registered_.emplace(path_);  // before the file exists, so that no signal comes in between
  file_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file_ < 0) fail("created");
  struct stat present {};
  if (force_ && stat(target_.c_str(), &present) == 0) fchmod(file_, present.st_mode & 0777);
}

UnfinishedFile::~UnfinishedFile() {
  if (file_ < 0) return;
  close(file_);
  unlink(path_.c_str());
}

void UnfinishedFile::write(std::string_view content) {
  if (!write_all(file_, content)) fail("written");
}

void UnfinishedFile::finish() {
  if (fsync(file_) != 0) fail("written");
  const bool named =
      force_ ? rename(path_.c_str(), target_.c_str()) == 0 : rename_to_new(path_.c_str(), target_.c_str());
  if (!named) fail("named");
  registered_.reset();
  close(file_);
  file_ = -1;
  if (!sync_folder(target_.parent_path())) fail("named");
}

void UnfinishedFile::fail(const char* what) const {
  const int reason = errno;
  const bool full = reason == ENOSPC || reason == EDQUOT || reason == EFBIG;
  throw OutputError(
      "output " + target_.string() + ": cannot be " + what + " (" + std::strerror(reason) + "); " +
          (full ? "make room or choose another disk" : "choose a folder that exists and can be written to"),
      reason);
}

void remove_forsaken_files(const fs::path& folder) {
  const auto an_hour_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename();
    if (!name.starts_with(kUnfinished)) continue;
    const int owner = std::atoi(name.c_str() + std::strlen(kUnfinished));
    const bool is_gone = owner > 0 && kill(owner, 0) != 0 && errno == ESRCH;
    if (is_gone && entry.last_write_time(ignored) < an_hour_ago) fs::remove(entry.path(), ignored);
  }
}

bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace cscd
