#include "core/fast/certify/one_rings.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/base/warm_cache.h"
#include "core/fast/classify/patch_lanes.h"

// Rounding (rule error-bound), in the notation of triple_product16.h. Edges are off by 2 d + u of themselves.
// A component of a control vector is a sum of two products of edges whose components are at most A and B
// (four products for the middle control vector, which is computed as twice that vector). Therefore the
// component is off by 4 d (A' + B') + 10.5 u A' B'. The direction is exact by definition and has components
// up to D. Therefore the dot product of a control vector with the direction is off by D (12 d (A' + B') +
// 49.5 u A' B'). The constants 12.2 and 50 below also pay for the roundings of the bound itself.
//
// A component of `side` is computed from a direction with components up to D and a sum of edges up to L, and
// rounds by 4 u D L. So the product of `side` with the direction of unit length, which should be zero, is at
// most 12 u D L. That is 120 u of the length of `side`, if that length is at least kLeastSide D L. The
// distance of an edge with components up to A from the plane, in units of that length, is then off by less
// than 120 sqrt(3) u A, by its own roundings and by 2 d. kOffSide bounds the sum of the first two.
//
// The edge between two neighbours of the vertex is the difference of two edges, so its length is off by up to
// sqrt(3) (4 d + u (A + B)), and by the roundings of a length, for which kRoundUp pays. Whatever else
// least_height() computes rounds less than ten times, for which kRoundDown pays.
namespace cscd::fast {
namespace {

constexpr float kTiny = 1e-30F;
constexpr float kLeastSide = 0.1F, kOffSide = 1e-4F;
constexpr float kRoundUp = 1 + 0x1p-20F, kRoundDown = 1 - 0x1p-18F;

float sum(Float16 v) {
  return folded(v, [](auto a, auto b) { return a + b; });
}

// Returns the least height of a one-ring's triangles at any t, seen along a direction of unit length. `area`
// is at most twice each triangle's area, seen so, and `a` and `b` are its edges at the vertex. Lengths may be
// off by `off`.
float least_height(Float16 area, const PatchLanes& a, const PatchLanes& b, Float16 off) {
  Float16 longest = {};  // squared
  const auto take = [&](const auto& component) {
    for (std::size_t end = 0; end < 2; ++end) {
      const Float16 x = component(end, 0), y = component(end, 1), z = component(end, 2);
      longest = larger(longest, product_plus(z, z, product_plus(y, y, x * x)));
    }
  };
  take([&](std::size_t end, std::size_t i) { return a.at[end][i]; });
  take([&](std::size_t end, std::size_t i) { return b.at[end][i]; });
  take([&](std::size_t end, std::size_t i) { return b.at[end][i] - a.at[end][i]; });
  const Float16 heights = area / (kRoundUp * square_root(longest) + off);
  return kRoundDown * folded(heights, [](auto x, auto y) { return smaller(x, y); });
}

// For rings that are repeated over all lanes: the lane of the vertex after each, by the length of the ring.
constexpr std::array<Places16, kLanes16 + 1> kNext = [] {
  std::array<Places16, kLanes16 + 1> next{};
  for (std::size_t count = 1; count <= kLanes16; ++count)
    for (std::size_t l = 0; l < kLanes16; ++l)
      next[count][l] = static_cast<std::uint8_t>((l % count + 1) % count);
  return next;
}();

// Returns the other two corners of a triangle at a vertex, in the triangle's order.
struct Ends {
  VertexId second, third;
};

// Returns the second corners of the triangles, ordered so that each triangle's third corner is the second of
// the next one; empty if the triangles are not one closed fan.
std::vector<std::int32_t> ring_of(std::span<const Ends> ends) {
  std::vector<std::int32_t> ring;
  if (ends.empty()) return ring;
  VertexId at = ends[0].second;
  do {
    const auto next = std::ranges::find(ends, at, &Ends::second);
    if (next == ends.end() || ring.size() == ends.size()) return {};
    ring.push_back(static_cast<std::int32_t>(at));
    at = next->third;
  } while (at != ends[0].second);
  if (ring.size() < ends.size()) return {};
  return ring;
}

}  // namespace

OneRings::OneRings(const TriangleMesh& mesh) {
  offset_.push_back(0);
  std::vector<Ends> ends;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const VertexId vertex{static_cast<std::int32_t>(v)};
    ends.clear();
    for (const TriangleId t : mesh.triangles_at(vertex)) {
      const Triangle& c = mesh.corners(t);
      const std::size_t k = c[0] == vertex ? 0 : c[1] == vertex ? 1 : 2;
      ends.push_back({c[(k + 1) % 3], c[(k + 2) % 3]});
    }
    const std::vector<std::int32_t> ring = ring_of(ends);
    ring_.insert(ring_.end(), ring.begin(), ring.end());
    offset_.push_back(static_cast<std::int32_t>(ring_.size()));
  }
}

void OneRings::warm_cache() const {
  cscd::warm_cache(std::span(offset_));
  cscd::warm_cache(std::span(ring_));
}

bool OneRings::flat(VertexId vertex, const LocalPositions& positions, float distance) const {
  const auto first = static_cast<std::size_t>(offset_[+vertex]);
  const std::size_t count = static_cast<std::size_t>(offset_[+vertex + 1]) - first;
  if (count == 0 || count > kLanes16 || !positions.known()) return false;
  const std::span<const LocalPositions::Record> records = positions.records();
  const LocalPositions::Record& here = records[+vertex];

  std::array<std::int32_t, kLanes16> ring;
  for (std::size_t l = 0; l < kLanes16; ++l) ring[l] = l < count ? ring_[first + l] : ring[l - count];
  PatchLanes a = load(records, ring), b;
  for (std::size_t end = 0; end < 2; ++end)
    for (std::size_t i = 0; i < 3; ++i) {
      a.at[end][i] -= here.at[4 * end + i];
      b.at[end][i] = permuted(a.at[end][i], kNext[count]);
    }
  Float16 control[3][3];
  cross(a, b, control);
  // The direction is the mean of the normals, about the middle of the interval.
  Float16 middle[3], squared = {};
  for (std::size_t i = 0; i < 3; ++i) {
    middle[i] = control[0][i] + control[1][i] + control[2][i];
    squared += middle[i] * middle[i];
  }
  const Float16 reciprocal = 1 / (square_root(squared) + kTiny);
  float direction[3];
  for (std::size_t i = 0; i < 3; ++i) direction[i] = sum(middle[i] * reciprocal);

  const Float16 slack = all_lanes(2 * positions.error());
  const Float16 longest_a = largest_component(a) + slack, longest_b = largest_component(b) + slack;
  const float largest = std::max({std::abs(direction[0]), std::abs(direction[1]), std::abs(direction[2])});
  const Float16 area = longest_a * longest_b;
  const Float16 bound =
      largest * (12.2F * positions.error() * (longest_a + longest_b) + 50 * 0x1p-24F * area);
  const auto along = [&](int n) {
    return control[n][0] * direction[0] + control[n][1] * direction[1] + control[n][2] * direction[2];
  };
  const unsigned positive = above(along(0), bound) & above(along(1), 2 * bound) & above(along(2), bound) &
                            above(area, all_lanes(kTiny));
  if (!(largest > 1e-6F) || positive != 0xffffU) return false;
  if (distance > 0) {
    const Float16 least = smaller(smaller(along(0) - bound, along(2) - bound), along(1) / 2 - bound);
    const float length =
        std::sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    const Float16 off = 8 * positions.error() + 0x1p-22F * (longest_a + longest_b);
    if (!(least_height(least / (kRoundUp * length), a, b, off) > distance)) return false;
  }

  // Take the direction in the middle of the first triangle at t = 0. A triangle contains it only if the
  // triangle has a corner on either side of it.
  float side[3], steepness = 0;  // the plane through that direction and `direction`
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    side[i] = direction[j] * (a.at[0][k][0] + b.at[0][k][0]) - direction[k] * (a.at[0][j][0] + b.at[0][j][0]);
    steepness += std::abs(side[i]);
  }
  if (!(steepness > kLeastSide * largest * (longest_a[0] + longest_b[0])))
    return false;  // then it is mostly rounding
  const auto from_side = [&](const PatchLanes& edge) {
    return edge.at[0][0] * side[0] + edge.at[0][1] * side[1] + edge.at[0][2] * side[2];
  };
  const auto off = [&](Float16 longest) {
    return steepness * (kOffSide * longest + 2.1F * positions.error());
  };
  const unsigned beyond = above(from_side(a), off(longest_a)) | above(-off(longest_b), from_side(b));
  return std::popcount(0xffffU >> (kLanes16 - count) & ~beyond) == 1;
}

}  // namespace cscd::fast
