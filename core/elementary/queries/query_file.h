#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/feature_motion.h"

namespace cscd {

// One query of the public format: a vertex and a triangle's three corners, or the two ends of a first edge
// and of a second one.
struct Query {
  MovingPoint points[4];
  std::optional<bool> truth;  // where the file has the seventh column
};

MovingVertexFace as_vertex_face(const Query& query);
MovingEdgeEdge as_edge_edge(const Query& query);

// Reads rows `x_num,x_den,y_num,y_den,z_num,z_den[,truth]`, eight a query: four points at t = 0, then at t
// = 1. Integers may be of any length; each fraction must be exactly a double. Throws InputError.
std::vector<Query> read_queries(const std::filesystem::path& file);

// The same format: exact fractions; the seventh column where the query has a truth (all have one, or none).
std::string query_text(std::span<const Query> queries);

}  // namespace cscd
