#pragma once

#include "core/detect/strategy.h"

namespace cscd {

// Takes Embree's rtcCollide of a scene with itself (Intel's ray tracing kernels, version 3) as the broad
// phase. Throws InputError if Embree has no device on this machine. The detector throws
// std::runtime_error if Embree fails.
Prepared make_embree(const Setup& setup);

}  // namespace cscd
