#include "scenes/import/gltf/container.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

#include "core/base/error.h"

namespace cscd::scenes::gltf {
namespace {

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

}  // namespace

Container split(std::span<const char> file) {
  Container pieces;
  if (file.size() < 4 || std::memcmp(file.data(), "glTF", 4) != 0) {
    pieces.json = without_filling({file.data(), file.size()});
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

}  // namespace cscd::scenes::gltf
