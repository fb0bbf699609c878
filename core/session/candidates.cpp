#include "core/session/candidates.h"

#include <algorithm>
#include <limits>

#include "core/base/stage_clock.h"
#include "core/detect/carried_pairs.h"
#include "core/fast/trial.h"

namespace cscd {
namespace {

struct Box {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;

  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

template <class Vertices>
Box box_of(const Motion& motion, const Vertices& vertices) {
  Box box;
  for (const VertexId v : vertices) {
    box.add(motion.start()[+v]);
    box.add(motion.end()[+v]);
  }
  return box;
}

// The difference of two bounds rounds by half a unit in its last place, and the radius gives way by more.
bool within(const Box& a, const Box& b, double radius) {
  constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();
  for (int k = 0; k < 3; ++k) {
    const double gap = std::max(a.low[k] - b.high[k], b.low[k] - a.high[k]);
    if (gap > radius + kRounding * (radius + std::abs(gap))) return false;
  }
  return true;
}

bool within(const TriangleMesh& mesh, const Motion& motion, const FeaturePair& pair,
            const Thickness& thickness) {
  const double radius = thickness.of(mesh, pair);
  if (pair.kind == FeaturePair::Kind::vertex_face)
    return within(box_of(motion, std::array{VertexId{pair.a}}),
                  box_of(motion, mesh.corners(TriangleId{pair.b})), radius);
  return within(box_of(motion, mesh.ends(EdgeId{pair.a})), box_of(motion, mesh.ends(EdgeId{pair.b})), radius);
}

}  // namespace

void CandidateSet::take(const Motion& motion, const Thickness& thickness, const TrianglePair& pair,
                        std::vector<FeaturePair>& out) {
  if (exclusions_ != nullptr && exclusions_->excludes(mesh_, pair)) return;
  for_each_carried(mesh_, pair, [&](const FeaturePair& features) {
    if (!within(mesh_, motion, features, thickness) || !met_.insert(features)) return;
    if (exclusions_ == nullptr || !exclusions_->excludes(mesh_, features)) out.push_back(features);
  });
}

// A complete culler passes on every triangle pair of which features come within the thickness.
void CandidateSearch::find(const Motion& motion, const Thickness& thickness, std::vector<FeaturePair>& out) {
  out.clear();
  set_.start_step();
  if (!culler_) {
    StageClock clock;
    clock.enter(Stage::decomposition);
    culler_ = fast::best_trial_culler(setup_, {.name = "candidates", .complete = true}, clock).culler;
  }
  const Step step{.motion = motion, .thickness = thickness};
  CandidateSink sink(set_, motion, thickness, out);
  culler_->refit(step);
  culler_->classify(step);
  culler_->cull(sink);
  sink.flush();
}

}  // namespace cscd
