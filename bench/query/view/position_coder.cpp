#include "bench/query/view/position_coder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace cscd::bench {
namespace {

constexpr double kPlaces = 65535;

// Which of two sets of small numbers compresses better, told by the bits that their numbers have.
std::uint64_t bits_of(std::span<const std::uint16_t> numbers) {
  std::uint64_t bits = 0;
  for (const std::uint16_t number : numbers)
    bits += static_cast<std::uint64_t>(std::bit_width(static_cast<unsigned>(number)));
  return bits;
}

}  // namespace

void ViewGrid::include(std::span<const Vec3> positions) {
  for (const Vec3& x : positions) {
    low_ = low_.cwiseMin(x);
    high_ = high_.cwiseMax(x);
  }
}

double ViewGrid::step() const {
  return std::max((high_ - low_).maxCoeff() / kPlaces, std::numeric_limits<double>::min());
}

void ViewGrid::append_places(std::span<const Vec3> positions, std::vector<std::uint16_t>& places) const {
  const double per_length = 1 / step();
  for (int axis = 0; axis < 3; ++axis)
    for (const Vec3& x : positions)
      places.push_back(static_cast<std::uint16_t>(
          std::clamp(std::round((x[axis] - low_[axis]) * per_length), 0.0, kPlaces)));
}

void PositionCoder::append(std::span<const Vec3> positions) {
  std::rotate(last_.begin(), last_.end() - 1, last_.end());
  last_[0].clear();
  grid_.append_places(positions, last_[0]);
  const std::size_t predictors = std::min<std::size_t>(frames_, 2) + 1;
  std::size_t best = 0;
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  for (std::size_t p = 0; p < predictors; ++p) {
    code(static_cast<std::uint8_t>(p), trial_[p]);
    if (const std::uint64_t bits = bits_of(trial_[p]); bits < least) {
      least = bits;
      best = p;
    }
  }
  bytes_.push_back(static_cast<std::uint8_t>(best));
  for (const int shift : {0, 8})
    for (const std::uint16_t number : trial_[best])
      bytes_.push_back(static_cast<std::uint8_t>(number >> shift));
  ++frames_;
}

void PositionCoder::code(std::uint8_t predictor, std::vector<std::uint16_t>& missed) const {
  missed.resize(last_[0].size());
  std::uint16_t before = 0;
  for (std::size_t i = 0; i < missed.size(); ++i) {
    int prediction = 0;
    if (predictor == 1) prediction = last_[1][i];
    if (predictor == 2) prediction = 2 * last_[1][i] - last_[2][i];
    const auto miss = static_cast<std::uint16_t>(last_[0][i] - prediction);
    const auto step = static_cast<std::int16_t>(static_cast<std::uint16_t>(miss - before));
    missed[i] = static_cast<std::uint16_t>((step << 1) ^ (step >> 15));
    before = miss;
  }
}

}  // namespace cscd::bench
