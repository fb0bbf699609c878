#include "scenes/import/gltf/document.h"

#include "scenes/import/gltf/buffers.h"
#include "scenes/import/gltf/container.h"
#include "scenes/import/gltf/json.h"
#include "scenes/sandbox/own_folder.h"

namespace cscd::scenes::gltf {
namespace {

using nlohmann::json;

// Adds what tinygltf requires although the specification leaves it optional, and moves the indices of
// primitives (see kIndices).
void suit_tinygltf(json& root) {
  for (json& mesh : root["meshes"]) {
    if (!mesh.contains("primitives")) continue;
    for (json& primitive : mesh["primitives"]) {
      if (!primitive.contains("indices") || !primitive.contains("attributes")) continue;
      primitive["attributes"][kIndices] = primitive["indices"];
      primitive.erase("indices");
    }
  }
  for (json& skin : root["skins"])
    if (!skin.contains("inverseBindMatrices")) skin["inverseBindMatrices"] = -1;
}

// No file exists, and none can be read or written. tinygltf 2.9 has one callback more than 2.7, and where one
// is missing it keeps its own, which read files.
template <class Callbacks>
Callbacks no_files() {
  Callbacks none{};
  none.FileExists = [](const std::string&, void*) { return false; };
  none.ExpandFilePath = [](const std::string& name, void*) { return name; };
  none.ReadWholeFile = [](Bytes*, std::string*, const std::string&, void*) { return false; };
  none.WriteWholeFile = [](std::string*, const std::string&, const Bytes&, void*) { return false; };
  if constexpr (requires { none.GetFileSizeInBytes; })
    none.GetFileSizeInBytes = [](std::size_t*, std::string*, const std::string&, void*) { return false; };
  return none;
}

// Lets tinygltf read the JSON text alone: no image, no buffer and no file reaches it.
tinygltf::Model to_model(const json& root) {
  tinygltf::TinyGLTF reader;
  reader.SetFsCallbacks(no_files<tinygltf::FsCallbacks>());
  reader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int,
                           const unsigned char*, int, void*) { return true; },
                        nullptr);
  tinygltf::Model model;
  std::string error, warning;
  const std::string text = root.dump(-1, ' ', false, json::error_handler_t::replace);
  const bool read = reader.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                               static_cast<unsigned int>(text.size()), "");
  // tinygltf drops the entries of a list that it cannot read, and reports them in `error` alone.
  if (!read || !error.empty())
    throw InputError("the glTF file is damaged (" + error.substr(0, error.find('\n')) + "); export it again");
  return model;
}

}  // namespace

Document read_document(const std::filesystem::path& path, std::size_t most_bytes) {
  OwnFolder folder(path, most_bytes);
  const std::optional<std::vector<char>> file = folder.read(std::filesystem::absolute(path).string());
  if (!file)
    throw InputError("the glTF file cannot be read, or has more than " + std::to_string(most_bytes) +
                     " bytes");
  const Container pieces = split(*file);
  CheckedJson checked = checked_json(pieces.json);
  Document document;
  if (checked.root.contains("buffers")) {
    document.buffers = read_buffers(checked.root["buffers"], pieces.binary, folder);
    checked.root.erase("buffers");
  }
  suit_tinygltf(checked.root);
  document.model = to_model(checked.root);
  document.target_names = std::move(checked.target_names);
  document.notes = std::move(checked.notes);
  return document;
}

}  // namespace cscd::scenes::gltf
