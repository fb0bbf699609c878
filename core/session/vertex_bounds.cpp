#include "core/session/vertex_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/rounding.h"
#include "core/detect/contact_geometry.h"
#include "core/geometry/nearest_points.h"
#include "core/geometry/unit_scale.h"

namespace cscd {

// Rounding. Let u be the unit roundoff and M the largest coordinate seen from the first vertex. Seen
// coordinates are off by u M. The direction counts as exact. A height, a dot product divided by the length of
// the direction, is off by less than 2 u M from coordinates, 6 u M from the product and 9 u M from length and
// quotient. Two heights, and the few sums of them that bounds are made of, none of which exceeds 8 M, are off
// by less than 100 u M.
void VertexBounds::add(const TriangleMesh& mesh, const Motion& motion, std::span<const FeaturePair> pairs,
                       const Thickness& thickness) {
  for (const FeaturePair& features : pairs) {
    Pair pair{};
    const std::array<VertexId, 4> vertices = vertices_of(mesh, features);
    const bool edges = features.kind == FeaturePair::Kind::edge_edge;
    pair.split = edges ? 2 : 1;
    std::array<Vec3, 4> at;
    double largest = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const VertexId v = vertices[i];
      pair.vertex[i] = static_cast<std::size_t>(v);
      at[i] = motion.start()[+v] - motion.start()[+vertices[0]];
      largest = std::max(largest, at[i].cwiseAbs().maxCoeff());
      if (!has_bounds(pair, i))
        pair.moved[i] = (1 + 8 * kUnitRoundoff) * stable_length(motion.end()[+v] - motion.start()[+v]) +
                        std::numeric_limits<double>::min();
    }
    const double error = 128 * kUnitRoundoff * largest;
    pair.least = thickness.of(mesh, features) + error;
    // Outside of this range numbers may underflow or overflow. Inside, a power of two makes the largest
    // coordinate about 1, so that products do not. A way that is as short as the error is mere rounding.
    if (largest > 1e-290 && largest < 1e300) {
      const double unit = std::ldexp(1.0, std::ilogb(largest));
      for (Vec3& p : at) p /= unit;
      const Vec3 way = (edges ? nearest_of_edges(at) : nearest_of_vertex_face(at)).way;
      const double length = way.norm();
      if (length > error / unit)
        for (std::size_t i = 0; i < 4; ++i)
          pair.height[i] = (i < pair.split ? 1 : -1) * (at[i].dot(way) / length * unit);
      pair.apart = lowest(pair, true, {}) + lowest(pair, false, {}) > pair.least;
    }
    const bool may_come_close =
        !pair.apart || !(lowest(pair, true, caps_) + lowest(pair, false, caps_) > pair.least);
    if (!may_come_close) continue;
    memory_.look(pairs_);
    pairs_.push_back(pair);
  }
}

// Without bounds, the lowest of the pose.
double VertexBounds::lowest(const Pair& pair, bool first, std::span<const double> bounds) const {
  double low = std::numeric_limits<double>::infinity();
  for (std::size_t i = first ? 0 : pair.split; i < (first ? pair.split : 4); ++i) {
    const double moved = !has_bounds(pair, i) ? pair.moved[i] : bounds.empty() ? 0 : bounds[pair.vertex[i]];
    low = std::min(low, pair.height[i] - moved);
  }
  return low;
}

// Half of the room of each pair for each of its sides, or all of it where the other side has no bounds.
std::vector<double> VertexBounds::halves() const {
  std::vector<double> bounds = caps_;
  for (const Pair& pair : pairs_) {
    const double low[2] = {lowest(pair, true, {}), lowest(pair, false, {})};
    const bool shared = has_bounds(pair, 0) && has_bounds(pair, pair.split);
    const double room = low[0] + low[1] - pair.least;
    for (std::size_t i = 0; i < 4; ++i) {
      if (!has_bounds(pair, i)) continue;
      double& bound = bounds[pair.vertex[i]];
      if (!pair.apart || !(room > 0))
        bound = 0;
      else
        bound = std::min(bound, pair.height[i] - low[i < pair.split ? 0 : 1] + (shared ? room / 2 : room));
    }
  }
  return bounds;
}

std::vector<double> VertexBounds::find() const {
  std::vector<double> bounds = halves();
  // The places of each vertex in pairs: those of vertex v from first[v] on.
  std::vector<std::size_t> first(movable_ + 1, 0);
  for (const Pair& pair : pairs_)
    for (std::size_t i = 0; i < 4; ++i)
      if (has_bounds(pair, i)) ++first[pair.vertex[i] + 1];
  for (std::size_t v = 0; v < movable_; ++v) first[v + 1] += first[v];
  std::vector<std::size_t> place(first[movable_]), next(first.begin(), first.end() - 1);
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    for (std::size_t i = 0; i < 4; ++i)
      if (has_bounds(pairs_[p], i)) place[next[pairs_[p].vertex[i]]++] = 4 * p + i;

  for (std::size_t v = 0; v < movable_; ++v) {
    if (!(bounds[v] > 0)) continue;
    double room = caps_[v];
    for (std::size_t k = first[v]; k < first[v + 1]; ++k) {
      const Pair& pair = pairs_[place[k] / 4];
      const std::size_t i = place[k] % 4;
      room = std::min(room, pair.height[i] + lowest(pair, i >= pair.split, bounds) - pair.least);
    }
    bounds[v] = std::max(bounds[v], room);
  }
  return bounds;
}

// What the halves of its neighbours leave to a vertex. In the end neighbours have no less.
std::vector<double> VertexBounds::find_most(double cap) const {
  const std::vector<double> least = halves();
  std::vector<double> most(movable_, cap);
  for (const Pair& pair : pairs_)
    for (std::size_t i = 0; i < 4; ++i) {
      if (!has_bounds(pair, i)) continue;
      const double room = pair.height[i] + lowest(pair, i >= pair.split, least) - pair.least;
      double& own = most[pair.vertex[i]];
      own = std::min(own, std::max(room, 0.0));
    }
  for (std::size_t v = 0; v < movable_; ++v) most[v] = std::max(most[v], std::min(least[v], cap));
  return most;
}

}  // namespace cscd
