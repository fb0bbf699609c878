#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "core/detect/contact.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::bench {

// A feature pair in numbers that every program has: vertices and triangles by their row in the arrays of the
// mesh, and edges by the vertices at their ends.
struct PairName {
  FeaturePair::Kind kind = FeaturePair::Kind::vertex_face;
  // The vertex and the triangle, then -1 twice; or the ends of one edge and the ends of the other. In the
  // canonical order the smaller end of an edge comes first, and so does the edge with the smaller first end
  // (and, of two edges with the same first end, the one with the smaller second end).
  std::array<std::int32_t, 4> index = {-1, -1, -1, -1};

  static PairName of(const TriangleMesh& mesh, const FeaturePair& pair);
  static PairName vertex_face(std::int32_t vertex, std::int32_t triangle);
  static PairName edge_edge(std::int32_t a0, std::int32_t a1, std::int32_t b0, std::int32_t b1);  // any order

  auto operator<=>(const PairName&) const = default;
};

// "vf" or "ee": the key of a pair in JSON, whose value is the list of its numbers.
const char* key_of(const PairName& pair);
nlohmann::ordered_json numbers_json(const PairName& pair);
// "vertex 5, triangle 17" or "edges 3-8 and 12-15".
std::string text(const PairName& pair);

}  // namespace cscd::bench
