#pragma once

#include <numeric>

#include "core/detect/culler.h"
#include "core/detect/strategy.h"
#include "core/radial/bone_observer.h"
#include "core/radial/cluster_hierarchy.h"
#include "core/radial/orientation.h"

// Clusters and observers come from the reference pose and stay as they are: heat diffusion at full
// resolution, one cluster for each bone, viewed from the bone's centre or along the bone. In every interval
// the triangles are classified, and then pairs within and between clusters are found over the same
// hierarchies and bounds, and tested by the same elementary tests, as in every other strategy.
//
// Fidelity: the text of 2013 could not be had; this follows what the 2014 paper says about it (sections 3.1,
// 4.1 and 7). Relative boxes are the 2014 paper's addition, so only the ablation's row has them.
namespace cscd {

class RvbcCuller : public Culler {
 public:
  RvbcCuller(const StrategyInput& setup, radial::AtomicClusters clusters,
             std::vector<radial::ObserverKind> kinds)
      : clusters_(std::move(clusters)),
        kinds_(std::move(kinds)),
        hierarchy_(setup.mesh, setup.reference, clusters_, setup.pipeline),
        table_(setup.mesh, hierarchy_.groups(), radial::SegmentTest::all_corners, setup.pipeline),
        unmerged_(clusters_.clusters.size()) {
    std::iota(unmerged_.begin(), unmerged_.end(), 0);
  }

  bool knows_distance(const Thickness& thickness) const override { return thickness.is_uniform(); }
  void refit(const Step& step) override { hierarchy_.refit(step.motion, step.thickness.largest()); }

  bool classify(const Step& step) override {
    table_.update(step.motion);
    observers_.clear();
    for (std::size_t c = 0; c < kinds_.size(); ++c) {
      const std::size_t bone = +clusters_.clusters[c].bone;
      observers_.push_back(radial::observer(kinds_[c], step.bones->start[bone], step.bones->end[bone]));
      table_.classify(c, observers_.back(), hierarchy_.classes(c));
    }
    if (!step.thickness.is_zero()) hierarchy_.keep_distant(step.motion, unmerged_, observers_);
    radial_ = hierarchy_.finish_classes();
    radial_.clusters = kinds_.size();
    return true;
  }

  CullCounts cull(TrianglePairSink& sink) override {
    CullCounts counts = hierarchy_.cull(unmerged_, sink);
    counts.radial = radial_;
    return counts;
  }

  RadialView radial_view() const override { return hierarchy_.view(unmerged_, observers_); }

 protected:
  radial::AtomicClusters clusters_;
  std::vector<radial::ObserverKind> kinds_;
  radial::ClusterHierarchy hierarchy_;
  radial::OrientationTable table_;
  std::vector<std::int32_t> unmerged_;
  std::vector<radial::Observer> observers_;  // [clusters]
  RadialCounts radial_;
};

}  // namespace cscd
