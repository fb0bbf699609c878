#pragma once

#include <algorithm>

namespace cscd {

// Sorts items, and leaves one of those that are equal.
template <class Items>
void sort_unique(Items& items) {
  std::ranges::sort(items);
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace cscd
