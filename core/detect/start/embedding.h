#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/detect/culler.h"
#include "core/detect/start/crossings.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// The most crossing pairs that are kept of one pose, eight bytes each. A surface with more has collapsed.
constexpr std::size_t kMostCrossings = std::size_t{1} << 22;

// Decides exactly whether a pose is *embedded*: no two triangles meet outside the vertices and edges that
// they share. In an embedded pose no feature pair touches and no edge pierces a face. The theorem behind the
// guarantee `first_contact` needs an embedded start (rule embedded-start, core/soundness.md).
//
// A culler is asked about the interval in which the surface rests in the pose, and every pair of triangles
// that it passes on is tested exactly.
class EmbeddingTest {
 public:
  // Culls by one hierarchy of bounds, built by the first search from the positions `reference` ([vertices]);
  // any pose will do. `mesh` must outlive the object.
  EmbeddingTest(const TriangleMesh& mesh, std::span<const Vec3> reference);
  // Culls by `culler`, which must be made for this mesh. It may drop a pair of triangles only by a proof that
  // the two *meet* nowhere but in what they share. A proof that no feature pair of theirs touches is not
  // enough, because an edge can pierce a face (theorem "a pose is an interval at rest", core/soundness.md).
  EmbeddingTest(const TriangleMesh& mesh, std::unique_ptr<Culler> culler);

  const TriangleMesh& mesh() const { return *mesh_; }

  // Returns two triangles that meet, or nothing if the pose is embedded.
  std::optional<CrossingPair> find_intersection(std::span<const Vec3> positions);
  bool embedded(std::span<const Vec3> positions) { return !find_intersection(positions); }

  // Counts all pairs that meet, and keeps up to `most` of them.
  Crossings find_all(std::span<const Vec3> positions, std::size_t most);

  // Returns the number of pairs of triangles that the culler left for the exact test in the last pose.
  std::uint64_t pairs_tested() const { return pairs_tested_; }

 private:
  // Calls found(pair) for every triangle pair that meets, until found() returns false.
  void search(std::span<const Vec3> positions, const std::function<bool(const CrossingPair&)>& found);

  const TriangleMesh* mesh_;
  std::unique_ptr<Culler> culler_;
  std::vector<Vec3> reference_;  // until there is a culler
  std::uint64_t pairs_tested_ = 0;
};

}  // namespace cscd
