#pragma once

#include <cstdint>
#include <utility>
#include <vector>

// Disjoint sets of numbers. Each number has its parent, and a root has minus the number of its elements, or
// of what these stand for.
namespace cscd {

inline std::int32_t root_of(std::vector<std::int32_t>& parent, std::int32_t i) {
  const auto at = [&](std::int32_t k) -> std::int32_t& { return parent[static_cast<std::size_t>(k)]; };
  while (at(i) >= 0) {
    if (at(at(i)) >= 0) at(i) = at(at(i));
    i = at(i);
  }
  return i;
}

inline void unite(std::vector<std::int32_t>& parent, std::int32_t a, std::int32_t b) {
  a = root_of(parent, a);
  b = root_of(parent, b);
  if (a == b) return;
  const auto at = [&](std::int32_t k) -> std::int32_t& { return parent[static_cast<std::size_t>(k)]; };
  if (at(a) > at(b)) std::swap(a, b);
  at(a) += at(b);
  at(b) = a;
}

}  // namespace cscd
