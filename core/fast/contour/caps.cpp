#include "core/fast/contour/caps.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <numbers>
#include <utility>

namespace cscd::fast {
namespace {

constexpr std::size_t kFollowed = 8;  // the largest number of vertices that an apex follows

using Loop = std::vector<VertexId>;  // each vertex comes before the next, and the last before the first

// Chains the edges of a cluster's contour, in the direction of its triangles, to loops. Where several edges
// pass through one vertex, it does not matter which of them are chained to which.
std::vector<Loop> chained(std::multimap<VertexId, VertexId> edges) {
  std::vector<Loop> loops;
  while (!edges.empty()) {
    Loop loop = {edges.begin()->first};
    while (true) {
      const auto next = edges.find(loop.back());
      const VertexId to = next->second;
      edges.erase(next);
      if (to == loop.front()) break;
      loop.push_back(to);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

// Returns a point that follows a few vertices of the loop and lies at their mean.
FollowingPoint middle(const Loop& loop) {
  const std::size_t count = std::min(kFollowed, loop.size());
  FollowingPoint point;
  for (std::size_t i = 0; i < count; ++i)
    point.add(loop[i * loop.size() / count], 1 / static_cast<float>(count));
  return point;
}

// Builds a fan over a loop about an apex, and below it triangles that cut off vertices at which the fan would
// turn back. Of two vertices that are seen in the wrong order the one farther from the apex is cut off: the
// triangle that cuts it off mostly fills a notch of the cluster, and is then positive.
class Fan {
 public:
  Fan(const Loop& loop, std::span<const Vec3> positions, const Vec3& from, const Vec3& apex) : loop_(loop) {
    const Vec3 axis = (apex - from).normalized();
    const Vec3 x = axis.unitOrthogonal(), y = axis.cross(x);
    for (const VertexId v : loop) {
      const Vec3 to = (positions[+v] - from).normalized();
      seen_.emplace_back(to.dot(x), to.dot(y));
      nearness_.push_back(to.dot(axis));
    }
    const std::size_t n = loop.size();
    for (std::size_t i = 0; i < n; ++i) {
      next_.push_back((i + 1) % n);
      previous_.push_back((i + n - 1) % n);
    }
    cut_off();
  }
  std::vector<Triangle> triangles() const {
    std::vector<Triangle> all = cut_;
    std::size_t i = start_;
    do {
      all.push_back({kApex, loop_[next_[i]], loop_[i]});
      i = next_[i];
    } while (i != start_);
    return all;
  }
  static constexpr VertexId kApex{-1};

 private:
  // Returns whether vertex i and the next are seen in the right order: clockwise round the axis, and at least
  // a quarter of the mean angle apart.
  bool in_order(std::size_t i) const {
    const auto &a = seen_[next_[i]], &b = seen_[i];
    const double wanted =
        std::numbers::pi / 2 / static_cast<double>(loop_.size());  // a quarter of the mean angle
    return a.x() * b.y() - a.y() * b.x() > wanted * a.norm() * b.norm();
  }
  void cut_off() {
    std::vector<bool> gone(loop_.size(), false);
    std::size_t left = loop_.size(), in_row = 0, i = 0;
    while (left > 3 && in_row <= left) {
      const std::size_t n = next_[i];
      if (in_order(i)) {
        ++in_row;
        i = n;
        continue;
      }
      const std::size_t off = nearness_[i] < nearness_[n] ? i : n;
      const std::size_t before = previous_[off], after = next_[off];
      cut_.push_back({loop_[before], loop_[after], loop_[off]});
      next_[before] = after;
      previous_[after] = before;
      start_ = i = before;
      in_row = 0;
      --left;
    }
  }

  const Loop& loop_;
  std::vector<Eigen::Vector2d> seen_;
  std::vector<double> nearness_;
  std::vector<std::size_t> next_, previous_;
  std::size_t start_ = 0;
  std::vector<Triangle> cut_;
};

// Collects at most sixteen triangles with at most sixteen vertices, the apex among them, into each patch.
std::vector<Patch> packed(const std::vector<Triangle>& triangles) {
  constexpr std::uint8_t kApexPlace = kLanes16 - 1;
  std::vector<Patch> patches;
  std::vector<VertexId> vertices;
  std::size_t lane = kLanes16;
  const auto missing = [&](const Triangle& t) {
    return static_cast<std::size_t>(std::count_if(t.begin(), t.end(), [&](VertexId v) {
      return v != Fan::kApex && std::find(vertices.begin(), vertices.end(), v) == vertices.end();
    }));
  };
  for (const Triangle& t : triangles) {
    if (lane == kLanes16 || vertices.size() + missing(t) > kApexPlace) {
      patches.emplace_back();
      patches.back().cluster.fill(kNone);
      vertices.clear();
      lane = 0;
    }
    Patch& patch = patches.back();
    for (std::size_t k = 0; k < 3; ++k) {
      auto place =
          static_cast<std::size_t>(std::find(vertices.begin(), vertices.end(), t[k]) - vertices.begin());
      if (t[k] == Fan::kApex)
        place = kApexPlace;
      else if (place == vertices.size())
        vertices.push_back(t[k]);
      // Lanes behind the last triangle repeat it.
      for (std::size_t l = lane; l < kLanes16; ++l) patch.corner[k][l] = static_cast<std::uint8_t>(place);
    }
    for (std::size_t i = 0; i < kLanes16; ++i)
      patch.vertex[i] = static_cast<std::int32_t>(vertices[std::min(i, vertices.size() - 1)]);
    patch.lanes |= static_cast<Mask16>(1U << lane);
    ++lane;
  }
  return patches;
}

// Counts the triangles of a fan about an apex that are seen from behind.
std::ptrdiff_t positive(const Loop& loop, std::span<const Vec3> positions, const Vec3& from,
                        const Vec3& apex) {
  std::ptrdiff_t count = 0;
  for (std::size_t i = 0; i < loop.size(); ++i)
    count +=
        (apex - from).cross(positions[+loop[(i + 1) % loop.size()]] - from).dot(positions[+loop[i]] - from) >
        0;
  return count;
}

// Chooses the apex of a loop. `all` are the vertices of the cluster.
Cap cap(const Loop& loop, const Loop& all, std::span<const Vec3> reference, const Vec3& from) {
  Cap best{};
  Vec3 apex = Vec3::Zero();
  std::ptrdiff_t most = -1;
  for (const auto& [towards, opposite] :
       {std::pair(middle(loop), false), std::pair(middle(loop), true), std::pair(middle(all), true)}) {
    const Vec3 point = towards.at(reference), candidate = opposite ? 2 * from - point : point;
    const std::ptrdiff_t count = positive(loop, reference, from, candidate);
    if (count <= most) continue;
    most = count;
    apex = candidate;
    best = {towards, opposite, {}};
  }
  best.fans = packed(Fan(loop, reference, from, apex).triangles());
  return best;
}

}  // namespace

std::vector<Cap> CapBuilder::caps_of(std::span<const TriangleId> triangles, std::span<const Vec3> positions,
                                     const FollowingPoint& observer) {
  // Whatever is thrown on the way, no edge stays counted.
  const struct Uncount {
    CapBuilder& builder;
    ~Uncount() {
      for (const EdgeId e : builder.contour_) builder.passed_[+e] = 0;
    }
  } uncount{*this};
  Loop all;
  contour_.clear();
  for (const TriangleId t : triangles) {
    const Triangle& corners = mesh_.corners(t);
    all.push_back(corners[0]);
    for (std::size_t k = 0; k < 3; ++k) {
      const EdgeId edge = mesh_.edges_of(t)[k];
      if (passed_[+edge] == 0) contour_.push_back(edge);
      passed_[+edge] += corners[k] < corners[(k + 1) % 3] ? 1 : -1;
    }
  }
  // The sum is 0 inside a cluster, and whatever is left is a sum of loops, on any surface.
  std::multimap<VertexId, VertexId> edges;
  std::erase_if(contour_, [&](EdgeId e) { return passed_[+e] == 0; });
  std::ranges::sort(contour_, {}, [&](EdgeId e) { return std::pair(mesh_.ends(e), e); });
  for (const EdgeId e : contour_) {
    const Edge& ends = mesh_.ends(e);
    const int times = std::exchange(passed_[+e], 0);  // an edge that is listed again then counts as zero
    for (int i = 0; i < std::abs(times); ++i)
      edges.emplace(times > 0 ? ends[0] : ends[1], times > 0 ? ends[1] : ends[0]);
  }
  std::vector<Cap> caps;
  for (const Loop& loop : chained(std::move(edges)))
    caps.push_back(cap(loop, all, positions, observer.at(positions)));
  return caps;
}

}  // namespace cscd::fast
