#include "scenes/sandbox/own_folder.h"

#include <algorithm>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace cscd::scenes {

namespace fs = std::filesystem;

OwnFolder::OwnFolder(const fs::path& model, std::size_t most_bytes) : bytes_left_(most_bytes) {
  std::error_code ignored;
  folder_ = fs::canonical(model, ignored).parent_path();
}

fs::path OwnFolder::inside(const std::string& name) const {
  // The system would read a name only up to the first zero byte.
  if (name.find('\0') != std::string::npos) return {};
  std::error_code error;
  fs::path path(name);
  if (path.is_relative()) path = folder_ / path;
  path = fs::canonical(path, error);
  if (error || !fs::is_regular_file(path, error)) return {};
  const auto [end, ignored] = std::mismatch(folder_.begin(), folder_.end(), path.begin(), path.end());
  return end == folder_.end() ? path : fs::path();
}

std::optional<std::vector<char>> OwnFolder::read(const std::string& name) {
  const fs::path path = inside(name);
  if (path.empty()) return std::nullopt;
  // O_NONBLOCK: opening must not block if the file has become a pipe since the check.
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return std::nullopt;
  std::vector<char> bytes;
  struct stat facts {};
  const bool good = fstat(file, &facts) == 0 && S_ISREG(facts.st_mode) &&
                    static_cast<std::size_t>(facts.st_size) <= bytes_left_;
  if (good) {
    bytes.resize(static_cast<std::size_t>(facts.st_size));
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t got = ::read(file, bytes.data() + done, bytes.size() - done);
      if (got <= 0) break;
      done += static_cast<std::size_t>(got);
    }
    bytes.resize(done);
    bytes_left_ -= done;
  }
  close(file);
  return good ? std::optional(std::move(bytes)) : std::nullopt;
}

}  // namespace cscd::scenes
