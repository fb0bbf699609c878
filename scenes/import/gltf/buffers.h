#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "scenes/sandbox/own_folder.h"

namespace cscd::scenes::gltf {

using Bytes = std::vector<unsigned char>;

// Returns the bytes of the buffers that `list` (the checked member 'buffers' of a file) describes,
// [buffers]: from the binary chunk, from data within the text, or from a file in the model's own folder. A
// buffer that only stands in for compressed data yields nullopt. Throws InputError where a buffer cannot be
// read or holds fewer bytes than it says.
std::vector<std::optional<Bytes>> read_buffers(const nlohmann::json& list,
                                               std::optional<std::span<const char>> binary,
                                               OwnFolder& folder);

}  // namespace cscd::scenes::gltf
