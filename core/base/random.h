#pragma once

#include <cstddef>
#include <random>
#include <utility>
#include <vector>

namespace cscd {

// The seed of whatever a preparation draws, so that the same input is always prepared alike.
inline constexpr unsigned kPreparationSeed = 20140314;

// Puts the items into a random order (Fisher and Yates). Written out here, because std::shuffle may give
// different orders in different standard libraries.
template <class Item, class Random>
void shuffle(std::vector<Item>& items, Random& random) {
  for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[random() % i]);
}

}  // namespace cscd
