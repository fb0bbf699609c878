#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/mesh/rig.h"
#include "core/radial/atomic_clusters.h"
#include "core/radial/cluster_hierarchy.h"
#include "core/radial/observer.h"
#include "core/radial/orientation.h"

namespace cscd {

// Dynamic cluster assembling (section 5 of the 2014 paper). At every interval, atomic clusters are merged
// from scratch into mega clusters. The observer of a mega cluster is the joint that its first two clusters
// share. A candidate joins while the share of its triangles that are not positive towards that joint is below
// gamma.
//
// There are two differences to the paper's text. The order of seeds is a fixed shuffle instead of a random
// one, so that results depend on the interval alone (rule fresh-detector, core/soundness.md). When the
// observer of a seed moves to the joint, the cost D, the share of triangles that are not positive, is
// computed for the seed as well as for the candidate. The paper computes it for the candidate only, so any
// number of the seed's triangles may turn non-positive unnoticed.
class MegaClusters {
 public:
  // `kinds` is [atomic clusters]. Without `cache` no suspects are kept. With gamma = 0 no merge is tried.
  // Atomic clusters and rig must outlive the mega clusters.
  MegaClusters(const radial::AtomicClusters& atomic, const Rig& rig, std::vector<radial::ObserverKind> kinds,
               double gamma, bool cache = true);

  // Merges the clusters of one interval. Writes the class of every triangle towards the observer of its mega
  // cluster into the hierarchy. `table` must be updated to the interval.
  void regrow(const radial::OrientationTable& table, const Rig::Interval& bones,
              radial::ClusterHierarchy& hierarchy);

  // [atomic clusters]; the number of the mega cluster of each.
  std::span<const std::int32_t> labels() const { return label_; }
  std::size_t count() const { return count_; }

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
  std::size_t count_ = 0;
  // The paper's cache: the triangles of each atomic cluster that were not positive in the last interval. They
  // are classified first, because they will probably decide against a merge. The cache saves work and never
  // changes a decision.
  std::vector<std::vector<std::uint32_t>> suspects_;
  std::vector<std::size_t> members_;      // of the mega cluster that grows
  std::vector<std::int32_t> refused_by_;  // [atomic clusters]; the mega cluster that last refused each
};

}  // namespace cscd
