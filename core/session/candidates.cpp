#include "core/session/candidates.h"

#include <algorithm>
#include <limits>

#include "core/base/stage_clock.h"
#include "core/detect/carried_pairs.h"
#include "core/fast/trial.h"
#include "core/hierarchy/overlap_descent.h"

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

bool within(const TriangleMesh& mesh, const Motion& motion, const FeaturePair& pair, double radius) {
  if (pair.kind == FeaturePair::Kind::vertex_face)
    return within(box_of(motion, std::array{VertexId{pair.a}}),
                  box_of(motion, mesh.corners(TriangleId{pair.b})), radius);
  return within(box_of(motion, mesh.ends(EdgeId{pair.a})), box_of(motion, mesh.ends(EdgeId{pair.b})), radius);
}

}  // namespace

void CandidateSet::take(const Motion& motion, double radius, const TrianglePair& pair,
                        std::vector<FeaturePair>& out) {
  if (exclusions_ != nullptr && exclusions_->excludes(mesh_, pair)) return;
  for_each_carried(mesh_, pair, [&](const FeaturePair& features) {
    if (!within(mesh_, motion, features, radius) || !met_.insert(features)) return;
    if (exclusions_ == nullptr || !exclusions_->excludes(mesh_, features)) out.push_back(features);
  });
}

void CandidateSearch::find(const Motion& motion, double radius, std::vector<FeaturePair>& out) {
  out.clear();
  set_.start_step();
  if (radius == 0)
    find_touching(motion, out);
  else
    find_near(motion, radius, out);
}

// What comes within a radius of 0 touches, and a complete culler passes on every triangle pair of which
// features touch.
void CandidateSearch::find_touching(const Motion& motion, std::vector<FeaturePair>& out) {
  if (!culler_) {
    StageClock clock;
    clock.enter(Stage::decomposition);
    culler_ = fast::best_trial_culler(setup_, {.name = "candidates", .complete = true}, clock).culler;
  }
  CandidateSink sink(set_, motion, 0, out);
  culler_->refit({motion});
  culler_->classify({motion});
  culler_->cull(sink);
  sink.flush();
}

void CandidateSearch::find_near(const Motion& motion, double radius, std::vector<FeaturePair>& out) {
  if (!tree_) {
    tree_ = build_tree(setup_.mesh, setup_.reference);
    bounds_.emplace(setup_.mesh, *tree_);
  }
  bounds_->refit(motion, radius / 2);
  const auto is_leaf = [&](NodeIndex node) { return tree_->is_leaf(node); };
  const auto skip_none = [](NodeIndex, NodeIndex) { return false; };
  self_descent(*tree_, *bounds_, 0, is_leaf, skip_none, [&](NodeIndex a, NodeIndex b) {
    set_.take(motion, radius, {tree_->triangle(a), tree_->triangle(b)}, out);
  });
}

}  // namespace cscd
