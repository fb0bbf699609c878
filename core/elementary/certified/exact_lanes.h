#pragma once

#include <span>

#include "core/elementary/certified/contact_time.h"
#include "core/elementary/question/elementary_test.h"
#include "core/geometry/simd_doubles.h"

// The stage of filtered_exact in double precision for up to eight queries side by side. Whatever lanes find
// is what the scalar stage finds, time included, as there is but one right answer.
namespace cscd {

// What is certain of eight queries, one bit each: that they never touch, or that the first contact of the
// query in lane l is at the only root of its coplanarity cubic between low[l] and high[l].
struct LaneFindings {
  unsigned apart = 0, contact = 0;
  Lane8 low, high;
};

// Looks at queries that are never in one plane, or that certainly are once.
template <class Query>
LaneFindings find_once_in_lanes(std::span<const Query* const> queries);
// Looks at each part of the interval in which the coplanarity cubic rises or falls, which costs more.
template <class Query>
LaneFindings find_in_parts_in_lanes(std::span<const Query* const> queries);

// The times of contacts between `low` and `high`, as time_in_pairs() gives them.
template <class Query>
CertainTime<Lane8> times_in_lanes(std::span<const Query* const> queries, Lane8 low, Lane8 high);

}  // namespace cscd
