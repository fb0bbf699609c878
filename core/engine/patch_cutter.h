#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Cuts sets of triangles into few patches, each of at most `most` triangles with at most as many vertices.
// Every patch costs the same, however full.
class PatchCutter {
 public:
  using Patches = std::vector<std::vector<TriangleId>>;

  PatchCutter(const TriangleMesh& mesh, std::span<const Vec3> centroid, std::size_t most);

  Patches cut(std::span<const TriangleId> cell);

 private:
  std::vector<VertexId> vertices_of(std::span<const TriangleId> patch) const;
  int free_beside(TriangleId triangle) const;
  Patches pieces(std::span<const TriangleId> cell);
  std::vector<TriangleId> grow(TriangleId seed);
  void join(Patches& patches) const;
  void repair(Patches& patches);
  std::vector<std::int32_t> around(std::int32_t patch, const Patches& patches) const;

  const TriangleMesh& mesh_;
  std::span<const Vec3> centroid_;
  std::size_t most_;
  std::vector<bool> free_;              // triangles that are in no patch yet
  std::vector<std::int32_t> patch_of_;  // of triangles under repair, else -1
  // Of the patch that grows; else empty.
  std::vector<std::uint8_t> corners_taken_;  // of each triangle: how many of its corners are in it
  std::vector<bool> taken_;                  // whether a vertex is in it
  std::vector<TriangleId> touched_;          // triangles that were free and have a corner in it, in order
  // Of the patch that has grown last.
  std::vector<VertexId> vertices_;
};

}  // namespace cscd::fast
