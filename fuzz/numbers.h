#pragma once

#include <bit>
#include <cmath>
#include <cstring>

#include "core/base/vec3.h"
#include "fuzz/target.h"

namespace cscd::fuzz {

// Reads bytes as coordinates. The first byte says how: as small integers, which make features meet exactly
// where they are drawn to; as small integers off by a few units in the last place; as floats; or as doubles.
// Zeros follow the last byte. All coordinates are finite and at most 1e15 in size.
class Numbers {
 public:
  explicit Numbers(Bytes bytes) : bytes_(bytes), kind_(byte() % 4) {}

  bool empty() const { return bytes_.empty(); }
  std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const std::uint8_t first = bytes_[0];
    bytes_ = bytes_.subspan(1);
    return first;
  }
  // From -128 to 127, whatever the kind.
  double integer() { return static_cast<double>(static_cast<std::int8_t>(byte())); }
  double coordinate() {
    switch (kind_) {
      case 0:
        return integer();
      case 1: {
        const double whole = integer();
        const auto steps = static_cast<std::int64_t>(static_cast<std::int8_t>(byte())) % 8;
        return whole == 0 ? static_cast<double>(steps) * 0x1p-60
                          : std::bit_cast<double>(std::bit_cast<std::int64_t>(whole) + steps);
      }
      case 2:
        return bounded(static_cast<double>(std::bit_cast<float>(word<std::uint32_t>())));
      default:
        return bounded(std::bit_cast<double>(word<std::uint64_t>()));
    }
  }
  Vec3 point() {
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = coordinate();
    return p;
  }

 private:
  static double bounded(double x) { return std::isfinite(x) && std::abs(x) <= 1e15 ? x : 1; }
  template <class Word>
  Word word() {
    Word out = 0;
    for (std::size_t i = 0; i < sizeof out; ++i) out = static_cast<Word>(out << 8 | byte());
    return out;
  }

  Bytes bytes_;
  int kind_;
};

}  // namespace cscd::fuzz
