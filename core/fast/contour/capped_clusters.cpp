#include "core/fast/contour/capped_clusters.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <utility>

namespace cscd::fast {
namespace {

constexpr std::size_t kRange = 8;      // clusters that are begun together, some microseconds of work
constexpr int kFewUncertain = 4;       // the largest number of triangles of a patch that get a cone each
constexpr std::size_t kFewCones = 16;  // up to so many cones, a cone about a whole patch spares no work

// The triangles of a fan that have the apex as a corner, which is then their first one (caps.cpp).
unsigned lanes_at_apex(const Patch& fan) {
  unsigned lanes = 0;
  for_each_lane(fan.lanes, [&](std::size_t lane) {
    if (fan.corner[0][lane] == kLanes16 - 1) lanes |= 1U << lane;
  });
  return lanes;
}

// A triangle of a cluster as its observer sees it in the reference pose.
struct Target {
  Triangle corners;
  Vec3 direction;  // to its middle, of unit length
  double size;     // six times the volume over its corners at distance one; negative if seen from outside
};

// Chooses triangles of a cluster for rays to go through, at most `most`. The first is the one that is seen
// largest, because its neighbours are far from its middle. Each further one lies as far as possible from
// those before it, so that few things that block one ray block another.
std::vector<Triangle> targets_of(const TriangleMesh& mesh, std::span<const Vec3> positions,
                                 std::span<const TriangleId> triangles, const Vec3& from, std::size_t most) {
  std::vector<Target> seen;
  for (const TriangleId t : triangles) {
    const Triangle& corners = mesh.corners(t);
    Vec3 ray[3];
    for (std::size_t k = 0; k < 3; ++k) ray[k] = (positions[+corners[k]] - from).normalized();
    seen.push_back({corners, (ray[0] + ray[1] + ray[2]).normalized(), ray[0].dot(ray[1].cross(ray[2]))});
  }
  std::vector<Triangle> chosen;
  auto next = std::ranges::max_element(seen, {}, &Target::size);
  std::vector<double> nearest(seen.size(), -1);  // the cosine of the angle to the nearest chosen target
  while (true) {
    chosen.push_back(next->corners);
    if (chosen.size() == most) return chosen;
    const Vec3 taken = next->direction;
    for (std::size_t i = 0; i < seen.size(); ++i)
      nearest[i] = std::max(nearest[i], seen[i].size > 0 ? seen[i].direction.dot(taken) : 1.0);
    const auto farthest = std::ranges::min_element(nearest);
    if (!(*farthest < 0.999)) return chosen;
    next = seen.begin() + (farthest - nearest.begin());
  }
}

}  // namespace

CappedClusters::CappedClusters(const TriangleMesh& mesh, std::span<const Vec3> reference, const Cover& cover,
                               std::size_t number)
    : number_(number) {
  resize(cover.observers.size());
  std::vector<std::vector<TriangleId>> members(cover.observers.size());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    if (cover.cluster_of[t] != kNone)
      members[static_cast<std::size_t>(cover.cluster_of[t])].push_back(
          TriangleId{static_cast<std::int32_t>(t)});
  CapBuilder builder(mesh);
  for (std::size_t i = 0; i < members.size(); ++i)
    set_cluster(i, builder, mesh, members[i], members[i], reference, cover.observers[i]);
}

void CappedClusters::resize(std::size_t count) {
  caps_.resize(count);
  targets_.resize(count);
  state_.resize(count);
}

void CappedClusters::rename_last(std::size_t cluster) {
  caps_[cluster] = std::move(caps_.back());
  targets_[cluster] = std::move(targets_.back());
}

void CappedClusters::set_cluster(std::size_t cluster, CapBuilder& builder, const TriangleMesh& mesh,
                                 std::span<const TriangleId> triangles, std::span<const TriangleId> targets,
                                 std::span<const Vec3> positions, const FollowingPoint& observer) {
  caps_[cluster] = builder.caps_of(triangles, positions, observer);
  targets_[cluster] = targets_of(mesh, positions, targets, observer.at(positions), kRays);
}

void CappedClusters::start(const LocalPositions& positions, std::span<const Viewpoint> viewpoints,
                           const ThreadPool& pool) {
  positions_ = &positions;
  viewpoints_ = viewpoints;
  at_cap_.resize(pool.ranges_of(state_.size(), kRange));
  pool.ranges(state_.size(), kRange, [&](std::size_t first, std::size_t last, std::size_t part) {
    for (std::size_t i = first; i < last; ++i) start(i, at_cap_[part]);
  });
}

void CappedClusters::start(std::size_t cluster, CapOrientation& at_cap) {
  State& state = state_[cluster];
  state.ray.emplace(ray_through(cluster, targets_[cluster].front()));
  state.rays = 1;
  state.crossings = 0;
  state.ray_decides = state.cones_known = true;
  state.has_other_ray = false;
  state.uncertain.clear();
  for (const Cap& cap : caps_[cluster]) take(cap, cluster, at_cap);
}

Ray CappedClusters::ray_through(std::size_t cluster, const Triangle& target) const {
  const std::span<const LocalPositions::Record> records = positions_->records();
  float middle[3];
  for (std::size_t k = 0; k < 3; ++k)
    middle[k] = (records[+target[0]].at[k] + records[+target[1]].at[k] + records[+target[2]].at[k]) / 3;
  return {viewpoints_[cluster], middle, positions_->error()};
}

void CappedClusters::classify(const Cap& cap, std::size_t cluster, CapOrientation& at_cap) const {
  const Viewpoint &from = viewpoints_[cluster], towards = placed(cap.towards, positions_->records());
  at_cap.loop.clear();
  at_cap.positive.clear();
  for (const Patch& fan : cap.fans) {
    PatchLanes lanes = load(positions_->records(), fan.vertex);
    for (int end = 0; end < 2; ++end)
      for (int i = 0; i < 3; ++i) {
        const float apex = cap.opposite ? 2 * from.at[end][i] - towards.at[end][i] : towards.at[end][i];
        lanes.at[end][i][kLanes16 - 1] = apex;
      }
    const Signs signs = orientation(lanes, fan, from, positions_->error());
    at_cap.positive.push_back(signs.positive & fan.lanes);
    at_cap.loop.push_back(lanes);
  }
}

void CappedClusters::take(const Cap& cap, std::size_t cluster, CapOrientation& at_cap) {
  classify(cap, cluster, at_cap);
  State& state = state_[cluster];
  for (std::size_t i = 0; i < cap.fans.size(); ++i) {
    const Patch& fan = cap.fans[i];
    const PatchLanes& loop = at_cap.loop[i];
    state.count(fan, loop, at_cap.positive[i]);
    const unsigned uncertain = fan.lanes & ~static_cast<unsigned>(at_cap.positive[i]);
    const unsigned at_apex = uncertain & lanes_at_apex(fan);
    if ((uncertain & ~at_apex) != 0)
      add_cones(uncertain & ~at_apex, cones_of(loop, fan, viewpoints_[cluster], positions_->error()), state);
    if (at_apex != 0) take_in_slices(fan, loop, at_apex, cluster);
  }
}

// From the observer, the triangles of a fan reach from the contour to the opposite side. One cone about such
// a triangle would hold half of everything, so each is cut into slices between the contour and the apex.
void CappedClusters::take_in_slices(const Patch& fan, const PatchLanes& lanes, unsigned triangles,
                                    std::size_t cluster) {
  constexpr float kSlices[] = {0, 1.F / 16, 1.F / 8, 1.F / 4, 3.F / 8, 1.F / 2, 5.F / 8, 3.F / 4, 1};
  float farthest = 0;
  for (const auto& end : lanes.at)
    for (const Float16& axis : end) farthest = std::max(farthest, std::abs(axis[kLanes16 - 1]));
  // Three roundings of a difference, a product and a sum, each of at most 2^-24 of the two coordinates.
  const float error = 6 * positions_->error() + 0x1p-21F * farthest;
  PatchLanes near = lanes, far;
  for (std::size_t k = 1; k < std::size(kSlices); ++k) {
    for (int end = 0; end < 2; ++end)
      for (int i = 0; i < 3; ++i) {
        const Float16 apex = all_lanes(lanes.at[end][i][kLanes16 - 1]);
        far.at[end][i] = lanes.at[end][i] + kSlices[k] * (apex - lanes.at[end][i]);
      }
    add_cones(triangles, cones_of_strips(near, far, fan, viewpoints_[cluster], error), state_[cluster]);
    near = far;
  }
}

void CappedClusters::add_cones(unsigned triangles, const Cones& cones, State& state) {
  if ((triangles & ~cones.known) != 0) state.cones_known = false;
  for (; triangles != 0 && state.cones_known; triangles &= triangles - 1)
    state.add(cones[static_cast<std::size_t>(std::countr_zero(triangles))]);
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
  add_cones(uncertain, cones_of(lanes, triangles, viewpoints_[cluster], positions_->error()), state);
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
    if (!state.has_other_ray) continue;
    CapOrientation& at_cap = at_cap_.front();
    for (const Cap& cap : caps_[i]) {
      classify(cap, i, at_cap);
      for (std::size_t f = 0; f < cap.fans.size(); ++f)
        state.count(cap.fans[f], at_cap.loop[f], at_cap.positive[f]);
    }
  }
  return any;
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
