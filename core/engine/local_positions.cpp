#include "core/engine/local_positions.h"

#include <algorithm>
#include <cmath>
#include <cstring>

// A coordinate x becomes float((x - origin) * scale). The difference rounds by 2^-53 of itself, the product
// is exact (or far below 1e-37), the conversion rounds by 2^-24 of itself: with M the largest result the
// error is below 2^-24 (1 + 2^-20) M + 1e-37.
namespace cscd::fast {
namespace {

using Double4 = double __attribute__((vector_size(32)));
using Float4 = float __attribute__((vector_size(16)));

constexpr float kLargest = 1e9F;      // triple products of three such lengths are far from overflow
constexpr std::size_t kRange = 1024;  // vertices worth another thread

}  // namespace

LocalPositions::LocalPositions(std::span<const Vec3> reference) : scale_(1), records_(reference.size()) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : reference) box.extend(p);
  const double size = reference.empty() ? 0 : box.sizes().maxCoeff();
  if (std::isnormal(size) && size < 1e300 && size > 1e-300) scale_ = std::ldexp(1.0, -std::ilogb(size));
}

void LocalPositions::update(const Motion& motion, const Team& team) {
  const std::size_t count = records_.size();
  largest_.resize(team.ranges_of(count, kRange));
  team.ranges(count, kRange, [&](std::size_t first, std::size_t last, std::size_t part) {
    largest_[part] = convert(motion, first, last);
  });
  const float largest = *std::max_element(largest_.begin(), largest_.end());
  known_ = largest <= kLargest;
  error_ = 0x1.00002p-24F * largest + 1e-37F;
}

// Those of a range of vertices; returns the largest coordinate.
float LocalPositions::convert(const Motion& motion, std::size_t first, std::size_t last) {
  const Vec3 zeroth = motion.start()[0];
  const Double4 origin = {zeroth.x(), zeroth.y(), zeroth.z(), 0};
  const double scale = scale_;
  const Float4 zero = {};
  Float4 most = zero;
  const auto convert = [&](const double* x, float* out) {
    Double4 p;
    std::memcpy(&p, x, sizeof p);
    Float4 f = __builtin_convertvector((p - origin) * scale, Float4);
    f[3] = 0;
    std::memcpy(out, &f, sizeof f);
    const Float4 size = f < 0 ? -f : f;
    most = most < size ? size : most;
  };
  const double *start = motion.start()[0].data(), *end = motion.end()[0].data();
  Record* const records = records_.data();
  const std::size_t whole = std::min(last, records_.size() - 1);
  for (std::size_t v = first; v < whole; ++v) {
    convert(start + 3 * v, records[v].at);
    convert(end + 3 * v, records[v].at + 4);
  }
  // The fourth number behind the last vertex is not ours to read.
  for (std::size_t v = whole; v < last; ++v)
    for (const auto& [points, at] : {std::pair{start, 0}, std::pair{end, 4}}) {
      double point[4] = {};
      std::memcpy(point, points + 3 * v, 3 * sizeof(double));
      convert(point, records[v].at + at);
    }
  return std::fmax(most[0], std::fmax(most[1], most[2]));
}

}  // namespace cscd::fast
