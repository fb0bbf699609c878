#include "core/fast/keep_all/capped_clusters.h"

#include <algorithm>
#include <bit>

namespace cscd::fast {
namespace {

constexpr int kFewUncertain = 4;       // the largest number of triangles of a cap that get a cone each
constexpr std::size_t kFewCones = 16;  // up to so many cones, a cone about a whole patch spares no work

// A triangle of a cluster as its observer sees it in the reference pose.
struct Target {
  Triangle corners;
  Vec3 direction;  // to its middle, of unit length
  double size;     // six times the volume over its corners at distance one; negative if seen from outside
};

// Chooses triangles for rays to go through, for each cluster at most `most`. The first is the one that is
// seen largest, because its neighbours are far from its middle. Each further one lies as far as possible from
// those before it, so that few things that block one ray block another.
std::vector<std::vector<Triangle>> targets_of(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                              const Cover& cover, std::size_t most) {
  std::vector<Vec3> from;
  for (const FollowingPoint& observer : cover.observers) from.push_back(observer.at(reference));
  std::vector<std::vector<Target>> seen(from.size());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (cover.cluster_of[t] == kNone) continue;
    const auto cluster = static_cast<std::size_t>(cover.cluster_of[t]);
    const Triangle& corners = mesh.triangles()[t];
    Vec3 ray[3];
    for (std::size_t k = 0; k < 3; ++k) ray[k] = (reference[+corners[k]] - from[cluster]).normalized();
    seen[cluster].push_back(
        {corners, (ray[0] + ray[1] + ray[2]).normalized(), ray[0].dot(ray[1].cross(ray[2]))});
  }
  std::vector<std::vector<Triangle>> chosen(from.size());
  for (std::size_t cluster = 0; cluster < from.size(); ++cluster) {
    std::vector<Target>& left = seen[cluster];
    auto next = std::ranges::max_element(left, {}, &Target::size);
    std::vector<double> nearest(left.size(), -1);  // the cosine of the angle to the nearest chosen target
    while (true) {
      chosen[cluster].push_back(next->corners);
      if (chosen[cluster].size() == most) break;
      const Vec3 taken = next->direction;
      for (std::size_t i = 0; i < left.size(); ++i)
        nearest[i] = std::max(nearest[i], left[i].size > 0 ? left[i].direction.dot(taken) : 1.0);
      const auto farthest = std::ranges::min_element(nearest);
      if (!(*farthest < 0.999)) break;
      next = left.begin() + (farthest - nearest.begin());
    }
  }
  return chosen;
}

}  // namespace

CappedClusters::CappedClusters(const TriangleMesh& mesh, std::span<const Vec3> reference, const Cover& cover,
                               std::size_t number)
    : number_(number),
      caps_(caps_of(mesh, reference, cover)),
      targets_(targets_of(mesh, reference, cover, kRays)),
      state_(targets_.size()) {}

void CappedClusters::start(const LocalPositions& positions, std::span<const Viewpoint> viewpoints) {
  positions_ = &positions;
  viewpoints_ = viewpoints;
  for (std::size_t i = 0; i < state_.size(); ++i) {
    State& state = state_[i];
    state.ray.emplace(ray_through(i, targets_[i].front()));
    state.rays = 1;
    state.crossings = 0;
    state.ray_decides = state.cones_known = true;
    state.has_other_ray = false;
    state.uncertain.clear();
  }
  for (const Cap& cap : caps_) take(cap);
}

Ray CappedClusters::ray_through(std::size_t cluster, const Triangle& target) const {
  const std::span<const LocalPositions::Record> records = positions_->records();
  float middle[3];
  for (std::size_t k = 0; k < 3; ++k)
    middle[k] = (records[+target[0]].at[k] + records[+target[1]].at[k] + records[+target[2]].at[k]) / 3;
  return {viewpoints_[cluster], middle, positions_->error()};
}

int CappedClusters::look(const Cap& cap) {
  const Viewpoint &from = viewpoints_[cap.cluster], towards = placed(cap.towards, positions_->records());
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
  return uncertain;
}

// Where many triangles of a cap are not positive, one cone about the whole loop is narrower than their cones
// together.
void CappedClusters::take(const Cap& cap) {
  if (look(cap) > kFewUncertain)
    if (const auto cone = cone_of(loop_, viewpoints_[cap.cluster], positions_->error())) {
      state_[cap.cluster].add(*cone);
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
  state.count(triangles, lanes, positive);
  unsigned uncertain = triangles.lanes & ~static_cast<unsigned>(positive);
  if (uncertain == 0) return;
  if (std::popcount(uncertain) > kFewUncertain)
    if (const auto cone = cone_of({&lanes, 1}, viewpoints_[cluster], positions_->error())) {
      state.add(*cone);
      return;
    }
  const Cones cones = cones_of(lanes, triangles, viewpoints_[cluster], positions_->error());
  if ((uncertain & ~cones.known) != 0) state.cones_known = false;
  for (; uncertain != 0 && state.cones_known; uncertain &= uncertain - 1)
    state.add(cones[static_cast<std::size_t>(std::countr_zero(uncertain))]);
}

void CappedClusters::State::count(const Patch& triangles, const PatchLanes& lanes, Mask16 positive) {
  if (!ray->may_cross(lanes)) return;
  const Ray::Crossed crossed = ray->crossed(lanes, triangles);
  crossings += std::popcount(static_cast<unsigned>(crossed.certainly & positive));
  if ((positive & ~(crossed.certainly | crossed.certainly_not)) != 0) ray_decides = false;
}

bool CappedClusters::choose_other_rays() {
  bool any = false;
  for (std::size_t i = 0; i < state_.size(); ++i) {
    State& state = state_[i];
    state.has_other_ray = false;
    if (!state.cones_known || state.ray_decides) continue;
    while (state.rays < targets_[i].size() && !state.has_other_ray) {
      const Ray ray = ray_through(i, targets_[i][state.rays++]);
      bool free = true;
      state.uncertain.for_each_near({}, [&](const Cone& cone) { free &= ray.outside(cone); });
      if (!free) continue;
      state.ray = ray;
      state.crossings = 0;
      any = state.ray_decides = state.has_other_ray = true;
    }
  }
  if (!any) return false;
  for (const Cap& cap : caps_) {
    State& state = state_[cap.cluster];
    if (!state.has_other_ray) continue;
    look(cap);
    for (std::size_t i = 0; i < cap.fans.size(); ++i) state.count(cap.fans[i], loop_[i], positive_[i]);
  }
  return true;
}

void CappedClusters::count(const Patch& patch, Mask16 positive) {
  state_[static_cast<std::size_t>(patch.cluster[number_])].count(
      patch, load(positions_->records(), patch.vertex), positive);
}

Mask16 CappedClusters::clear(const Patch& patch, Mask16 positive) const {
  const auto cluster = static_cast<std::size_t>(patch.cluster[number_]);
  const State& state = state_[cluster];
  if (!state.known()) return 0;
  if (state.uncertain.size() == 0) return positive;
  const PatchLanes lanes = load(positions_->records(), patch.vertex);
  const Viewpoint& from = viewpoints_[cluster];
  std::optional<Cone> whole;
  if (state.uncertain.size() > kFewCones) whole = cone_of({&lanes, 1}, from, positions_->error());
  std::optional<Cones> cones;
  state.uncertain.for_each_near(whole, [&](const Cone& cone) {
    if (!cones) cones = cones_of(lanes, patch, from, positions_->error());
    positive &= apart(*cones, cone);
  });
  return positive;
}

}  // namespace cscd::fast
