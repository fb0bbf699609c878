#include "scenes/import/gltf/read_gltf.h"

#include "scenes/character/pose.h"
#include "scenes/import/gltf/clips.h"
#include "scenes/import/gltf/surface.h"
#include "scenes/import/gltf/tree.h"

namespace cscd::scenes {
namespace {

// Turns round the triangles of surfaces that their node mirrors, because such a surface is seen from its
// other side (glTF 2.0, section 3.7.4). Surfaces that follow joints are left alone: their node does not
// bear on where they are.
void turn_mirrored(Character& character) {
  const Pose rest = rest_pose(character);
  for (Part& part : character.parts)
    if (part.joints.empty() && rest[static_cast<std::size_t>(part.node)].determinant() < 0)
      for (auto& triangle : part.triangles) std::swap(triangle[1], triangle[2]);
}

}  // namespace

Character read_gltf(const std::filesystem::path& path, const CharacterLimits& limits) {
  const gltf::Document document = gltf::read_document(path, limits.file_bytes);
  gltf::Accessors accessors(document);
  gltf::Surfaces surfaces(document, accessors, limits);
  gltf::Clips clips(accessors, limits);

  Character character;
  character.format = "glTF 2";
  character.up = "y";
  character.centimetres_per_unit = 100;
  const gltf::Tree tree = gltf::make_tree(document.model, limits.nodes);
  character.nodes = tree.nodes;
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    if (!tree.shown[n]) continue;
    const tinygltf::Node& node = document.model.nodes[static_cast<std::size_t>(tree.source[n])];
    if (node.mesh < 0) continue;
    for (Part& part : surfaces.read(node, static_cast<int>(n), tree.place))
      character.parts.push_back(std::move(part));
  }
  turn_mirrored(character);
  for (const tinygltf::Animation& animation : document.model.animations)
    character.animations.push_back(clips.read(animation, tree, character.parts));

  character.notes = document.notes;
  for (const std::string& note : surfaces.notes()) character.notes.push_back(note);
  for (const std::string& note : clips.notes()) character.notes.push_back(note);
  return character;
}

}  // namespace cscd::scenes
