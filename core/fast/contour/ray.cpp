#include "core/fast/contour/ray.h"

#include <algorithm>
#include <cmath>

// Rounding (rule error-bound). Let u = 2^-24, M the largest coordinate of the vertices, Q the largest
// coordinate of the viewpoint, and d = `error`, which is at least u M. A vector r from the viewpoint is off
// by d + u |r| in each component, and u |r| <= 1.01 (d + u Q). The product of r with a vector of components
// up to one is off by 3 (d + u |r|) and by three roundings of at most 3.03 u |r| each: less than E = 20 d +
// 16 u Q. Such a product times u is less than E / 5. A difference a b - a' b' of two products of such numbers
// is off by at most
//   E (|a| + |b| + |a'| + |b'|) + 2 E^2 + 3 u (|a b| + |a' b'|) <= 2 E (|a| + |b| + |a'| + |b'| + E).
//
// The side on which a ray along p x q passes an edge v w is the sign of
//   (p x q) . (v x w) = (p.v)(q.w) - (p.w)(q.v).
// The ray crosses a triangle that is positive towards the viewpoint if the signs of all three edges are
// positive.
namespace cscd::fast {
namespace {

constexpr float kLeastError = 1e-15F;  // its square does not underflow

Float16 product(const float (&a)[3], const Float16 (&b)[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void cross(const float (&a)[3], const float (&b)[3], float (&out)[3]) {
  for (int i = 0; i < 3; ++i) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

// Returns zero where squares underflow. Such a ray certainly crosses nothing, and lies outside of no cone.
void normalize(float (&a)[3]) {
  const float length = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  for (float& x : a) x = length > kLeastError ? std::clamp(x / length, -1.0F, 1.0F) : 0;
}

}  // namespace

Ray::Ray(const Viewpoint& viewpoint, const float (&through)[3], float error) {
  float most = 0;
  for (int i = 0; i < 3; ++i) {
    from_[i] = viewpoint.at[0][i];
    along_[i] = through[i] - from_[i];
    most = std::max(most, std::abs(from_[i]));
  }
  normalize(along_);
  float axis[3] = {};
  axis[std::min_element(along_, along_ + 3, [](float a, float b) { return std::abs(a) < std::abs(b); }) -
       along_] = 1;
  cross(along_, axis, across_);
  normalize(across_);
  cross(along_, across_, up_);
  normalize(up_);
  error_ = std::max(kLeastError, 20 * error + 16 * 0x1p-24F * most);
}

bool Ray::may_cross(const PatchLanes& lanes) const {
  Float16 r[3];
  for (int i = 0; i < 3; ++i) r[i] = lanes.at[0][i] - from_[i];
  const Float16 a = product(across_, r), b = product(up_, r), error = all_lanes(error_);
  return above(a, error) != 0xffff && above(-error, a) != 0xffff && above(b, error) != 0xffff &&
         above(-error, b) != 0xffff;
}

Ray::Crossed Ray::crossed(const PatchLanes& lanes, const Patch& patch) const {
  Float16 r[3];
  for (int i = 0; i < 3; ++i) r[i] = lanes.at[0][i] - from_[i];
  const Float16 across = product(across_, r), up = product(up_, r);
  Float16 a[3], b[3];
  for (std::size_t k = 0; k < 3; ++k) {
    a[k] = permuted(across, patch.corner[k]);
    b[k] = permuted(up, patch.corner[k]);
  }
  Crossed out{0xffff, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t n = (k + 1) % 3;
    const Float16 sign = a[k] * b[n] - a[n] * b[k];
    const Float16 bound =
        2 * error_ * (absolute(a[k]) + absolute(b[k]) + absolute(a[n]) + absolute(b[n]) + error_);
    out.certainly &= above(sign, bound);
    out.certainly_not |= above(-bound, sign);
  }
  return out;
}

// `along_` differs from the exact direction of the ray by a few roundings, which 1e-5 pays for.
bool Ray::outside(const Cone& cone) const {
  const float between = along_[0] * cone.axis[0] + along_[1] * cone.axis[1] + along_[2] * cone.axis[2];
  const bool has_direction = along_[0] != 0 || along_[1] != 0 || along_[2] != 0;
  return has_direction && between < cone.cosine - 1e-5F;
}

}  // namespace cscd::fast
