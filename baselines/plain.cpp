#include "baselines/plain.h"

#include "core/detect/compose.h"
#include "core/detect/plain_culler.h"

namespace cscd {
namespace {

class BruteCuller : public Culler {
 public:
  explicit BruteCuller(std::int32_t triangles) : triangles_(triangles) {}

  bool knows_distance(const Thickness& /*thickness*/) const override { return true; }
  bool keeps_all() const override { return true; }
  void refit(const Step&) override {}
  CullCounts cull(TrianglePairSink& sink) override {
    for (std::int32_t a = 0; a < triangles_; ++a)
      for (std::int32_t b = a + 1; b < triangles_; ++b) sink.add(TriangleId{a}, TriangleId{b});
    return {};
  }

 private:
  std::int32_t triangles_;
};

}  // namespace

Prepared make_base(const StrategyInput& setup) {
  return {compose(std::make_unique<PlainCuller<Kdop16>>(setup), setup, {.owners = true}), {}};
}

// Idea: a box has three pairs of planes. It takes half the memory of a 16-DOP and is quicker to refit and to
// compare, but lets more triangle pairs through.
//
// Fidelity: boxes are refitted bottom-up, as published, and swept over the interval, as the paper's use of
// the method asks. The tree is the one that all strategies here share: it splits at the median of the
// centroids and has one triangle a leaf. The published tree splits at the middle of the box. The descent here
// enters both children at once; the published one descends into the larger volume. So this strategy differs
// from `base` in its bounds alone.
//
// Tuning: as much as for `base`, whose code it is. The boxes of vertices and the comparison of two boxes,
// half a cache line each, are in vector code.
//
// A dropped pair is proven apart, because its swept boxes are disjoint.
Prepared make_aabb(const StrategyInput& setup) {
  return {compose(std::make_unique<PlainCuller<Aabb>>(setup), setup, {.owners = true}), {}};
}

Prepared make_brute(const StrategyInput& setup) {
  auto culler = std::make_unique<BruteCuller>(static_cast<std::int32_t>(setup.mesh.triangle_count()));
  return {compose(std::move(culler), setup, {.owners = true}), {}};
}

}  // namespace cscd
