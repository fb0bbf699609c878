#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/fast/certify/certificates.h"
#include "core/fast/contour/caps.h"
#include "core/fast/prepare/cluster_observer.h"
#include "core/fast/prepare/cut_surface.h"

namespace cscd::fast {

// The first cover follows a surface that has left the pose it was cut in: where the observer of a cluster no
// longer sees it, the cluster gets another observer or is halved, and where one observer sees two halves
// again, they are joined.
//
// A cluster is what lies below one node of the tree over patches. So no patch is cut anew, labels of inner
// nodes stay as good as they were, and a cluster never leaves the cluster that preparation gave it.
//
// What an interval costs decides how much is done after it, and its certificates decide where. No clock is
// asked: the same intervals in the same order are always answered alike. Another order makes other clusters,
// which by the theorems of core/soundness.md changes counters and nothing that a strategy promises.
class AdaptiveCover {
 public:
  // `cut` is what will be cut anew. It, the mesh, and the pose in which it was cut, `reference` [vertices],
  // must outlive this.
  AdaptiveCover(const TriangleMesh& mesh, std::span<const Vec3> reference, CutSurface& cut);

  // Between two intervals: puts everything back to what preparation made.
  void forget(Certificates& certificates);
  // Before every interval: the same, if an exception has left a change of clusters half done.
  void mend(Certificates& certificates) {
    if (!whole_) forget(certificates);
  }
  // False once an exception has broken off a change of clusters, until mend() has undone it.
  bool whole() const { return whole_; }

  // Between two intervals. `tests` is the number of overlap tests that the last one took, `certificates` are
  // those of the last one, and `positions`, [vertices], is the pose in which the next one starts.
  void follow(std::span<const Vec3> positions, std::uint64_t tests, Certificates& certificates);

 private:
  struct Cluster {
    std::size_t node;
    std::uint64_t renewed;   // interval of the last search for an observer; 0 where none was searched
    bool failed;             // whether no better observer is to be hoped for
    std::uint32_t negative;  // how many triangles the first cover alone certified, as negative
    // How many triangles no cover certified in the last interval, with those of the rarer sign.
    std::uint32_t uncertified;
  };
  struct Below {              // what lies below a node of the tree
    std::size_t first, last;  // its patches
    std::uint32_t triangles;
    // Its parent, where that lies in one prepared cluster too, or kNone.
    std::int32_t parent = kNone;
    std::int32_t cluster = kNone;  // the cluster that is this node, or kNone
    std::uint64_t not_before = 0;  // the interval before which joining the halves is not tried again
    std::uint32_t wait;            // for how many intervals joining is put off the next time
  };

  void count_uncertified(const Certificates& certificates);
  void cut_failing();
  void halve(std::size_t cluster);
  void join_halves();
  void put_off(Below& whole) const;
  std::span<const TriangleId> triangles_below(std::size_t node);
  Sight sight_of(std::size_t node);
  void assign(std::size_t cluster, std::size_t node, const FollowingPoint& observer);
  std::size_t add(std::size_t node, const FollowingPoint& observer);
  void remove(std::size_t cluster);
  void relabel(std::size_t cluster);

  const TriangleMesh& mesh_;
  std::span<const Vec3> reference_;
  CutSurface& cut_;
  std::vector<std::size_t>
      prepared_nodes_;  // what preparation made: the node of each cluster, and its observer
  std::vector<FollowingPoint> prepared_observers_;
  CapBuilder builder_;
  std::vector<Below> below_;       // [nodes]
  std::vector<Cluster> clusters_;  // of the first cover
  std::uint32_t least_halved_;     // the fewest triangles of a cluster that is halved
  bool begun_ = false;             // whether the surface has left the pose it was cut in
  bool whole_ = true;              // false while clusters are changed
  std::uint64_t interval_ = 0;
  std::size_t next_to_join_ = 0;
  std::int64_t budget_;  // in overlap tests; negative for what is owed
  // While follow() runs:
  std::span<const Vec3> positions_;
  Certificates* certificates_ = nullptr;
  std::vector<std::size_t> failing_;
  std::vector<TriangleId> triangles_, targets_;
};

}  // namespace cscd::fast
