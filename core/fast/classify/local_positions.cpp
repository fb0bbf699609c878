#include "core/fast/classify/local_positions.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/geometry/simd_doubles.h"
#include "core/geometry/simd_floats.h"

// A coordinate x becomes float((x - origin) * scale). The difference rounds by 2^-53 of itself, the product
// is exact (or far below 1e-37), and the conversion rounds by 2^-24 of itself. With M the largest result, the
// error is below 2^-24 (1 + 2^-20) M + 1e-37. What the coordinates are off themselves, `off`, comes on top.
//
// The origin may be any point that moves in a straight line, rounded or not: taking it from every vertex
// takes the same from both sides of every pair at every time, so what touches, and when, stays as it was.
namespace cscd::fast {
namespace {

constexpr float kLargest = 1e9F;      // triple products of such lengths are far from overflow
constexpr std::size_t kRange = 8192;  // vertices that are converted together, 10 microseconds of work
constexpr std::size_t kSamples = 16;  // vertices whose ways say how the surface flies

}  // namespace

LocalPositions::LocalPositions(std::span<const Vec3> reference) : scale_(1), records_(reference.size()) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : reference) box.extend(p);
  const double size = reference.empty() ? 0 : box.sizes().maxCoeff();
  if (std::isnormal(size) && size < 1e300 && size > 1e-300) scale_ = std::ldexp(1.0, -std::ilogb(size));
}

void LocalPositions::update(const Motion& motion, const ThreadPool& pool, double off) {
  convert_all(motion, pool, [](const auto& /*start*/, const auto& end) { return end; });
  add_error(off);
}

// A position start + last (end - start) rounds three times. The products are no larger than the difference of
// two positions in the part, so all roundings together are below 2^-50 times the largest coordinate in it.
void LocalPositions::update_beginning(const Motion& motion, double last, const ThreadPool& pool) {
  convert_all(motion, pool, [&](const auto& start, const auto& end) { return start + last * (end - start); });
  add_error(0x1p-50 * largest_in_scene());
}

// Converts the start and what at(start, end) makes of the start and the end of four coordinates.
template <class At>
void LocalPositions::convert_all(const Motion& motion, const ThreadPool& pool, const At& at) {
  const std::size_t count = records_.size();
  origin_[0] = motion.start()[0];
  const Vec3 way = common_way(motion);
  origin_[1] = at(origin_[0], Vec3(origin_[0] + way));
  largest_.resize(pool.ranges_of(count, kRange));
  pool.ranges(count, kRange, [&](std::size_t first, std::size_t last, std::size_t part) {
    largest_[part] = convert(motion, first, last, at);
  });
  const auto largest = std::bit_cast<float>(*std::max_element(largest_.begin(), largest_.end()));
  known_ = largest <= kLargest;
  error_ = 0x1.00002p-24F * largest + 1e-37F;
}

// The mean way of some vertices where it is longer than the reference pose is large, else none: the counts of
// ordinary steps stay what they are with an origin that rests.
Vec3 LocalPositions::common_way(const Motion& motion) const {
  const std::size_t count = records_.size();
  Vec3 way = Vec3::Zero();
  for (std::size_t i = 0; i < kSamples; ++i) {
    const std::size_t v = i * count / kSamples;
    way += (motion.end()[v] - motion.start()[v]) / double{kSamples};
  }
  return way.cwiseAbs().maxCoeff() * scale_ > 1 ? way : Vec3::Zero();
}

void LocalPositions::add_error(double off) {
  known_ = known_ && off * scale_ <= 0x1p14 * double{error_};
  error_ = error_beside(off);
}

double LocalPositions::largest_in_scene() const {
  const double origin = std::max(origin_[0].cwiseAbs().maxCoeff(), origin_[1].cwiseAbs().maxCoeff());
  return 1.0001 * (origin + 0x1p24 * double{error_} / scale_);
}

// Converts a range of vertices and returns the bits of the largest coordinate's size. Bits are ordered as the
// sizes are, with anything that is not a number above all of them, and their maximum takes one cycle.
template <class At>
std::int32_t LocalPositions::convert(const Motion& motion, std::size_t first, std::size_t last,
                                     const At& at) {
  const auto& [from, to] = origin_;
  const Lane8 origin = {from.x(), from.y(), from.z(), 0, to.x(), to.y(), to.z(), 0};
  const Lane8 scale = {scale_, scale_, scale_, 0, scale_, scale_, scale_, 0};
  Int8 most = {};
  const auto convert = [&](const double* start, const double* end, float* out) {
    const auto p = loaded<HalfOf<double>>(start), q = loaded<HalfOf<double>>(end);
    const Lane8 both = joined<Lane8>(p, HalfOf<double>(at(p, q)));
    const Float8 f = converted<Float8>((both - origin) * scale);
    store(f, out);
    most = larger(most, Int8(bits_as<Int8>(f) & 0x7fffffff));
  };
  const double *start = motion.start()[0].data(), *end = motion.end()[0].data();
  Record* const records = records_.data();
  const std::size_t whole = std::min(last, records_.size() - 1);
  for (std::size_t v = first; v < whole; ++v) convert(start + 3 * v, end + 3 * v, records[v].at);
  // A load of four numbers at the last vertex of the mesh would read past the end of the positions.
  for (std::size_t v = whole; v < last; ++v) {
    double points[2][4] = {};
    std::memcpy(points[0], start + 3 * v, 3 * sizeof(double));
    std::memcpy(points[1], end + 3 * v, 3 * sizeof(double));
    convert(points[0], points[1], records[v].at);
  }
  std::int32_t largest = 0;
  for (const int i : {0, 1, 2, 4, 5, 6}) largest = std::max(largest, most[i]);
  return largest;
}

}  // namespace cscd::fast
