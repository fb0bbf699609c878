#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <tiny_gltf.h>
#include <vector>

#include "core/base/error.h"
#include "scenes/import/gltf/buffers.h"

namespace cscd::scenes::gltf {

// The name under which a primitive's indices are moved to its attributes. tinygltf refuses indices without
// a buffer view, but indices that are sparse or compressed need none.
inline constexpr char kIndices[] = "INDICES";

// A glTF file: its objects as tinygltf gives them, without buffers, and the bytes of the buffers.
struct Document {
  tinygltf::Model model;
  // [buffers]; nullopt for a buffer that only stands in for compressed data, which are read in its place.
  std::vector<std::optional<Bytes>> buffers;
  std::vector<std::vector<std::string>> target_names;  // [meshes][targets], where the file gives names
  std::vector<std::string> notes;                      // messages about what is left out
};

// Reads a .glb or .gltf file and the files in its own folder that it names for its buffers. All these files
// together hold at most `most_bytes` bytes. Throws InputError for damaged files, for glTF 1, and for
// extensions that the file requires and that are not read.
Document read_document(const std::filesystem::path& path, std::size_t most_bytes);

// Returns the object that a file names by its index. Throws InputError where there is none.
template <class Object>
const Object& at(const std::vector<Object>& objects, int index, const std::string& what) {
  if (index < 0 || static_cast<std::size_t>(index) >= objects.size())
    throw InputError("the glTF file names " + what + " " + std::to_string(index) + " of " +
                     std::to_string(objects.size()) + "; repair the file");
  return objects[static_cast<std::size_t>(index)];
}

}  // namespace cscd::scenes::gltf
