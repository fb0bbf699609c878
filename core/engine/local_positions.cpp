#include "core/engine/local_positions.h"

#include <cmath>
#include <cstring>

// A coordinate x becomes float((x - origin) * scale). The difference rounds by 2^-53 of itself, the product
// is exact (or far below 1e-37), the conversion rounds by 2^-24 of itself: with M the largest result the
// error is below 2^-24 (1 + 2^-20) M + 1e-37.
namespace cscd::fast {
namespace {

using Double4 = double __attribute__((vector_size(32)));
using Float4 = float __attribute__((vector_size(16)));

constexpr float kLargest = 1e9F;  // triple products of three such lengths are far from overflow

}  // namespace

LocalPositions::LocalPositions(std::span<const Vec3> reference) : scale_(1), records_(reference.size()) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : reference) box.extend(p);
  const double size = reference.empty() ? 0 : box.sizes().maxCoeff();
  if (std::isnormal(size) && size < 1e300 && size > 1e-300) scale_ = std::ldexp(1.0, -std::ilogb(size));
}

void LocalPositions::update(const Motion& motion) {
  const Vec3 first = motion.start()[0];
  const Double4 origin = {first.x(), first.y(), first.z(), 0};
  const std::size_t count = records_.size();
  const Float4 zero = {};
  Float4 most = zero;
  const auto convert = [&](const double* x, float* out) {
    Double4 p;
    std::memcpy(&p, x, sizeof p);
    Float4 f = __builtin_convertvector((p - origin) * scale_, Float4);
    f[3] = 0;
    std::memcpy(out, &f, sizeof f);
    const Float4 size = f < 0 ? -f : f;
    most = most < size ? size : most;
  };
  const double *start = motion.start()[0].data(), *end = motion.end()[0].data();
  for (std::size_t v = 0; v + 1 < count; ++v) {
    convert(start + 3 * v, records_[v].at);
    convert(end + 3 * v, records_[v].at + 4);
  }
  // The fourth number behind the last vertex is not ours to read.
  for (const auto& [points, at] : {std::pair{start, 0}, std::pair{end, 4}}) {
    double last[4] = {};
    std::memcpy(last, points + 3 * (count - 1), 3 * sizeof(double));
    convert(last, records_[count - 1].at + at);
  }
  known_ = most[0] <= kLargest && most[1] <= kLargest && most[2] <= kLargest;
  const float largest = std::fmax(most[0], std::fmax(most[1], most[2]));
  error_ = 0x1.00002p-24F * largest + 1e-37F;
}

}  // namespace cscd::fast
