#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace cscd::bench {

// An interval that two records have, and its place in the list of each.
struct SharedInterval {
  std::size_t interval, before, after;
};

// Returns the intervals that two ascending lists share, in order.
inline std::vector<SharedInterval> shared_intervals(std::span<const std::size_t> before,
                                                    std::span<const std::size_t> after) {
  std::vector<SharedInterval> shared;
  for (std::size_t a = 0, b = 0; a < before.size() && b < after.size();) {
    const std::size_t least = std::min(before[a], after[b]);
    if (before[a] == after[b]) shared.push_back({least, a, b});
    a += before[a] == least;
    b += after[b] == least;
  }
  return shared;
}

}  // namespace cscd::bench
