#include "scenes/import/file_system.h"

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

namespace cscd::scenes {
namespace {

// A file that has been read into memory whole. Writing to it fails.
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
    if (origin == aiOrigin_END) target = bytes_.size() - offset;  // stdio streams of assimp add it
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

Assimp::IOStream* FolderFiles::Open(const char* name, const char* mode) {
  if (std::strchr(mode, 'r') == nullptr || std::strchr(mode, '+') != nullptr) return nullptr;
  std::optional<std::vector<char>> bytes = folder_.read(name);
  return bytes ? std::make_unique<MemoryStream>(std::move(*bytes)).release() : nullptr;
}

void FolderFiles::Close(Assimp::IOStream* file) {
  delete file;
}

}  // namespace cscd::scenes
