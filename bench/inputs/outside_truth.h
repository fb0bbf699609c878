#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/detect/contact.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::bench {

// A feature pair by its vertices alone, as every program can name it. The vertex comes before the ascending
// corners of the face; the ends of an edge ascend, and the edge with the smaller ends comes first.
struct VerticesOfPair {
  FeaturePair::Kind kind;
  std::array<std::int32_t, 4> vertices;

  static VerticesOfPair of(const TriangleMesh& mesh, const FeaturePair& pair);
  static VerticesOfPair of(FeaturePair::Kind kind, std::array<std::int32_t, 4> vertices);  // any order

  auto operator<=>(const VerticesOfPair&) const = default;
};

// "vf 5 3 8 9", as in the table.
std::string text(const VerticesOfPair& pair);

// Which feature pairs touch in the only step of a point cache, as somebody outside this project found out.
struct OutsideTruth {
  std::string file;                      // the name of the table, without its folder
  std::uint64_t pairs = 0;               // that the table judges and whose features share no vertex
  std::vector<VerticesOfPair> contacts;  // those of them that touch, ascending, each once
};

// Reads the table NAME.truth.csv.gz that lies beside the point cache NAME.h5; returns null where none does.
// Its columns are kind,v0,v1,v2,v3,truth,shares_vertex (bench/README.md). Throws InputError, naming the line,
// if the table is damaged or names a vertex that the mesh does not have.
std::shared_ptr<const OutsideTruth> outside_truth(const std::filesystem::path& cache,
                                                  const TriangleMesh& mesh);

}  // namespace cscd::bench
