#include "core/fast/contour/direction_cones.h"

#include <algorithm>
#include <cmath>

// Rounding (rule error-bound). Let u = 2^-24 and d = `error`. A vector r from the viewpoint is off by d + u
// |r| in each component. Its direction is off by less than 4 d / |r| + 4 u, and the cosine of its angle with
// the axis by that and a few u. The results below that are computed from cosines, sines and vectors of length
// about one are off by less than kRounding.
namespace cscd::fast {
namespace {

constexpr float kRounding = 4e-6F;
constexpr float kLeastCosine = 0.1F;
constexpr float kLeastLength = 100;  // in units of the error

Float16 dot(const Float16 (&a)[3], const Float16 (&b)[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

struct Directions {
  PatchLanes to;     // the direction to each vertex, of unit length
  Float16 nearness;  // the reciprocal of the shorter of the distances at both ends
};
Directions directions(const PatchLanes& lanes, const Viewpoint& viewpoint) {
  Directions out;
  for (int end = 0; end < 2; ++end) {
    Float16 r[3];
    for (int i = 0; i < 3; ++i) r[i] = lanes.at[end][i] - viewpoint.at[end][i];
    const Float16 reciprocal = 1 / square_root(dot(r, r));
    out.nearness = end == 0 ? reciprocal : larger(out.nearness, reciprocal);
    for (int i = 0; i < 3; ++i) out.to.at[end][i] = r[i] * reciprocal;
  }
  return out;
}

// A corner of sixteen triangles, or of sixteen quadrilaterals: where the vertices are and which one it is.
struct Corner {
  const Directions& of;
  const Places16& place;
};
template <std::size_t kCorners>
Cones cones_about(const Corner (&corners)[kCorners], float error) {
  Cones cones;
  for (int i = 0; i < 3; ++i) {
    cones.axis[i] = Float16{};
    for (const Corner& c : corners) cones.axis[i] += permuted(c.of.to.at[0][i] + c.of.to.at[1][i], c.place);
  }
  const Float16 reciprocal = 1 / square_root(dot(cones.axis, cones.axis));
  for (Float16& component : cones.axis) component *= reciprocal;

  cones.known = 0xffff;
  cones.cosine = all_lanes(1);
  for (const Corner& c : corners) {
    const Float16 near = permuted(c.of.nearness, c.place);
    const Float16 slack = 4.1F * error * near + kRounding;
    cones.known &= above(all_lanes(1 / (kLeastLength * error)), near);
    for (int end = 0; end < 2; ++end) {
      Float16 r[3];
      for (int i = 0; i < 3; ++i) r[i] = permuted(c.of.to.at[end][i], c.place);
      cones.cosine = smaller(cones.cosine, dot(cones.axis, r) - slack);
    }
  }
  cones.sine = square_root((1 - cones.cosine) * (1 + cones.cosine));
  // This is not a number where an axis vanishes, and then compares as false.
  cones.known &= above(cones.cosine, all_lanes(kLeastCosine));
  return cones;
}

}  // namespace

Cones cones_of(const PatchLanes& lanes, const Patch& patch, const Viewpoint& viewpoint, float error) {
  const Directions to = directions(lanes, viewpoint);
  return cones_about({{to, patch.corner[0]}, {to, patch.corner[1]}, {to, patch.corner[2]}}, error);
}

Cones cones_of_strips(const PatchLanes& one, const PatchLanes& other, const Patch& patch,
                      const Viewpoint& viewpoint, float error) {
  const Directions to = directions(one, viewpoint), also_to = directions(other, viewpoint);
  return cones_about(
      {{to, patch.corner[1]}, {to, patch.corner[2]}, {also_to, patch.corner[1]}, {also_to, patch.corner[2]}},
      error);
}

std::optional<Cone> cone_of(std::span<const PatchLanes> lanes, const Viewpoint& viewpoint, float error) {
  Float16 sum[3] = {};
  for (const PatchLanes& some : lanes) {
    const Directions d = directions(some, viewpoint);
    for (int i = 0; i < 3; ++i) sum[i] += d.to.at[0][i] + d.to.at[1][i];
  }
  Cone cone{};
  float square = 0;
  for (int i = 0; i < 3; ++i) {
    for (std::size_t l = 0; l < kLanes16; ++l) cone.axis[i] += sum[i][l];
    square += cone.axis[i] * cone.axis[i];
  }
  if (!(square > 0)) return std::nullopt;  // this is true for what is not a number, too
  for (float& component : cone.axis) component /= std::sqrt(square);
  cone.cosine = 1;
  for (const PatchLanes& some : lanes) {
    const Directions d = directions(some, viewpoint);
    const Float16 slack = 4.1F * error * d.nearness + kRounding;
    if (above(all_lanes(1 / (kLeastLength * error)), d.nearness) != 0xffff) return std::nullopt;
    for (int end = 0; end < 2; ++end) {
      const Float16 cosine = cone.axis[0] * d.to.at[end][0] + cone.axis[1] * d.to.at[end][1] +
                             cone.axis[2] * d.to.at[end][2] - slack;
      for (std::size_t l = 0; l < kLanes16; ++l) cone.cosine = std::min(cone.cosine, cosine[l]);
    }
  }
  if (!(cone.cosine > kLeastCosine)) return std::nullopt;
  cone.sine = std::sqrt((1 - cone.cosine) * (1 + cone.cosine));
  return cone;
}

Mask16 apart(const Cones& cones, const Cone& other) {
  const Float16 between =
      cones.axis[0] * other.axis[0] + cones.axis[1] * other.axis[1] + cones.axis[2] * other.axis[2];
  // Both angles are below a right angle, so their sum is one that a cosine tells.
  const Float16 together = cones.cosine * other.cosine - cones.sine * other.sine;
  return above(together - kRounding, between) & cones.known;
}

void ConeSet::add(const Cone& cone) {
  if (size_ == blocks_.size() * kLanes16) blocks_.push_back(Cones{});
  Cones& block = blocks_[size_ / kLanes16];
  const std::size_t lane = size_++ % kLanes16;
  for (int i = 0; i < 3; ++i) block.axis[i][lane] = cone.axis[i];
  block.cosine[lane] = cone.cosine;
  block.sine[lane] = cone.sine;
  block.known = 0xffff;
}

}  // namespace cscd::fast
