#pragma once

#include <assimp/IOSystem.hpp>
#include <filesystem>

#include "scenes/sandbox/own_folder.h"

namespace cscd::scenes {

// The files that assimp may read: those of the model's own folder (scenes/sandbox/own_folder.h), with at
// most `most_bytes` bytes.
class FolderFiles final : public Assimp::IOSystem {
 public:
  FolderFiles(const std::filesystem::path& model, std::size_t most_bytes) : folder_(model, most_bytes) {}
  bool Exists(const char* name) const override { return folder_.holds(name); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override;
  void Close(Assimp::IOStream* file) override;

 private:
  OwnFolder folder_;
};

}  // namespace cscd::scenes
