#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/simd_floats.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Returns the vertices of some triangles, each once.
std::vector<VertexId> vertices_of(const TriangleMesh& mesh, std::span<const TriangleId> triangles);

// Cuts sets of triangles into few patches, each of at most sixteen triangles with at most as many vertices.
// Few patches are the aim, because every patch costs the same, however full.
class PatchCutter {
 public:
  using Patches = std::vector<std::vector<TriangleId>>;

  // `centroid` is [triangles]. The mesh and the centroids must outlive the cutter.
  PatchCutter(const TriangleMesh& mesh, std::span<const Vec3> centroid);

  // Returns the patches of one cell (patches.h). Every triangle of the cell is in exactly one of them.
  Patches cut(std::span<const TriangleId> cell);

 private:
  static constexpr std::size_t kMost = kLanes16;  // triangles, and vertices

  // What is asked of a patch again and again while triangles look for room in it.
  struct Members {
    bool known = false;  // since the patch last changed
    std::size_t vertices = 0;
    std::array<VertexId, kMost> vertex{};
    std::array<Mask16, kMost> only_its_own{};  // of each triangle, the vertices that no other triangle has
  };

  void set_free(TriangleId triangle, bool free);
  int free_beside(TriangleId triangle) const;  // how many free neighbours a free triangle has
  Patches pieces(std::span<const TriangleId> cell);
  std::vector<TriangleId> grow(TriangleId seed);
  void join(Patches& patches);
  void enter(std::size_t patch, std::span<const TriangleId> triangles);
  void leave(Patches& patches);
  void dissolve_small(Patches& patches);
  bool move(TriangleId triangle, Patches& patches);
  void find_patches_beside(TriangleId triangle);
  bool find_room(TriangleId triangle, std::size_t number, std::span<const TriangleId> patch);
  static unsigned place_of(const Members& members, VertexId vertex);
  Members members_of(std::span<const TriangleId> patch);
  bool is_left(std::int32_t patch, std::size_t at) const;
  void move_all(std::size_t at, std::int32_t to, Patches& patches);

  const TriangleMesh& mesh_;
  std::span<const Vec3> centroid_;
  std::vector<bool> free_;             // [triangles]: whether it is in no patch yet
  std::vector<std::int32_t> free_at_;  // [edges]: how many free triangles have it
  static constexpr std::uint8_t kNowhere = 0xff;
  std::vector<std::uint8_t> waits_in_;  // [triangles]: the queue that a free triangle beside a patch waits in
  // State of the patch that is growing; empty at other times.
  std::vector<std::uint8_t> corners_taken_;  // [triangles]: how many of its corners the patch has
  std::vector<bool> taken_;                  // [vertices]: whether the patch has it
  std::vector<TriangleId>
      touched_;  // free triangles with a corner in the patch, in the order in which they were met
  // The vertices of the patch that has grown last.
  std::vector<VertexId> vertices_;
  // State while patches are joined, and small ones emptied into the patches beside them.
  struct MoveRequest {
    TriangleId triangle;
    std::size_t for_whom;  // index of the request that this move makes space for; 0 for the first, which
                           // makes space for none
  };
  std::vector<std::int32_t> patch_of_;  // [triangles]: its patch, or -1
  std::vector<MoveRequest> requests_;   // triangles that look for room one after the other
  std::vector<bool> seeks_;             // [triangles]: whether it is in `requests_`
  std::vector<Members> members_;        // [patches]
  std::vector<bool> no_room_near_;      // [patches]: whether a search through it found no room
  static constexpr std::uint8_t kNoPlace = 0xff;
  std::vector<std::uint8_t> place_;  // [vertices]: its place among a patch's members; kNoPlace at other times
  std::vector<std::int32_t> beside_;     // what find_patches_beside() found
  std::vector<TriangleId> in_place_of_;  // what find_room() found
};

}  // namespace cscd::fast
