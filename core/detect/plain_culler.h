#pragma once

#include "core/detect/culler.h"
#include "core/detect/strategy.h"
#include "core/hierarchy/overlap_descent.h"
#include "core/mesh/adjacency.h"

namespace cscd {

// Passes on all triangle pairs whose swept bounds overlap, found by one descent of one hierarchy. If
// `kAdjacent` is false, it passes on only pairs without a common vertex. Dropping the others is proven,
// because the bounds are rounded outward (rule outward-rounding, core/soundness.md).
template <class Volume, bool kAdjacent = true>
class PlainCuller : public Culler {
 public:
  explicit PlainCuller(const StrategyInput& setup)
      : PlainCuller(setup.mesh, setup.reference, setup.pipeline) {}
  // `mesh` must outlive the culler. `reference`, [vertices], shapes the tree.
  PlainCuller(const TriangleMesh& mesh, std::span<const Vec3> reference,
              Pipeline pipeline = Pipeline::vectorised)
      : mesh_(mesh), tree_(build_tree(mesh_, reference)), bounds_(mesh_, tree_, pipeline) {}

  bool knows_distance(const Thickness& /*thickness*/) const override { return true; }
  bool keeps_all() const override { return kAdjacent; }
  void refit(const Step& step) override { bounds_.refit(step.motion, step.thickness.largest() / 2); }

  CullCounts cull(TrianglePairSink& sink) override {
    const auto is_leaf = [&](NodeIndex node) { return tree_.is_leaf(node); };
    const auto skip_once_closed = [&](NodeIndex, NodeIndex) { return sink.closed(); };
    const auto emit = [&](NodeIndex a, NodeIndex b) {
      const TriangleId t = tree_.triangle(a), u = tree_.triangle(b);
      if (kAdjacent || !share_vertex(mesh_.corners(t), mesh_.corners(u))) sink.add(t, u);
    };
    CullCounts counts;
    counts.bvot = self_descent(tree_, bounds_, 0, is_leaf, skip_once_closed, emit);
    return counts;
  }

 private:
  const TriangleMesh& mesh_;
  Tree tree_;
  SweptVolumes<Volume> bounds_;
};

}  // namespace cscd
