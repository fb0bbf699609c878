#include "core/session/candidates.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "core/base/stage_clock.h"
#include "core/detect/carried_pairs.h"
#include "core/detect/filter_block.h"
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

CandidateSet::CandidateSet(const TriangleMesh& mesh, std::span<const Vec3> reference,
                           const Exclusions* exclusions, std::size_t own_vertices)
    : mesh_(mesh), exclusions_(exclusions), loose_(mesh, reference, own_vertices) {
  if (exclusions == nullptr) owners_.emplace(mesh);
}

// Where nothing is excluded, the owners' pairs of triangles are enough, because those that are passed on
// carry everything that is near. A pair of triangles may be excluded while another carries the same features.
CarriedPlaces CandidateSet::wanted(const TrianglePair& pair) const {
  if (!owners_) return exclusions_->excludes(mesh_, pair) ? 0 : kAllCarried;
  return owners_->owned_by(pair);
}

void CandidateSet::take(const Motion& motion, const Thickness& thickness, std::span<const TrianglePair> block,
                        std::vector<FeaturePair>& out) {
  block_.clear();
  std::ranges::copy_if(block, std::back_inserter(block_),
                       [&](const TrianglePair& pair) { return wanted(pair) != 0; });
  for (std::size_t first = 0; first < block_.size(); first += kLanes16) {
    const auto pairs = std::span(block_).subspan(first, std::min(kLanes16, block_.size() - first));
    const auto before = no_contact_before(mesh_, motion, pairs, thickness.largest());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (before[i] > 1) continue;
      const Triangle &a = mesh_.corners(pairs[i].a), &b = mesh_.corners(pairs[i].b);
      CarriedPairs near{pairs[i], static_cast<CarriedPlaces>(carried_by(a, b) & wanted(pairs[i]))};
      if (near.places != 0 && !thickness.is_zero())
        near.places = not_farther_than(thickness.largest(), motion, a, b, near.places);
      for_each_carried(mesh_, near,
                       [&](const FeaturePair& features) { add(motion, thickness, features, out); });
    }
  }
}

void CandidateSet::take_all_of(const Motion& motion, const Thickness& thickness, VertexId vertex,
                               std::vector<FeaturePair>& out) {
  const auto holds = [](const auto& vertices, VertexId v) {
    return std::ranges::find(vertices, v) != vertices.end();
  };
  const auto try_face = [&](VertexId v, TriangleId t) {
    if (!holds(mesh_.corners(t), v)) add(motion, thickness, FeaturePair::of(v, t), out);
  };
  for (std::size_t t = 0; t < mesh_.triangle_count(); ++t)
    try_face(vertex, TriangleId{static_cast<std::int32_t>(t)});
  for (const TriangleId t : mesh_.triangles_at(vertex)) {
    for (std::size_t v = 0; v < mesh_.vertex_count(); ++v)
      try_face(VertexId{static_cast<std::int32_t>(v)}, t);
    for (const EdgeId own : mesh_.edges_of(t)) {
      const Edge& ends = mesh_.ends(own);
      if (!holds(ends, vertex)) continue;
      for (std::size_t e = 0; e < mesh_.edge_count(); ++e) {
        const EdgeId other{static_cast<std::int32_t>(e)};
        const Edge& others = mesh_.ends(other);
        if (!holds(ends, others[0]) && !holds(ends, others[1]))
          add(motion, thickness, FeaturePair::of(own, other), out);
      }
    }
  }
}

void CandidateSet::take_loose(const Motion& motion, const Thickness& thickness,
                              std::vector<FeaturePair>& out) {
  loose_.for_each_near(motion, thickness.largest(),
                       [&](VertexId v, TriangleId t) { add(motion, thickness, FeaturePair::of(v, t), out); });
}

void CandidateSet::add(const Motion& motion, const Thickness& thickness, const FeaturePair& features,
                       std::vector<FeaturePair>& out) {
  if (!within(mesh_, motion, features, thickness) || !met_.insert(features)) return;
  if (exclusions_ != nullptr && exclusions_->excludes(mesh_, features)) return;
  memory_.look(out);
  out.push_back(features);
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
  set_.take_loose(motion, thickness, out);
}

void CandidateSearch::find_more(const Motion& motion, const Thickness& thickness,
                                std::span<const VertexId> vertices, std::vector<FeaturePair>& out) {
  for (const VertexId v : vertices) set_.take_all_of(motion, thickness, v, out);
}

}  // namespace cscd
