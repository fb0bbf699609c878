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
  void set_free(TriangleId triangle, bool free);
  int free_beside(TriangleId triangle) const;  // of a free one
  Patches pieces(std::span<const TriangleId> cell);
  std::vector<TriangleId> grow(TriangleId seed);
  void join(Patches& patches) const;
  void empty_small(Patches& patches);
  bool move(TriangleId triangle, Patches& patches);
  std::vector<std::int32_t> patches_beside(TriangleId triangle) const;
  struct Room {
    bool is_free;
    std::vector<TriangleId> in_place_of;  // those of which one would have to go
  };
  Room room_for(TriangleId triangle, std::span<const TriangleId> patch);
  bool is_left(std::int32_t patch, std::size_t at) const;
  void move_all(std::size_t at, std::int32_t to, Patches& patches);

  const TriangleMesh& mesh_;
  std::span<const Vec3> centroid_;
  std::size_t most_;
  std::vector<bool> free_;             // triangles that are in no patch yet
  std::vector<std::int32_t> free_at_;  // of each edge: how many of them have it
  std::vector<bool> is_beside_;        // triangles that are free beside some patch
  // Of the patch that grows; else empty.
  std::vector<std::uint8_t> corners_taken_;  // of each triangle: how many of its corners are in it
  std::vector<bool> taken_;                  // whether a vertex is in it
  std::vector<TriangleId> touched_;          // triangles that were free and have a corner in it, in order
  // Of the patch that has grown last.
  std::vector<VertexId> vertices_;
  // While small patches are emptied.
  struct Seeking {
    TriangleId triangle;
    std::size_t for_whom;  // place of the one that gets its room; its own, 0, of the first
  };
  std::vector<std::int32_t> patch_of_;  // of each triangle; else -1
  std::vector<Seeking> seeking_;        // triangles that one after the other look for room; else empty
  std::vector<bool> seeks_;             // whether a triangle is among them
  std::vector<std::uint8_t> uses_;      // of each vertex, by the triangles of a patch; else 0
};

}  // namespace cscd::fast
