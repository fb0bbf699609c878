#include "core/fast/keep_all/capped_clusters.h"

#include <bit>
#include <limits>

namespace cscd::fast {
namespace {

// If more triangles of a patch or of a cap are not positive, one cone stands for all of them.
constexpr int kFewUncertain = 4;

}  // namespace

CappedClusters::CappedClusters(const TriangleMesh& mesh, std::span<const Vec3> reference, const Cover& cover,
                               std::size_t number)
    : number_(number),
      caps_(caps_of(mesh, reference, cover)),
      target_(cover.observers.size()),
      state_(target_.size()) {
  // A ray goes through the triangle that is seen largest from the observer, because the neighbours of that
  // triangle are far from its middle.
  std::vector<Vec3> from;
  for (const FollowingPoint& observer : cover.observers) from.push_back(observer.at(reference));
  std::vector<double> largest(target_.size(), -std::numeric_limits<double>::infinity());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (cover.cluster_of[t] == kNone) continue;
    const auto cluster = static_cast<std::size_t>(cover.cluster_of[t]);
    const Triangle& corners = mesh.triangles()[t];
    Vec3 ray[3];
    for (std::size_t k = 0; k < 3; ++k) ray[k] = (reference[+corners[k]] - from[cluster]).normalized();
    const double size = ray[0].dot(ray[1].cross(ray[2]));
    if (!(size > largest[cluster])) continue;
    largest[cluster] = size;
    target_[cluster] = corners;
  }
}

void CappedClusters::start(const LocalPositions& positions, std::span<const Viewpoint> viewpoints) {
  positions_ = &positions;
  viewpoints_ = viewpoints;
  const std::span<const LocalPositions::Record> records = positions.records();
  for (std::size_t i = 0; i < state_.size(); ++i) {
    float middle[3];
    for (std::size_t k = 0; k < 3; ++k)
      middle[k] =
          (records[+target_[i][0]].at[k] + records[+target_[i][1]].at[k] + records[+target_[i][2]].at[k]) / 3;
    State& state = state_[i];
    state.ray.emplace(viewpoints_[i], middle, positions.error());
    state.crossings = 0;
    state.known = true;
    state.uncertain.clear();
  }
  for (const Cap& cap : caps_) take(cap);
}

// Takes the triangles of a cap. If many of them are not positive, one cone round the whole cap takes their
// place.
void CappedClusters::take(const Cap& cap) {
  const Viewpoint &from = viewpoints_[cap.cluster], towards = placed(cap.towards, positions_->records());
  State& state = state_[cap.cluster];
  loop_.clear();
  positive_.clear();
  int uncertain = 0;
  for (const Patch& fan : cap.fans) {
    PatchLanes lanes = load(positions_->records(), fan.vertex);
    for (int end = 0; end < 2; ++end)
      for (int i = 0; i < 3; ++i) {
        const float apex = cap.opposite ? 2 * from.at[end][i] - towards.at[end][i] : towards.at[end][i];
        lanes.at[end][i][kLanes16 - 1] = apex;
      }
    const Signs signs = orientation(lanes, fan, from, positions_->error());
    positive_.push_back(signs.positive & fan.lanes);
    uncertain += std::popcount(static_cast<unsigned>(fan.lanes & ~positive_.back()));
    loop_.push_back(lanes);
  }
  if (uncertain > kFewUncertain)
    if (const std::optional<Cone> cone = cone_of(loop_, from, positions_->error())) {
      state.add(*cone);
      return;
    }
  for (std::size_t i = 0; i < cap.fans.size(); ++i) take(cap.fans[i], loop_[i], positive_[i], cap.cluster);
}

void CappedClusters::take(const Patch& patch, Mask16 positive) {
  take(patch, load(positions_->records(), patch.vertex), positive,
       static_cast<std::size_t>(patch.cluster[number_]));
}

void CappedClusters::take(const Patch& triangles, const PatchLanes& lanes, Mask16 positive,
                          std::size_t cluster) {
  State& state = state_[cluster];
  if (state.ray->may_cross(lanes)) {
    const Ray::Crossed crossed = state.ray->crossed(lanes, triangles);
    state.crossings += std::popcount(static_cast<unsigned>(crossed.certainly & positive));
    if ((positive & ~(crossed.certainly | crossed.certainly_not)) != 0) state.known = false;
  }
  unsigned uncertain = triangles.lanes & ~static_cast<unsigned>(positive);
  if (uncertain == 0) return;
  if (std::popcount(uncertain) > kFewUncertain)
    if (const std::optional<Cone> cone = cone_of({&lanes, 1}, viewpoints_[cluster], positions_->error())) {
      state.add(*cone);
      return;
    }
  const Cones cones = cones_of(lanes, triangles, viewpoints_[cluster], positions_->error());
  if ((uncertain & ~cones.known) != 0) state.known = false;
  for (; uncertain != 0 && state.known; uncertain &= uncertain - 1)
    state.add(cones[static_cast<std::size_t>(std::countr_zero(uncertain))]);
}

Mask16 CappedClusters::clear(const Patch& patch, Mask16 positive) const {
  const auto cluster = static_cast<std::size_t>(patch.cluster[number_]);
  const State& state = state_[cluster];
  if (!state.known || state.crossings != 1) return 0;
  if (state.uncertain.empty()) return positive;
  const Cones cones =
      cones_of(load(positions_->records(), patch.vertex), patch, viewpoints_[cluster], positions_->error());
  for (const Cone& cone : state.uncertain) positive &= apart(cones, cone);
  return positive;
}

}  // namespace cscd::fast
