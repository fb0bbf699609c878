#pragma once

#include <cstddef>
#include <cstdint>

namespace cscd {

// Clusters, patches, labels and regions that may be missing have numbers with a sign: this one where there is
// none.
inline constexpr std::int32_t kNone = -1;
// Where one that is there stands in a list.
inline std::size_t index(std::int32_t number) {
  return static_cast<std::size_t>(number);
}

}  // namespace cscd
