#include "scenes/exchange/mesh_cache.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>

#include "core/base/error.h"
#include "scenes/exchange/number_bytes.h"

namespace cscd::scenes {
namespace {

constexpr std::string_view kPc2Begin("POINTCACHE2\0", 12);
constexpr std::size_t kPc2Head = 32, kMddHead = 8;
// Seconds are single precision. A frame whose number differs from a whole one by less than this has that one.
constexpr double kNearFrame = 0.01;

void append_float(double value, bool big, std::string& out) {
  append_bits(std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4, big, out);
}

bool is_big(MeshCacheFormat format) {
  return format == MeshCacheFormat::mdd;
}

}  // namespace

std::string mesh_cache_head(MeshCacheFormat format, std::size_t vertices, std::size_t frames, double fps,
                            double first_frame) {
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
  if (vertices > kMost || frames > kMost)
    throw InputError("more frames or vertices than a mesh cache can count; export it as .h5");
  std::string out;
  if (format == MeshCacheFormat::pc2) {
    out = kPc2Begin;
    append_bits(1, 4, false, out);  // version
    append_bits(vertices, 4, false, out);
    append_float(first_frame, false, out);
    append_float(1, false, out);  // frames from one sample to the next
    append_bits(frames, 4, false, out);
  } else {
    append_bits(frames, 4, true, out);
    append_bits(vertices, 4, true, out);
    for (std::size_t f = 0; f < frames; ++f)
      append_float((first_frame + static_cast<double>(f)) / fps, true, out);
  }
  return out;
}

std::string mesh_cache_frame(MeshCacheFormat format, std::span<const Vec3> positions) {
  std::string out;
  out.reserve(12 * positions.size());
  for (const Vec3& x : positions)
    for (int axis = 0; axis < 3; ++axis) append_float(x[axis], is_big(format), out);
  return out;
}

MeshCache::MeshCache(MeshCacheFormat format, std::string_view bytes) : format_(format) {
  const bool pc2 = format == MeshCacheFormat::pc2;
  const std::size_t fixed = pc2 ? kPc2Head : kMddHead;
  if (bytes.size() < fixed || (pc2 && !bytes.starts_with(kPc2Begin)))
    throw InputError(std::string("is no ") + (pc2 ? "PC2" : "MDD") + " cache; export it again");
  const auto count = [&](std::size_t at) { return bits_of(bytes.substr(at, 4), is_big(format)); };
  if (pc2 && count(kPc2Begin.size()) != 1)
    throw InputError("is of version " + std::to_string(count(kPc2Begin.size())) +
                     " of PC2, and version 1 alone is known; export it again");
  vertices_ = count(pc2 ? 16 : 4);
  frames_ = count(pc2 ? 28 : 0);
  const std::uint64_t head = fixed + (pc2 ? 0 : 4 * frames_), each = 12 * vertices_;
  if (vertices_ == 0 || frames_ == 0) throw InputError("holds no frame; export it again");
  if (bytes.size() < head || (bytes.size() - head) / each != frames_ || (bytes.size() - head) % each != 0)
    throw InputError("says that it has " + std::to_string(frames_) + " frames of " +
                     std::to_string(vertices_) + " vertices, which is not what its " +
                     std::to_string(bytes.size()) + " bytes hold; export it again");
  body_ = bytes.substr(head);
  read_times(bytes);
}

// An MDD cache holds the second of every frame. Its rate is known where they are evenly spaced.
void MeshCache::read_times(std::string_view bytes) {
  const auto float_at = [&](std::size_t at) {
    return double{
        std::bit_cast<float>(static_cast<std::uint32_t>(bits_of(bytes.substr(at, 4), is_big(format_))))};
  };
  if (format_ == MeshCacheFormat::pc2) {
    if (const double first = float_at(20); std::isfinite(first)) first_frame_ = first;
    if (const double step = float_at(24); step != 1) {
      char digits[32];
      std::snprintf(digits, sizeof digits, "%g", step);
      throw InputError(std::string("its samples are ") + digits +
                       " frames apart, at byte 24, and only caches with a sample a frame are read; export it "
                       "again with a sampling of 1");
    }
    return;
  }
  const auto second = [&](std::size_t frame) { return float_at(kMddHead + 4 * frame); };
  if (frames_ < 2) return;
  for (std::size_t f = 1; f < frames_; ++f)
    if (!(second(f) >= second(f - 1)))
      throw InputError("frame " + std::to_string(f) +
                       ": its time is before that of the frame before, or no number; export it again");
  const double first = second(0), step = (second(frames_ - 1) - first) / static_cast<double>(frames_ - 1);
  if (!(step > 0) || !std::isfinite(step)) return;
  for (std::size_t f = 0; f < frames_; ++f)
    if (!(std::abs(second(f) - (first + static_cast<double>(f) * step)) <= 0.01 * step)) return;
  const double rate = 1 / step, whole = std::round(rate);
  fps_ = std::abs(rate - whole) <= 1e-3 * rate ? whole : rate;
  const double number = first * *fps_, nearest = std::round(number);
  first_frame_ = std::abs(number - nearest) <= kNearFrame ? nearest : number;
}

void MeshCache::read_frame(std::size_t frame, std::vector<Vec3>& positions) const {
  positions.resize(vertices_);
  std::size_t at = 12 * vertices_ * frame;
  for (Vec3& x : positions)
    for (int axis = 0; axis < 3; ++axis, at += 4)
      x[axis] =
          std::bit_cast<float>(static_cast<std::uint32_t>(bits_of(body_.substr(at, 4), is_big(format_))));
}

}  // namespace cscd::scenes
