#include "scenes/import/file_system.h"

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <cstring>
#include <fcntl.h>
#include <memory>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace cscd::scenes {
namespace {

namespace fs = std::filesystem;

// A file that has been read whole; writing fails.
class MemoryStream final : public Assimp::IOStream {
 public:
  explicit MemoryStream(std::vector<char> bytes) : bytes_(std::move(bytes)) {}
  std::size_t Read(void* out, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    count = std::min(count, (bytes_.size() - at_) / size);
    if (count > 0) std::memcpy(out, bytes_.data() + at_, size * count);
    at_ += size * count;
    return count;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    std::size_t target = offset;
    if (origin == aiOrigin_CUR) target += at_;
    if (origin == aiOrigin_END) target = bytes_.size() - offset;  // as stdio streams of assimp do not
    if (target > bytes_.size()) return aiReturn_FAILURE;
    at_ = target;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::vector<char> bytes_;
  std::size_t at_ = 0;
};

}  // namespace

FolderFiles::FolderFiles(const fs::path& model, std::size_t most_bytes) : bytes_left_(most_bytes) {
  std::error_code ignored;
  folder_ = fs::canonical(model, ignored).parent_path();
}

fs::path FolderFiles::inside(const char* name) const {
  std::error_code error;
  fs::path path(name);
  if (path.is_relative()) path = folder_ / path;
  path = fs::canonical(path, error);
  if (error || !fs::is_regular_file(path, error)) return {};
  const auto [end, ignored] = std::mismatch(folder_.begin(), folder_.end(), path.begin(), path.end());
  return end == folder_.end() ? path : fs::path();
}

bool FolderFiles::Exists(const char* name) const {
  return !inside(name).empty();
}

Assimp::IOStream* FolderFiles::Open(const char* name, const char* mode) {
  const fs::path path = inside(name);
  if (path.empty() || std::strchr(mode, 'r') == nullptr || std::strchr(mode, '+') != nullptr) return nullptr;
  // What has become a pipe since then must not block.
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return nullptr;
  std::vector<char> bytes;
  struct stat facts {};
  bool good = fstat(file, &facts) == 0 && S_ISREG(facts.st_mode) &&
              static_cast<std::size_t>(facts.st_size) <= bytes_left_;
  if (good) {
    bytes.resize(static_cast<std::size_t>(facts.st_size));
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t got = read(file, bytes.data() + done, bytes.size() - done);
      if (got <= 0) break;
      done += static_cast<std::size_t>(got);
    }
    bytes.resize(done);
    bytes_left_ -= done;
  }
  close(file);
  return good ? std::make_unique<MemoryStream>(std::move(bytes)).release() : nullptr;
}

void FolderFiles::Close(Assimp::IOStream* file) {
  delete file;
}

}  // namespace cscd::scenes
