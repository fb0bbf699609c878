#pragma once

#include <cstdint>
#include <optional>

namespace cscd {

// The sizes of the orientation classes in the interval, and the number of clusters in force.
struct RadialCounts {
  std::uint64_t positive = 0, negative = 0, uncertain = 0;  // triangles
  std::uint64_t clusters = 0;  // mega clusters, or atomic clusters where a strategy merges none
};

// What the culling did in an interval.
struct CullCounts {
  std::optional<std::uint64_t> bvot = 0;  // bounding volume overlap tests; absent where a library hides them
  std::uint64_t pctp = 0;                 // potentially colliding triangle pairs passed on
  std::optional<std::uint64_t>
      contour_box_tests;  // box tests of projected contours in the plane, which do not count as bvot
  std::optional<RadialCounts> radial;
};

// What the pair tester did with the pairs that were passed on.
struct PairCounts {
  std::uint64_t adjacent_pctp = 0;     // pairs whose triangles share a vertex
  std::uint64_t relative_dropped = 0;  // non-adjacent pairs dropped by their relative boxes
  std::uint64_t feature_pairs =
      0;  // feature pairs carried by the other pairs, counted as often as they are carried
  std::uint64_t elementary_tests = 0;  // distinct feature pairs that the filter left
};

}  // namespace cscd
