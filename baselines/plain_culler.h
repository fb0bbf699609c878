#pragma once

#include "core/detect/culler.h"
#include "core/detect/strategy.h"
#include "core/hierarchy/descent.h"

namespace cscd {

// All triangle pairs whose bounds overlap, by one descent of one hierarchy. A "no" is a proof because the
// bounds are rounded outward.
template <class Volume>
class PlainCuller : public Culler {
 public:
  explicit PlainCuller(const Setup& setup)
      : mesh_(setup.mesh), tree_(build_tree(mesh_, setup.reference)), bounds_(mesh_, tree_) {}

  void refit(const Motion& motion) override { bounds_.refit(mesh_, tree_, motion); }

  CullCounts cull(TrianglePairSink& sink) override {
    const auto is_leaf = [&](NodeIndex node) { return tree_.is_leaf(node); };
    const auto skip_none = [](NodeIndex, NodeIndex) { return false; };
    const auto emit = [&](NodeIndex a, NodeIndex b) { sink.add(tree_.triangle(a), tree_.triangle(b)); };
    CullCounts counts;
    counts.bvot = self_descent(tree_, bounds_, 0, is_leaf, skip_none, emit);
    return counts;
  }

 private:
  const TriangleMesh& mesh_;
  Tree tree_;
  SweptVolumes<Volume> bounds_;
};

}  // namespace cscd
