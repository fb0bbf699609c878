#include "core/fast/classify/patch_lanes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/simd_floats.h"

namespace cscd::fast {

float reach_of(const Viewpoint& viewpoint, float error) {
  float largest = 0;
  for (const auto& end : viewpoint.at)
    for (const float coordinate : end) largest = std::max(largest, std::abs(coordinate));
  return 1.0001F * (0x1p24F * error + largest);  // 0.0001 pays for roundings and for twice the error
}

Viewpoint placed(const FollowingPoint& point, std::span<const LocalPositions::Record> records) {
  Float8 sum = {};
  for (std::size_t i = 0; i < point.vertices().size(); ++i) {
    sum += point.weights()[i] * loaded<Float8>(records[+point.vertices()[i]].at);
  }
  Viewpoint out;
  for (std::size_t end = 0; end < 2; ++end)
    for (std::size_t k = 0; k < 3; ++k) out.at[end][k] = sum[4 * end + k];
  if (!point.stands_off()) return out;
  // By as much at both ends, so that the viewpoint moves in a straight line.
  std::array<Vec3, FollowingPoint::kMost> corners;
  for (std::size_t i = 0; i < point.vertices().size(); ++i) {
    const float(&at)[8] = records[+point.vertices()[i]].at;
    corners[i] = Vec3(at[0], at[1], at[2]);
  }
  const Vec3 offset = point.offset(std::span(corners).first(point.vertices().size()));
  for (auto& end : out.at)
    for (int k = 0; k < 3; ++k) end[k] += static_cast<float>(offset[k]);
  return out;
}

namespace {

// The corners of a patch's triangles. Results are written in place, register by register: gcc copies a struct
// of registers by halves, and loading a whole register waits long for the two stores.
class Corners {
 public:
  explicit Corners(const PatchLanes& lanes) : start_(lanes.at[0]), end_(lanes.at[1]) {}
  [[gnu::always_inline]] void take(const Places16& place, PatchLanes& out) const {
    start_.take(place, out.at[0]);
    end_.take(place, out.at[1]);
  }

 private:
  Points16 start_, end_;
};

[[gnu::always_inline]] inline void subtract(PatchLanes& to, const PatchLanes& from) {
  for (int end = 0; end < 2; ++end)
    for (int i = 0; i < 3; ++i) to.at[end][i] -= from.at[end][i];
}

}  // namespace

PatchLanes load(std::span<const LocalPositions::Record> records,
                const std::array<std::int32_t, kLanes16>& vertex) {
  // Each row holds two records: the eight numbers of one vertex, and of the fourth vertex behind it. Four
  // rows are transposed within their quarters; quarters of starts and of ends then alternate.
  Float16 half[2][3];
  for (std::size_t h = 0; h < 2; ++h) {
    Float16 row[4];
    for (std::size_t i = 0; i < 4; ++i) {
      const auto record = [&](std::size_t place) {
        return loaded<Float8>(records[static_cast<std::size_t>(vertex[place])].at);
      };
      row[i] = joined<Float16>(record(8 * h + i), record(8 * h + 4 + i));
    }
    const auto first_two = [](Float16 a, Float16 b) {
      return shuffled<0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29>(a, b);
    };
    const auto third = [](Float16 a, Float16 b) {
      return shuffled<2, 18, 2, 18, 6, 22, 6, 22, 10, 26, 10, 26, 14, 30, 14, 30>(a, b);
    };
    const auto even_pairs = [](Float16 a, Float16 b) {
      return shuffled<0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29>(a, b);
    };
    const auto odd_pairs = [](Float16 a, Float16 b) {
      return shuffled<2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31>(a, b);
    };
    const Float16 low01 = first_two(row[0], row[1]), low23 = first_two(row[2], row[3]);
    half[h][0] = even_pairs(low01, low23);
    half[h][1] = odd_pairs(low01, low23);
    half[h][2] = even_pairs(third(row[0], row[1]), third(row[2], row[3]));
  }
  PatchLanes out;
  for (int i = 0; i < 3; ++i) {
    out.at[0][i] = shuffled<0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27>(half[0][i], half[1][i]);
    out.at[1][i] =
        shuffled<4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31>(half[0][i], half[1][i]);
  }
  return out;
}

namespace {

// The control vectors of the normals, and what bounds their rounding.
struct PatchNormals {
  Float16 control[3][3];
  Float16 longest[2];  // the largest component of each of the two edges
};
// Computes the normals of a patch's triangles. `corner` holds one corner of each triangle.
[[gnu::always_inline]] inline void make_normals(const PatchLanes& lanes, const Patch& patch,
                                                PatchNormals& out, PatchLanes& corner) {
  PatchLanes a, b;
  const Corners corners(lanes);
  corners.take(patch.corner[0], corner);
  corners.take(patch.corner[1], a);
  corners.take(patch.corner[2], b);
  subtract(a, corner);
  subtract(b, corner);
  cross(a, b, out.control);
  out.longest[0] = largest_component(a);
  out.longest[1] = largest_component(b);
}

[[gnu::always_inline]] inline Signs orientation_of(const PatchNormals& normals, const PatchLanes& corner,
                                                   const Rounding16& rounding, const Viewpoint& viewpoint,
                                                   float error) {
  PatchLanes c;
  for (int end = 0; end < 2; ++end)
    for (int i = 0; i < 3; ++i) c.at[end][i] = corner.at[end][i] - all_lanes(viewpoint.at[end][i]);
  Float16 coefficient[4];
  coefficients(normals.control, c, coefficient);
  if (all_positive(coefficient, rounding, viewpoint.reach)) return {0xffff, 0};  // this is so nearly always
  const TripleProducts16 products = bounded(coefficient, c, rounding, error);
  return {products.positive(), products.negative()};
}

}  // namespace

Signs orientation(const PatchLanes& lanes, const Patch& patch, const Viewpoint& viewpoint, float error) {
  PatchNormals normals;
  PatchLanes corner;
  make_normals(lanes, patch, normals, corner);
  return orientation_of(normals, corner, rounding_of(normals.longest[0], normals.longest[1], error),
                        viewpoint, error);
}

void orientations(const PatchLanes& lanes, const Patch& patch, const Viewpoint* const (&from)[kCovers],
                  float error, Signs (&out)[kCovers]) {
  PatchNormals normals;
  PatchLanes corner;
  make_normals(lanes, patch, normals, corner);
  const Rounding16 rounding = rounding_of(normals.longest[0], normals.longest[1], error);
  for (std::size_t c = 0; c < kCovers; ++c)
    out[c] = from[c] ? orientation_of(normals, corner, rounding, *from[c], error) : Signs{};
}

namespace {

Float16 longer(Float16 squared, const PatchLanes& v) {
  for (const auto& end : v.at)
    squared = larger(squared, product_plus(end[2], end[2], product_plus(end[1], end[1], end[0] * end[0])));
  return squared;
}
// A bound on a length at every t, from the larger of its computed squares at both ends. Lengths are convex in
// time. The difference of two points is off by 2 `error` along each axis, and by a few roundings.
Float16 length_bound(Float16 squared, float error) {
  return 1.0001F * square_root(squared) + all_lanes(4 * error);
}

}  // namespace

// Lengths. Let L be the longest edge of a triangle and R its farthest point from the viewpoint q, both at any
// t. The normal n is at most L^2 long, so det = n . (p - q) > margin L^2 puts the plane farther than `margin`
// from q. The heights of "clear one-rings keep their distance" are det over |v x w|, |(v - u) x w| or |n|,
// all at most L max(L, R), because |v x w| is |w - v| times a distance from q. So det > height L max(L, R)
// makes a triangle tall. A cubic exceeds what its Bernstein coefficients exceed. R is at most the distance of
// one corner plus L.
void orientations_at_distance(const PatchLanes& lanes, const Patch& patch,
                              const Viewpoint* const (&from)[kCovers], float error, float margin,
                              float height, DistantSigns& out) {
  PatchLanes corner, a, b;
  const Corners corners(lanes);
  corners.take(patch.corner[0], corner);
  corners.take(patch.corner[1], a);
  corners.take(patch.corner[2], b);
  subtract(a, corner);
  subtract(b, corner);
  Float16 control[3][3];
  cross(a, b, control);
  const Rounding16 rounding = rounding_of(largest_component(a), largest_component(b), error);
  const Float16 longest = length_bound(longer(longer(longer(Float16{}, a), b), b - a), error);
  for (std::size_t c = 0; c < kCovers; ++c) {
    out.signs[c] = {};
    out.tall[c] = 0;
    if (!from[c]) continue;
    PatchLanes seen;
    for (int end = 0; end < 2; ++end)
      for (int i = 0; i < 3; ++i) seen.at[end][i] = corner.at[end][i] - all_lanes(from[c]->at[end][i]);
    TripleProducts16 products = triple_products(control, seen, rounding, error);
    const Float16 bound = products.bound;
    const auto exceeding = [&](Float16 least) {
      products.bound = bound + 1.0001F * least;
      products.bound3 = 3 * products.bound;
    };
    const Float16 farthest = length_bound(longer(Float16{}, seen), error) + longest;
    exceeding(all_lanes(height) * longest * farthest);
    out.tall[c] = products.positive();
    out.signs[c].positive = out.tall[c];
    if ((patch.lanes & ~static_cast<unsigned>(out.tall[c])) == 0) continue;
    exceeding(all_lanes(margin) * longest * longest);
    out.signs[c] = {products.positive(), products.negative()};
  }
}

}  // namespace cscd::fast
