#pragma once

#include "core/detect/strategy.h"

namespace cscd {

// Embree's rtcCollide of a scene with itself (Intel's ray tracing kernels, version 3) as broad phase.
Prepared make_embree(const Setup& setup);

}  // namespace cscd
