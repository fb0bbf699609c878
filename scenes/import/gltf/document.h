#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <tiny_gltf.h>
#include <vector>

#include "core/base/error.h"
#include "scenes/import/gltf/buffers.h"

namespace cscd::scenes::gltf {

// A primitive's indices stand among its attributes by this name: tinygltf refuses indices without a buffer
// view, which sparse and compressed ones do not need.
inline constexpr char kIndices[] = "INDICES";

// A glTF file: its objects as tinygltf gives them, without buffers, and the buffers' bytes.
struct Document {
  tinygltf::Model model;
  // Nothing for a buffer that only stands in for compressed data, which is read instead.
  std::vector<std::optional<Bytes>> buffers;
  std::vector<std::vector<std::string>> target_names;  // by mesh, where the file names its morph targets
  std::vector<std::string> notes;                      // what of the file is left out
};

// Reads a .glb or .gltf file, and the files of its own folder that it names for its buffers; all of them
// together hold `most_bytes` at most. Throws InputError for what is damaged, for glTF 1 and for extensions
// that the file requires and that are not read.
Document read_document(const std::filesystem::path& path, std::size_t most_bytes);

// The object that a file names by its index. Throws InputError where there is none.
template <class Object>
const Object& at(const std::vector<Object>& objects, int index, const std::string& what) {
  if (index < 0 || static_cast<std::size_t>(index) >= objects.size())
    throw InputError("the glTF file names " + what + " " + std::to_string(index) + " of " +
                     std::to_string(objects.size()) + "; repair the file");
  return objects[static_cast<std::size_t>(index)];
}

}  // namespace cscd::scenes::gltf
