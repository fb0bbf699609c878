#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Cuts sets of triangles into few patches. A patch has at most `most` triangles with at most `most` vertices.
// There should be few patches, because an interval spends the same time on each, however full the patch is.
class PatchCutter {
 public:
  using Patches = std::vector<std::vector<TriangleId>>;

  // `centroid` is [triangles]. The mesh and the centroids must outlive the cutter.
  PatchCutter(const TriangleMesh& mesh, std::span<const Vec3> centroid, std::size_t most);

  // Returns the patches of one cell (patches.h). Every triangle of the cell is in exactly one of them.
  Patches cut(std::span<const TriangleId> cell);

 private:
  std::vector<VertexId> vertices_of(std::span<const TriangleId> patch) const;
  void set_free(TriangleId triangle, bool free);
  int free_beside(TriangleId triangle) const;  // number of free neighbours of a free triangle
  Patches pieces(std::span<const TriangleId> cell);
  std::vector<TriangleId> grow(TriangleId seed);
  void join(Patches& patches) const;
  void empty_small(Patches& patches);
  bool move(TriangleId triangle, Patches& patches);
  std::vector<std::int32_t> patches_beside(TriangleId triangle) const;
  struct Room {                           // that a patch has for one more triangle
    bool is_free;                         // the triangle fits
    std::vector<TriangleId> in_place_of;  // the triangle fits if any one of these leaves the patch
  };
  Room room_for(TriangleId triangle, std::span<const TriangleId> patch);
  bool is_left(std::int32_t patch, std::size_t at) const;
  void move_all(std::size_t at, std::int32_t to, Patches& patches);

  const TriangleMesh& mesh_;
  std::span<const Vec3> centroid_;
  std::size_t most_;
  std::vector<bool> free_;             // triangles that are in no patch yet
  std::vector<std::int32_t> free_at_;  // [edges]; number of free triangles at the edge
  std::vector<bool> is_beside_;        // [triangles]; a free triangle that shares a vertex with a patch
  // While a patch grows. All zero at other times.
  std::vector<std::uint8_t> corners_taken_;  // [triangles]; number of corners that the patch has
  std::vector<bool> taken_;                  // [vertices]; whether the patch has the vertex
  // The patch that grows, or grew last.
  std::vector<TriangleId> touched_;  // triangles that were free when the patch took one of their corners
  std::vector<VertexId> vertices_;   // that the patch has
  // While small patches are emptied.
  struct Seeking {  // a triangle that seeks room in a patch beside it
    TriangleId triangle;
    std::size_t for_whom;  // index in `seeking_` of the triangle that would take its place; 0 for the first
  };
  std::vector<std::int32_t> patch_of_;  // [triangles]; -1 at other times
  std::vector<Seeking> seeking_;        // in the order in which they are asked; empty at other times
  std::vector<bool> seeks_;             // [triangles]; whether the triangle is in `seeking_`
  std::vector<std::uint8_t> uses_;      // [vertices]; triangles of a patch at the vertex; 0 at other times
};

}  // namespace cscd::fast
