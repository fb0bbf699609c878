#include "core/detect/carried_pairs.h"

#include <array>

namespace cscd {
namespace {

// The places that two triangles carry, by the corners that they have in common: bit 3 i + k of the index is 1
// if corner i of the first triangle is corner k of the second.
constexpr std::array<CarriedPlaces, 512> kCarriedBy = [] {
  std::array<CarriedPlaces, 512> all{};
  for (unsigned same = 0; same < all.size(); ++same) {
    const auto is_same = [&](unsigned i, unsigned k) { return (same >> (3 * (i % 3) + k % 3) & 1) != 0; };
    const auto carry = [&](unsigned place, bool free) {
      all[same] = static_cast<CarriedPlaces>(all[same] | unsigned{free} << place);
    };
    for (unsigned i = 0; i < 3; ++i) {
      carry(i, !is_same(i, 0) && !is_same(i, 1) && !is_same(i, 2));
      carry(3 + i, !is_same(0, i) && !is_same(1, i) && !is_same(2, i));
      for (unsigned k = 0; k < 3; ++k)
        carry(6 + 3 * i + k,
              !is_same(i, k) && !is_same(i, k + 1) && !is_same(i + 1, k) && !is_same(i + 1, k + 1));
    }
  }
  return all;
}();

}  // namespace

CarriedPlaces carried_by(const Triangle& a, const Triangle& b) {
  unsigned same = 0;
  for (unsigned i = 0; i < 3; ++i)
    for (unsigned k = 0; k < 3; ++k) same |= static_cast<unsigned>(a[i] == b[k]) << (3 * i + k);
  return kCarriedBy[same];
}

}  // namespace cscd
