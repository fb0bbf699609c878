#pragma once

#include "core/detect/strategy.h"

namespace cscd {

// Debian 12 has version 3, Debian 13 has version 4. A record has to tell them apart.
#if __has_include(<embree3/rtcore.h>)
inline constexpr char kEmbreeTitle[] = "Embree 3, rtcCollide of boxes";
#else
inline constexpr char kEmbreeTitle[] = "Embree 4, rtcCollide of boxes";
#endif

// Takes Embree's rtcCollide of a scene with itself (Intel's ray tracing kernels, version 3 or 4) as the broad
// phase. Throws InputError if Embree has no device on this machine. The detector throws
// std::runtime_error if Embree fails.
Prepared make_embree(const StrategyInput& setup);

}  // namespace cscd
