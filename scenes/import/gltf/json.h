#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace cscd::scenes::gltf {

// The JSON of a glTF file, with all that is not about geometry and motion taken out.
struct CheckedJson {
  nlohmann::json root;
  std::set<std::string> used, required;                // names of extensions
  std::vector<std::vector<std::string>> target_names;  // by mesh, where the file names its morph targets
  std::vector<std::string> notes;
};

// tinygltf takes a member of a wrong type, a fraction for an index and the like for a member that is absent,
// and goes on with its default. This reading refuses such a file first, by the member's name: indices and
// counts must be whole numbers that an int holds, and vectors must have their length. It also nests only so
// deep, because tinygltf descends by recursion. Throws InputError.
CheckedJson checked_json(std::string_view text);

}  // namespace cscd::scenes::gltf
