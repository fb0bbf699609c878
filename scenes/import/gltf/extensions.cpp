#include "scenes/import/gltf/extensions.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "core/base/error.h"

namespace cscd::scenes::gltf {
namespace {

constexpr std::array<std::string_view, 3> kRead = {kMeshopt, kDraco, "KHR_mesh_quantization"};

// These extensions say how a surface looks, where light comes from, or who made the file.
constexpr std::array<std::string_view, 19> kHarmless = {"KHR_lights_punctual",
                                                        "KHR_texture_basisu",
                                                        "KHR_texture_transform",
                                                        "KHR_xmp",
                                                        "KHR_xmp_json_ld",
                                                        "KHR_techniques_webgl",
                                                        "EXT_lights_image_based",
                                                        "EXT_lights_ies",
                                                        "EXT_texture_webp",
                                                        "EXT_texture_avif",
                                                        "EXT_texture_astc",
                                                        "MSFT_texture_dds",
                                                        "EXT_mesh_features",
                                                        "EXT_instance_features",
                                                        "EXT_structural_metadata",
                                                        "CESIUM_primitive_outline",
                                                        "FB_ngon_encoding",
                                                        "GODOT_single_root",
                                                        "MSFT_packing_occlusionRoughnessMetallic"};
// The prefix of KHR_materials_unlit, KHR_materials_variants and their many relatives.
constexpr std::string_view kMaterials = "KHR_materials_";

bool is_read(const std::string& name) {
  return std::find(kRead.begin(), kRead.end(), name) != kRead.end();
}
bool is_harmless(const std::string& name) {
  return name.starts_with(kMaterials) ||
         std::find(kHarmless.begin(), kHarmless.end(), name) != kHarmless.end();
}

}  // namespace

void require_known(const std::set<std::string>& required) {
  for (const std::string& name : required)
    if (!is_read(name) && !is_harmless(name))
      throw InputError("needs the glTF extension '" + name + "', which is not read; export it without");
}

std::vector<std::string> notes_on(const std::set<std::string>& used) {
  constexpr std::size_t kMostNamed = 20;
  std::vector<std::string> notes;
  std::size_t more = 0;
  for (const std::string& name : used) {
    // The channels of KHR_animation_pointer get a note each.
    if (is_read(name) || is_harmless(name) || name == kPointer) continue;
    if (notes.size() < kMostNamed)
      notes.push_back("the optional glTF extension '" + name + "' is not read");
    else
      ++more;
  }
  if (more > 0) notes.push_back(std::to_string(more) + " more optional glTF extensions are not read");
  return notes;
}

}  // namespace cscd::scenes::gltf
