#include "scenes/character/pieces.h"

#include <algorithm>
#include <charconv>
#include <numeric>

#include "core/base/error.h"
#include "core/base/sort_unique.h"

namespace cscd::scenes {

std::vector<Piece> pieces_of(const TriangleMesh& whole) {
  std::vector<std::vector<TriangleId>> members(static_cast<std::size_t>(whole.component_count()));
  for (std::size_t t = 0; t < whole.triangle_count(); ++t) {
    const TriangleId id{static_cast<std::int32_t>(t)};
    members[static_cast<std::size_t>(whole.component(id))].push_back(id);
  }
  std::vector<VertexId> number(whole.vertex_count(), VertexId{-1});
  std::vector<Piece> pieces;
  for (std::vector<TriangleId>& triangles : members) {
    std::vector<VertexId> vertices;
    for (const TriangleId t : triangles)
      for (const VertexId v : whole.corners(t)) vertices.push_back(v);
    sort_unique(vertices);
    for (std::size_t i = 0; i < vertices.size(); ++i)
      number[+vertices[i]] = VertexId{static_cast<std::int32_t>(i)};
    std::vector<Triangle> own;
    own.reserve(triangles.size());
    for (const TriangleId t : triangles) {
      const Triangle& c = whole.corners(t);
      own.push_back({number[+c[0]], number[+c[1]], number[+c[2]]});
    }
    TriangleMesh mesh(std::move(own), vertices.size(), "component " + std::to_string(pieces.size()));
    pieces.push_back({std::move(triangles), std::move(vertices), std::move(mesh)});
  }
  return pieces;
}

double signed_volume(const Piece& piece, std::span<const Vec3> positions) {
  const Vec3 origin = positions[+piece.vertices.front()];  // far from zero the terms would cancel
  double six = 0;
  for (const Triangle& c : piece.mesh.triangles()) {
    const auto at = [&](std::size_t k) -> Vec3 { return positions[+piece.vertices[+c[k]]] - origin; };
    six += at(0).dot(at(1).cross(at(2)));
  }
  return six / 6;
}

std::vector<std::size_t> choose_pieces(std::span<const Piece> pieces, const std::string& which) {
  const auto larger = [&](std::size_t a, std::size_t b) {
    return pieces[a].triangles.size() > pieces[b].triangles.size();
  };
  std::vector<std::size_t> all(pieces.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  if (which == "all") return all;
  std::stable_sort(all.begin(), all.end(), larger);
  if (which == "largest") return {all.front()};
  if (which == "auto") {
    const auto closed = std::find_if(all.begin(), all.end(),
                                     [&](std::size_t p) { return pieces[p].mesh.closed_and_oriented(); });
    return {closed == all.end() ? all.front() : *closed};
  }
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(which.data(), which.data() + which.size(), number);
  if (error != std::errc{} || end != which.data() + which.size())
    throw InputError("--component " + which + ": is neither auto, largest, all nor a number; choose one");
  if (number >= pieces.size())
    throw InputError("--component " + which + ": there are components 0 to " +
                     std::to_string(pieces.size() - 1) + "; cscd inspect lists them");
  return {number};
}

}  // namespace cscd::scenes
