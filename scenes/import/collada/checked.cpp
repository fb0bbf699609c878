#include "scenes/import/collada/checked.h"

#include "scenes/import/collada/parts.h"

namespace cscd::scenes {
namespace {

struct TextWriter final : pugi::xml_writer {
  std::string text;
  void write(const void* data, std::size_t size) override {
    text.append(static_cast<const char*>(data), size);
  }
};

}  // namespace

CheckedCollada checked_collada(const std::string& bytes) {
  pugi::xml_document tree;
  const collada::Document document(bytes, tree);
  collada::check_nodes(document);
  CheckedCollada checked;
  checked.loose_vertices = collada::check_geometries(document);
  checked.notes = collada::check_controllers(document);
  for (std::string& note : collada::check_animations(document)) checked.notes.push_back(std::move(note));
  TextWriter writer;
  tree.save(writer, "", pugi::format_raw, pugi::encoding_utf8);
  checked.xml = std::move(writer.text);
  return checked;
}

}  // namespace cscd::scenes
