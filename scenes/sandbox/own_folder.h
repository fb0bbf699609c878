#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cscd::scenes {

// The files that a model from an untrusted source may read: regular files in the model's own folder or below
// it, each up to a size and all of them together too. Names that lead out of the folder, by "..", by a link
// or from the root, do not exist.
class OwnFolder {
 public:
  OwnFolder(const std::filesystem::path& model, std::size_t most_bytes);

  bool holds(const std::string& name) const { return !inside(name).empty(); }

  // Reads a whole file. Returns nothing where the file does not exist by the rule above, cannot be read, or
  // is larger than what is left of the bytes.
  std::optional<std::vector<char>> read(const std::string& name);

 private:
  // Empty where the name leads out of the folder or to what is no regular file.
  std::filesystem::path inside(const std::string& name) const;

  std::filesystem::path folder_;
  std::size_t bytes_left_;
};

}  // namespace cscd::scenes
