#pragma once

#include "core/elementary/elementary_test.h"

namespace cscd {

// FCL's own tests of a vertex and a face and of two edges (fcl::detail::Intersect), as a row of the
// catalogue.
ElementaryTest fcl_elementary_test();

}  // namespace cscd
