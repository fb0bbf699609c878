#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/feature_motion.h"

namespace cscd {

// One query of the public format. Its points are a vertex and the three corners of a triangle, or the two
// ends of the first edge and the two ends of the second edge.
struct Query {
  MovingPoint points[4];
  std::optional<bool> truth;  // the known answer, if the file has the seventh column
};

MovingVertexFace as_vertex_face(const Query& query);
MovingEdgeEdge as_edge_edge(const Query& query);

// Reads a file of queries. A query has eight rows `x_num,x_den,y_num,y_den,z_num,z_den[,truth]`: its four
// points at t = 0, then its four points at t = 1. The integers may have any length, but each fraction must be
// exactly a double. Throws InputError if the file cannot be read or is malformed; for a malformed file the
// error names the line.
std::vector<Query> read_queries(const std::filesystem::path& file);

// Writes queries in the format that read_queries reads, as exact fractions. The seventh column is written for
// queries with a truth; either all queries have one, or none has.
std::string query_text(std::span<const Query> queries);

}  // namespace cscd
