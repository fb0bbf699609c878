#pragma once

#include <cstdint>
#include <optional>

namespace cscd {

// The sizes of the orientation classes over the interval, and the number of clusters that culling used.
struct RadialCounts {
  std::uint64_t positive = 0, negative = 0, uncertain = 0;  // triangles
  std::uint64_t clusters = 0;  // mega clusters, or atomic clusters where a strategy merges none
};

// The counters of a culler for one interval.
struct CullCounts {
  std::optional<std::uint64_t> bvot = 0;  // bounding volume overlap tests; absent where a library hides them
  std::uint64_t pctp = 0;                 // potentially colliding triangle pairs passed on
  std::optional<std::uint64_t> contour_box_tests;  // of projected contours in the plane; not part of bvot
  std::optional<RadialCounts> radial;
};

// The counters of the pair tester for one interval: what became of the triangle
// pairs that the culler passed on.
struct PairCounts {
  std::uint64_t adjacent_pctp = 0;     // pairs whose triangles share a vertex
  std::uint64_t relative_dropped = 0;  // non-adjacent pairs dropped by their relative boxes
  std::uint64_t feature_pairs = 0;     // carried by the remaining triangle pairs, with repetitions
  std::uint64_t elementary_tests = 0;  // different feature pairs that the filter left
};

}  // namespace cscd
