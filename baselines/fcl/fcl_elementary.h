#pragma once

#include "core/elementary/question/elementary_test.h"

namespace cscd {

// The largest absolute coordinate that FCL is asked about, in lengths of the scene. Beyond it FCL's cubics
// may overflow, and its root finder then halves intervals for half a second.
inline constexpr double kFclFarthest = 1e100;

// Returns FCL's own tests of a vertex and a face and of two edges (fcl::detail::Intersect), as a row of the
// catalogue of elementary tests. Their answer is undecided if a coordinate lies beyond kFclFarthest.
ElementaryTest fcl_elementary_test();

}  // namespace cscd
