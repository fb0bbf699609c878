#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cscd::scenes {

// The files that a model from an untrusted source may read: regular files in the model's own folder or
// below it, together at most `most_bytes` bytes. A name that leads out of the folder, by "..", by a link or
// from the root, counts as a file that does not exist.
class OwnFolder {
 public:
  OwnFolder(const std::filesystem::path& model, std::size_t most_bytes);

  // Tells whether a file of this name may be read.
  bool holds(const std::string& name) const { return !inside(name).empty(); }

  // Reads a whole file. Returns nullopt if the file does not exist by the rule above, cannot be read, or is
  // larger than the number of bytes that are left.
  std::optional<std::vector<char>> read(const std::string& name);

 private:
  // Returns an empty path if the name leads out of the folder or to anything but a regular file.
  std::filesystem::path inside(const std::string& name) const;

  std::filesystem::path folder_;
  std::size_t bytes_left_;
};

}  // namespace cscd::scenes
