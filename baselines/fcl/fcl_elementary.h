#pragma once

#include "core/elementary/question/elementary_test.h"

namespace cscd {

// Coordinates beyond which FCL's cubics may overflow: its root finder then halves intervals for half a
// second.
inline constexpr double kFclFarthest = 1e100;

// FCL's own tests of a vertex and a face and of two edges (fcl::detail::Intersect), as a row of the
// catalogue. Undecided beyond kFclFarthest.
ElementaryTest fcl_elementary_test();

}  // namespace cscd
