#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/mesh/rig.h"
#include "core/radial/atomic_clusters.h"
#include "core/radial/bone_observer.h"
#include "core/radial/cluster_hierarchy.h"
#include "core/radial/orientation.h"

namespace cscd {

// Dynamic cluster assembling (section 5 of the 2014 paper). At every interval, atomic clusters are merged
// from scratch into mega clusters. The observer of a mega cluster is the joint that its first two clusters
// share. A candidate joins while the share of its triangles that are not positive towards that joint is below
// gamma.
//
// Differences to the text. The order of seeds is a fixed shuffle instead of a random one, so that results
// depend on the interval alone (rule fresh-detector). The cost D is computed for the seed as well when its
// observer moves to the joint: the paper looks at the candidate only and may turn any number of the seed's
// triangles non-positive unnoticed.
class MegaClusters {
 public:
  // Without `cache` no triangles are remembered from the last interval. With gamma = 0 nothing merges and
  // nothing is tried.
  MegaClusters(const radial::AtomicClusters& atomic, const Rig& rig, std::vector<radial::ObserverKind> kinds,
               double gamma, bool cache = true);

  // Merges the clusters of one interval, and writes the class of every triangle towards its mega cluster's
  // observer into the hierarchy.
  void regrow(const radial::OrientationTable& table, const Rig::Interval& bones,
              radial::ClusterHierarchy& hierarchy);

  // [atomic clusters]: the mega cluster of each.
  std::span<const std::int32_t> labels() const { return label_; }
  std::size_t count() const { return observers_.size(); }
  // [mega clusters]: where the observer of each stood in the last interval.
  std::span<const radial::Observer> observers() const { return observers_; }

 private:
  bool fits(std::size_t cluster, const radial::Observer& observer, const radial::OrientationTable& table,
            radial::ClusterHierarchy& hierarchy);
  bool merge_first_neighbour(std::size_t seed, radial::Observer& observer,
                             const radial::OrientationTable& table, const Rig::Interval& bones,
                             radial::ClusterHierarchy& hierarchy);
  std::optional<MovingPoint> shared_joint(std::size_t a, std::size_t b, const Rig::Interval& bones) const;

  const radial::AtomicClusters& atomic_;
  const Rig& rig_;
  std::vector<radial::ObserverKind> kinds_;
  double gamma_;
  bool cache_;
  std::vector<std::size_t> seeds_;   // all atomic clusters, in the order in which they become seeds
  std::vector<std::int32_t> label_;  // [atomic clusters]
  std::vector<radial::Observer> observers_;
  // The paper's cache. Members that were not positive in the last interval are looked at first, because they
  // will probably decide against a merge. The cache saves work and never changes a decision (rule
  // fresh-detector).
  std::vector<std::vector<std::uint32_t>> suspects_;
  std::vector<std::size_t> members_;  // members of the mega cluster that is growing
  std::vector<std::int32_t>
      refused_by_;  // [atomic clusters]: the last mega cluster that did not take this one in
};

}  // namespace cscd
