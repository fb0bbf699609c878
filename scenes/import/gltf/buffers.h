#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "scenes/sandbox/own_folder.h"

namespace cscd::scenes::gltf {

using Bytes = std::vector<unsigned char>;

// The bytes of the buffers that `list` describes (the checked 'buffers' of a file): from the binary chunk,
// from data within the text, or from a file of the model's own folder. Throws InputError where a buffer holds
// fewer bytes than it says.
std::vector<std::optional<Bytes>> read_buffers(const nlohmann::json& list,
                                               std::optional<std::span<const char>> binary,
                                               OwnFolder& folder);

}  // namespace cscd::scenes::gltf
