#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/detect/culler.h"

namespace cscd {

// Two triangles that are near each other in some pose.
struct NearPair {
  // What the two carry is at least so far apart in that pose; 0 where they cross, however far that is.
  double low;
  TrianglePair pair;
};

// Takes pairs of triangles, and lists those that are within a reach of each other in a pose. Where that is
// more than the list may hold, gives up the half that is farthest, and reaches less far from then on. Closes
// where even that does not make the list short enough.
class NearCollector : public TrianglePairSink {
 public:
  // The mesh, the pose and the list, which has to be empty, must outlive the collector.
  NearCollector(const TriangleMesh& mesh, std::span<const Vec3> pose, std::size_t most, double reach,
                std::vector<NearPair>& out);
  // Every pair that was passed on and is not in the list is farther apart than this.
  double reach() const { return reach_; }

 private:
  void take(const std::vector<TrianglePair>& block) override;
  void reach_less_far();

  const TriangleMesh& mesh_;
  std::span<const Vec3> pose_;
  std::size_t most_;
  double reach_;
  std::vector<NearPair>& out_;
};

}  // namespace cscd
