#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// A surface of few triangles in the shape of a surface of many, on which clusters are found in a fraction of
// the time. No promise rests on how alike the two are, because the proofs hold for any clusters.
//
// The surface is made coarser level by level. On each level some vertices are *kept*, no two of them
// neighbours, and every other vertex belongs to the nearest kept vertex beside it. The next level has the
// triangles whose corners belong to three different kept vertices. All vertices are kept where a level
// would otherwise lose a connected component, or would no longer be closed, as at a thin limb.
class CoarseSurface {
 public:
  // Stops once a level has no more than `enough` triangles, or where no level with clearly fewer triangles
  // has all connected components and is closed if the mesh is. The mesh and its positions must outlive the
  // coarse surface.
  CoarseSurface(const TriangleMesh& mesh, std::span<const Vec3> positions, std::size_t enough);

  bool is_coarser() const { return !levels_.empty(); }
  const TriangleMesh& mesh() const { return levels_.empty() ? mesh_ : levels_.back()->mesh; }
  std::span<const Vec3> positions() const {
    return levels_.empty() ? positions_ : std::span<const Vec3>(levels_.back()->positions);
  }

  // Returns labels of the coarse surface's vertices from labels of the vertices that it was made of: each has
  // the label of one of the vertices that belong to it.
  std::vector<std::int32_t> coarse_labels(std::span<const std::int32_t> label_of) const;
  // Carries labels of the coarse surface's triangles over to the triangles of the surface that it was made
  // of, with straight seams. Labels are not negative, and a label never leaves its connected component.
  std::vector<std::int32_t> carried(std::vector<std::int32_t> label_of) const;

 private:
  struct Level {
    std::vector<std::int32_t> kept;  // [vertices of the finer level]: the number here of the vertex it
                                     // belongs to; kNone for one without triangles
    TriangleMesh mesh;
    std::vector<Vec3> positions;
    std::vector<std::size_t> left;  // [components of the finer level]: how many triangles each has left
  };
  static std::unique_ptr<Level> coarser(const TriangleMesh& mesh, std::span<const Vec3> positions);
  // The level on which these vertices are kept. Null if it would have no triangle.
  static std::unique_ptr<Level> level_with(const TriangleMesh& mesh, std::span<const Vec3> positions,
                                           const std::vector<bool>& has_to_stay);
  // Marks vertices that have to stay: the vertices of a component that the level has lost, and the vertices
  // about a place where the level is not closed although the mesh is. Returns whether there were any.
  static bool keep_what_fails(const TriangleMesh& mesh, const Level& level, std::vector<bool>& has_to_stay);

  const TriangleMesh& mesh_;
  std::span<const Vec3> positions_;
  std::vector<std::unique_ptr<Level>> levels_;
};

}  // namespace cscd::fast
