#include <algorithm>

#include "core/base/error.h"
#include "scenes/import/collada/parts.h"

namespace cscd::scenes::collada {
namespace {

constexpr std::string_view kFaces[] = {"triangles", "polylist", "polygons", "tristrips", "trifans"};

// How many indices a corner has, and which of them is the vertex.
struct Layout {
  std::size_t indices = 1, vertex = 0;
};

Layout layout_of(pugi::xml_node faces) {
  Layout layout;
  for (const pugi::xml_node input : faces.children("input")) {
    const std::size_t offset = count_in(input, "offset", 0);
    layout.indices = std::max(layout.indices, offset + 1);
    if (input.attribute("semantic").value() == std::string_view("VERTEX")) layout.vertex = offset;
  }
  return layout;
}

// assimp finds the three numbers of a vertex by the names of the accessor's parameters.
void check_axes(const Source& positions) {
  for (const char* axis : {"X", "Y", "Z"}) {
    std::size_t place = 0;
    for (const pugi::xml_node param : positions.accessor.children("param")) {
      if (param.attribute("name").value() == std::string_view(axis)) break;
      ++place;
    }
    if (place >= positions.stride)
      throw InputError(told(positions.element) + ": does not say where the " + axis +
                       " of a vertex is; export it again");
  }
}

// Marks the vertices that are corners.
void mark_corners(pugi::xml_node faces, std::vector<bool>& used) {
  const Layout layout = layout_of(faces);
  for (const pugi::xml_node p : faces.children("p")) {
    const std::vector<long> indices = indices_of(p, 0);
    for (std::size_t i = layout.vertex; i < indices.size(); i += layout.indices)
      if (static_cast<std::size_t>(indices[i]) < used.size())
        used[static_cast<std::size_t>(indices[i])] = true;
  }
}

void check_faces(pugi::xml_node faces, std::size_t vertices) {
  const std::string_view kind = faces.name();
  if (kind == "trifans" && faces.child("p"))
    throw InputError(told(faces) + ": fans of triangles are not read; export triangles");
  if (faces.child("ph"))
    throw InputError(told(faces) +
                     ": polygons with holes are not read; triangulate the mesh before the export");
  if (faces.child("vcount")) indices_of(faces.child("vcount"), 0);
  const Layout layout = layout_of(faces);
  for (const pugi::xml_node p : faces.children("p")) {
    const std::vector<long> indices = indices_of(p, 0);
    if (kind == "tristrips" && indices.size() < 3 * layout.indices)
      throw InputError(told(p) + ": a strip has fewer than three corners; export it again");
    for (std::size_t i = layout.vertex; i < indices.size(); i += layout.indices)
      if (static_cast<std::size_t>(indices[i]) >= vertices)
        throw InputError(told(p) + ": entry " + std::to_string(i) + " (counted from 0) names vertex " +
                         std::to_string(indices[i]) + " of " + std::to_string(vertices) + "; repair it");
  }
}

}  // namespace

std::size_t check_geometries(const Document& document) {
  std::size_t loose = 0;
  for (const pugi::xml_node library : document.root().children("library_geometries"))
    for (const pugi::xml_node geometry : library.children("geometry")) {
      const pugi::xml_node mesh = geometry.child("mesh");
      const std::optional<Source> positions = document.numbers_of_source(mesh.child("vertices"), "POSITION");
      if (!positions) continue;
      if (positions->count > 0) check_axes(*positions);
      std::vector<bool> used(positions->count);
      for (const pugi::xml_node faces : mesh.children()) {
        const bool are_faces = std::ranges::find(kFaces, faces.name()) != std::end(kFaces);
        if (are_faces) check_faces(faces, positions->count);
        // assimp keeps the vertices of lines, so that they are counted where its surface is.
        if (are_faces || std::string_view(faces.name()).starts_with("line")) mark_corners(faces, used);
      }
      loose += static_cast<std::size_t>(std::ranges::count(used, false));
    }
  return loose;
}

}  // namespace cscd::scenes::collada
