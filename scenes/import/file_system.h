#pragma once

#include <assimp/IOSystem.hpp>
#include <filesystem>

namespace cscd::scenes {

// What assimp may read: regular files in the model's own folder or below it, each up to a size and all of
// them together too. Names that lead out of the folder, by "..", by a link or from the root, do not exist.
class FolderFiles final : public Assimp::IOSystem {
 public:
  FolderFiles(const std::filesystem::path& model, std::size_t most_bytes);
  bool Exists(const char* name) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override;
  void Close(Assimp::IOStream* file) override;

 private:
  // Empty where the name leads out of the folder or to what is no regular file.
  std::filesystem::path inside(const char* name) const;

  std::filesystem::path folder_;
  std::size_t bytes_left_;
};

}  // namespace cscd::scenes
