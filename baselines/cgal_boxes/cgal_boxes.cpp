#include "baselines/cgal_boxes/cgal_boxes.h"

#include <CGAL/Box_intersection_d/Box_d.h>
#include <CGAL/box_intersection_d.h>
#include <vector>

#include "core/detect/compose.h"
#include "core/hierarchy/package_box.h"

// Idea: instead of a hierarchy that is kept, a streamed segment tree with a scan below a cut-off, made anew
// for every set of boxes. It is proven to take O(n log^3 n + pairs).
//
// Fidelity: the package as it is, in its mode for pairs within one set, with closed boxes. The boxes are
// those of the strategy `aabb`, rounded outward. Filter and elementary test follow as for all strategies. The
// package does not tell how many boxes it compares, so there is no number of overlap tests.
//
// Tuning: one thread; pointers to boxes instead of boxes, as the package's manual advises; the cut-off below
// which it scans was chosen on the rope.
//
// The proof that a dropped pair is apart rests on CGAL's own code and proof.
namespace cscd {
namespace {

constexpr std::ptrdiff_t kScanBelow = 200;  // boxes
// The package's segment tree spans the floats; boxes at the very end of their range would be lost.
constexpr float kFarthest = 1e38F;

using Box = CGAL::Box_intersection_d::Box_d<float, 3, CGAL::Box_intersection_d::ID_FROM_BOX_ADDRESS>;

class CgalBoxesCuller : public Culler {
 public:
  explicit CgalBoxesCuller(const StrategyInput& setup)
      : mesh_(setup.mesh), of_vertex_(mesh_.vertex_count()), boxes_(mesh_.triangle_count()) {}

  bool keeps_all() const override { return true; }
  void refit(const Step& step) override {
    swept_vertex_bounds(step.motion, std::span(of_vertex_));
    pointers_.clear();
    for (std::size_t t = 0; t < boxes_.size(); ++t) {
      PackageBox box(swept_triangle<Aabb>(mesh_.triangles()[t], of_vertex_), kFarthest);
      boxes_[t] = Box(box.low, box.high);
      pointers_.push_back(&boxes_[t]);
    }
  }

  CullCounts cull(TrianglePairSink& sink) override {
    const auto triangle = [this](const Box* box) {
      return TriangleId{static_cast<std::int32_t>(box - boxes_.data())};
    };
    CGAL::box_self_intersection_d(
        pointers_.begin(), pointers_.end(),
        [&](const Box* a, const Box* b) { sink.add(triangle(a), triangle(b)); }, kScanBelow,
        CGAL::Box_intersection_d::CLOSED);
    CullCounts counts;
    counts.bvot.reset();
    return counts;
  }

 private:
  const TriangleMesh& mesh_;
  std::vector<Aabb> of_vertex_;
  std::vector<Box> boxes_;  // of the triangles
  std::vector<const Box*> pointers_;
};

}  // namespace

Prepared make_cgal_boxes(const StrategyInput& setup) {
  return {compose(std::make_unique<CgalBoxesCuller>(setup), setup, {.owners = true}), {}};
}

}  // namespace cscd
