#include "scenes/import/gltf/buffers.h"

#include <charconv>
#include <tiny_gltf.h>

#include "core/base/error.h"
#include "scenes/import/gltf/extensions.h"

namespace cscd::scenes::gltf {
namespace {

using nlohmann::json;

// Replaces "%20" by a space, and so on (RFC 3986). A per cent sign without two digits stays.
std::string percent_decoded(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char code = 0;
    const char* digits = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
      out += static_cast<char>(code);
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

// Decodes "data:KIND;base64,DIGITS", or "data:KIND,BYTES" with some bytes percent-encoded (RFC 2397).
Bytes from_data_uri(const std::string& uri, const std::string& where) {
  constexpr char kBase64[] = ";base64";
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos) throw InputError(where + ": its data URI has no comma; repair the file");
  const std::string payload = percent_decoded(uri.substr(comma + 1));
  if (!std::string_view(uri).substr(0, comma).ends_with(kBase64)) return {payload.begin(), payload.end()};
  // tinygltf decodes up to the first character that is no digit; the caller notices that bytes are missing.
  // tinygltf knows few kinds of data, and all kinds mean the same here.
  Bytes bytes;
  std::string ignored;
  tinygltf::DecodeDataURI(&bytes, ignored, "data:application/octet-stream;base64," + payload, 0, false);
  return bytes;
}

bool has_scheme(const std::string& uri) {
  const std::size_t colon = uri.find(':');
  return colon != std::string::npos && colon > 1 && uri.find('/') > colon;
}

Bytes from_file(const std::string& uri, OwnFolder& folder, const std::string& where) {
  if (has_scheme(uri))
    throw InputError(where + ": lies at '" + uri.substr(0, 100) +
                     "', and only files beside the model are read; put it there");
  const std::string decoded = percent_decoded(uri);
  const std::string& name = folder.holds(decoded) ? decoded : uri;
  if (!folder.holds(name))
    throw InputError(where + ": there is no file '" + decoded.substr(0, 100) +
                     "' in the model's folder; put it there");
  const std::optional<std::vector<char>> bytes = folder.read(name);
  if (!bytes)
    throw InputError(where + ": the file '" + decoded.substr(0, 100) +
                     "' cannot be read, or all files together are too large");
  return {bytes->begin(), bytes->end()};
}

bool is_fallback(const json& buffer) {
  return buffer.value(json::json_pointer("/extensions/" + std::string(kMeshopt) + "/fallback"), false);
}

}  // namespace

std::vector<std::optional<Bytes>> read_buffers(const json& list, std::optional<std::span<const char>> binary,
                                               OwnFolder& folder) {
  std::vector<std::optional<Bytes>> buffers;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const json& buffer = list[i];
    const std::string where = "buffer " + std::to_string(i) + " of the glTF file";
    if (!buffer.contains("byteLength")) throw InputError(where + ": has no byteLength; repair the file");
    const auto length = buffer["byteLength"].get<std::size_t>();
    if (is_fallback(buffer)) {
      buffers.emplace_back();
      continue;
    }
    Bytes bytes;
    if (buffer.contains("uri")) {
      const std::string uri = buffer["uri"].get<std::string>();
      bytes = uri.starts_with("data:") ? from_data_uri(uri, where) : from_file(uri, folder, where);
    } else if (i == 0 && binary) {
      bytes.assign(binary->begin(), binary->end());
    } else {
      throw InputError(where + ": has neither a uri nor the file's binary chunk; export it again");
    }
    if (bytes.size() < length)
      throw InputError(where + ": says that it has " + std::to_string(length) + " bytes, but has " +
                       std::to_string(bytes.size()) + "; export it again");
    bytes.resize(length);
    buffers.emplace_back(std::move(bytes));
  }
  return buffers;
}

}  // namespace cscd::scenes::gltf
