#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace cscd::scenes::gltf {

// The JSON of a glTF file, reduced to the members about geometry and motion.
struct CheckedJson {
  nlohmann::json root;
  std::set<std::string> used, required;                // names of extensions
  std::vector<std::vector<std::string>> target_names;  // [meshes][targets], where the file gives names
  std::vector<std::string> notes;                      // messages about what is left out
};

// Parses and checks the JSON of a glTF file. tinygltf treats a member of a wrong type, a fraction in place of
// an index and the like as absent, and goes on with the default. This function refuses such a file first and
// names the member: indices and counts must be whole numbers that an int holds, and vectors must have their
// length. It also limits how deep the file nests, because tinygltf descends by recursion. Throws InputError.
CheckedJson checked_json(std::string_view text);

}  // namespace cscd::scenes::gltf
