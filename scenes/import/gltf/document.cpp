#include "scenes/import/gltf/document.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "scenes/base/text_encoding.h"
#include "scenes/import/gltf/buffers.h"
#include "scenes/import/gltf/json.h"
#include "scenes/sandbox/own_folder.h"

namespace cscd::scenes::gltf {
namespace {

// The two pieces of a glTF file: its JSON text, and the binary chunk that only a .glb file has.
struct Container {
  std::string_view json;
  std::optional<std::span<const char>> binary;
};

static_assert(std::endian::native == std::endian::little, "glTF's numbers are read as they lie in the file");

constexpr std::size_t kHeader = 12, kChunkHeader = 8;
constexpr std::uint32_t kJson = 0x4E4F534A, kBinary = 0x004E4942;

std::uint32_t word(std::span<const char> bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// Removes the filling at the end of the JSON chunk. Some exporters fill up with zeros instead of spaces.
std::string_view without_filling(std::string_view text) {
  while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.remove_suffix(1);
  return text;
}

// Splits a file into its pieces, which point into `file`. The first four bytes tell .glb from .gltf, so
// that a wrong extension does no harm. Throws InputError for a damaged .glb file and for glTF 1.
Container split(std::span<const char> file) {
  Container pieces;
  if (file.size() < 4 || std::memcmp(file.data(), "glTF", 4) != 0) {
    pieces.json = without_filling(without_byte_order_mark({file.data(), file.size()}));
    return pieces;
  }
  if (file.size() < kHeader + kChunkHeader)
    throw InputError("the glTF file ends within its header; export it again");
  const std::uint32_t version = word(file, 4), length = word(file, 8);
  if (version != 2)
    throw InputError("is a file of glTF " + std::to_string(version) +
                     "; only glTF 2 is read, so convert it to glTF 2");
  if (length > file.size() || length < kHeader + kChunkHeader)
    throw InputError("the glTF file says that it has " + std::to_string(length) + " bytes, but it has " +
                     std::to_string(file.size()) + "; export it again");
  file = file.first(length);
  for (std::size_t at = kHeader; file.size() - at >= kChunkHeader;) {
    const std::uint32_t size = word(file, at), kind = word(file, at + 4);
    at += kChunkHeader;
    if (size > file.size() - at)
      throw InputError("a chunk of the glTF file is longer than the file; export it again");
    const std::span<const char> chunk = file.subspan(at, size);
    const bool first = at == kHeader + kChunkHeader;
    if (first != (kind == kJson))
      throw InputError("the glTF file does not begin with its one chunk of JSON; export it again");
    if (first) pieces.json = without_filling({chunk.data(), chunk.size()});
    // Chunks of other kinds belong to extensions.
    if (kind == kBinary && !pieces.binary) pieces.binary = chunk;
    at += size;
  }
  return pieces;
}

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
