#include "baselines/mcd/mcd.h"

#include <optional>

#include "baselines/mcd/contour.h"
#include "baselines/mcd/discs.h"
#include "baselines/mcd/normal_cones.h"
#include "core/detect/compose.h"
#include "core/hierarchy/overlap_descent.h"

// Idea: let a patch face one direction throughout the interval, and let its contour, seen from there, never
// cross itself. Then the patch does not touch itself, and no pair inside it has to be tested (Volino and
// Magnenat-Thalmann 1994; over an interval: Provot 1997 and Tang et al. 2009).
//
// Proof that a dropped pair is apart: every triangle below the node has n(t) . d > 0 for one d and all t, so
// the projection along d keeps the patch's orientation. The patch is a disc, and its projected contour is a
// simple curve at all t. Then the sum of all angles leaves no room for a vertex around which the projection
// winds twice. Every point of the plane is covered as often as the contour winds round it, which is once or
// never. So the projection is one to one, and features without a common vertex do not touch. The proof asks
// nothing of the rest of the mesh or of the start, so the guarantee is `complete`, on open meshes too. All
// signs are certain against rounding; if one is in doubt, the descent goes on.
//
// Fidelity: the paper's text could not be had; this follows what later papers and its authors' code tell
// about it. Cones are merged around both children, which gives closer cones than Provot's rule. The contour
// test has boxes of projected edges at both ends of the interval instead of over the whole path, in a
// hierarchy over the contour. Patches are the nodes of the tree that all strategies here share, and pairs
// of nodes with a common edge, whose contours are looked up. Patches that are no discs (rings, several
// pieces) are not tried and are left to the bounds. The same paper's representative triangles and orphan
// sets are the strategy `selfccd`. Here, as in all strategies but that one, a feature pair is tested once,
// whichever triangle pair brings it.
//
// Cones are updated in `classify`, so their time counts as `rv_update`, as the classes of triangles do for
// the radial strategies. It does not count as refit, which the paper leaves out of its totals.
//
// Tuning: normals are computed in vector code. The contour is tested only if the cone holds, its pairs of
// boxes are found by a hierarchy, and the first pair that fails ends the test. Below kFewest corners, testing
// the pairs themselves costs less than the proof; the number was chosen on the rope out of 2, 4, 8 and 16.
namespace cscd {
namespace {

// Corners of the smallest contour that is tried.
constexpr std::size_t kFewest = 4;

class McdCuller : public Culler {
 public:
  explicit McdCuller(const StrategyInput& setup)
      : mesh_(setup.mesh),
        tree_(build_tree(mesh_, setup.reference)),
        bounds_(mesh_, tree_, setup.pipeline),
        discs_(mesh_, tree_),
        cones_(mesh_, tree_, setup.pipeline) {}

  bool keeps_all() const override { return true; }
  void refit(const Step& step) override { bounds_.refit(step.motion); }

  bool classify(const Step& step) override {
    cones_.update(tree_, step.motion);
    motion_ = step.motion;
    return true;
  }

  CullCounts cull(TrianglePairSink& sink) override {
    contour_.restart();
    const auto is_leaf = [&](NodeIndex node) { return tree_.is_leaf(node); };
    const auto skip = [&](NodeIndex a, NodeIndex b) {
      return a == b ? never_touches_itself(discs_.contour(a), cones_[a]) : neighbours_never_touch(a, b);
    };
    const auto emit = [&](NodeIndex a, NodeIndex b) { sink.add(tree_.triangle(a), tree_.triangle(b)); };
    CullCounts counts;
    counts.bvot = self_descent(tree_, bounds_, 0, is_leaf, skip, emit);
    counts.contour_box_tests = contour_.box_tests();
    return counts;
  }

 private:
  bool never_touches_itself(std::span<const VertexId> contour, const mcd::NormalCone& cone) {
    return contour.size() >= kFewest && cone.in_half_space() && contour_.simple(contour, cone.axis, *motion_);
  }
  // Returns whether two patches together never touch themselves.
  bool neighbours_never_touch(NodeIndex a, NodeIndex b) {
    const std::span<const VertexId> contour = discs_.contour(a, b);
    return contour.size() >= kFewest && never_touches_itself(contour, merged(cones_[a], cones_[b]));
  }

  const TriangleMesh& mesh_;
  Tree tree_;
  SweptBounds bounds_;
  mcd::Discs discs_;
  mcd::NormalCones cones_;
  mcd::ContourTest contour_;
  std::optional<Motion> motion_;  // of the present interval
};

}  // namespace

Prepared make_mcd(const StrategyInput& setup) {
  return {compose(std::make_unique<McdCuller>(setup), setup, {.owners = true}), {}};
}

}  // namespace cscd
