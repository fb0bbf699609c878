#pragma once

#include "core/detect/strategy.h"

namespace cscd {

// The oracle: passes on all pairs of triangles, so it takes quadratic time.
Prepared make_brute(const Setup& setup);

}  // namespace cscd
