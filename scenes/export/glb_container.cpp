#include "scenes/export/glb_container.h"

#include <cstdint>

#include "core/base/error.h"

namespace cscd::scenes {
namespace {

// Writes a number of four bytes.
std::string word(std::size_t number) {
  const auto value = static_cast<std::uint32_t>(number);
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

}  // namespace

std::string glb_container(const std::string& json, const std::string& binary) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  const std::size_t padding = (4 - json.size() % 4) % 4;
  const std::size_t length = kHeader + 2 * kChunkHeader + json.size() + padding + binary.size();
  if (length > UINT32_MAX)
    throw InputError("the file would have " + std::to_string(length) +
                     " bytes; a .glb file cannot hold that");
  std::string out = "glTF" + word(2) + word(length) + word(json.size() + padding) + "JSON" + json;
  out.append(padding, ' ');
  out += word(binary.size()) + std::string("BIN\0", 4);
  return out += binary;
}

}  // namespace cscd::scenes
