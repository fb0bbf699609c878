#include "core/detect/start/pose_crossings.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <iterator>

#include "core/base/sort_unique.h"
#include "core/elementary/exact/static_contact.h"

namespace cscd {

bool PoseCrossings::knows(std::span<const Vec3> positions) const {
  return !positions.empty() && same_bits(positions, positions_);
}

bool PoseCrossings::move_on(std::span<const Vec3> start, std::span<const Vec3> end, bool& finite) {
  if (start.size() != positions_.size() || positions_.empty()) return false;
  constexpr std::size_t kBlock = 1024;  // numbers, which stay in the nearest cache
  constexpr std::uint64_t kExponent = 0x7ff0'0000'0000'0000, kLowest = 0x0010'0000'0000'0000;
  const bool keeps = kept_steps_ > 0;
  if (keeps) room_.resize(positions_.size());
  const double *const from = start[0].data(), *const to = end[0].data();
  const double* const kept = positions_[0].data();
  double* const next = keeps ? room_[0].data() : positions_[0].data();
  const std::size_t count = 3 * positions_.size();
  std::uint64_t all = 0;
  for (std::size_t first = 0; first < count; first += kBlock) {
    const std::size_t last = std::min(first + kBlock, count);
    if (std::memcmp(from + first, kept + first, (last - first) * sizeof(double)) != 0) {
      if (!keeps) std::copy(from, from + first, next);  // what has been written over was the same
      return false;
    }
    for (std::size_t i = first; i < last; ++i) {
      // The sum reaches the sign where all bits of the exponent are set.
      all |= (std::bit_cast<std::uint64_t>(to[i]) & kExponent) + kLowest;
      next[i] = to[i];
    }
  }
  finite = all >> 63 == 0;
  if (keeps) {
    take_room();
    --kept_steps_;
  } else {
    before_.clear();
  }
  return true;
}

void PoseCrossings::take_room() {
  before_.swap(room_);
  before_.swap(positions_);
}

void PoseCrossings::go_back(std::span<const Vec3> start) {
  if (before_.empty())
    std::ranges::copy(start, positions_.begin());
  else
    positions_.swap(before_);
  before_.clear();
}

bool PoseCrossings::return_to(std::span<const Vec3> positions) {
  if (before_.empty() || !same_bits(positions, before_)) return false;
  positions_.swap(before_);
  keep_before();
  return true;
}

const Crossings& PoseCrossings::find(std::span<const Vec3> positions) {
  crossings_ = test_.find_all(positions, most_);
  before_.clear();
  positions_.assign(positions.begin(), positions.end());
  return crossings_;
}

void PoseCrossings::know(std::span<const Vec3> positions, const Crossings& crossings) {
  crossings_ = crossings;
  before_.clear();
  positions_.assign(positions.begin(), positions.end());
}

const Crossings& PoseCrossings::follow(std::span<const Vec3> positions, const ContactSet& touched) {
  if (positions_.empty() || !crossings_.all_kept()) return find(positions);
  if (touched.contacts.empty()) {
    room_.assign(positions.begin(), positions.end());  // for which memory may lack
    take_room();
    return crossings_;
  }

  const TriangleMesh& mesh = test_.mesh();
  std::vector<CrossingPair> changed;
  for (const Contact& contact : touched.contacts)
    for (const CrossingPair& pair : carriers(mesh, contact.pair)) changed.push_back(pair);
  sort_unique(changed);
  // Pose and crossings are replaced together at the end, where nothing throws any more.
  std::vector<CrossingPair> crossing;
  std::ranges::set_difference(crossings_.pairs, changed, std::back_inserter(crossing));
  for (const CrossingPair& pair : changed)
    if (triangles_meet(mesh, positions, pair.first, pair.second)) crossing.push_back(pair);
  std::sort(crossing.begin(), crossing.end());
  crossings_.pairs = std::move(crossing);
  crossings_.total = crossings_.pairs.size();
  before_.clear();
  positions_.assign(positions.begin(), positions.end());
  return crossings_;
}

}  // namespace cscd
