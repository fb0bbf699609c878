#pragma once

#include "core/detect/strategy.h"

// Strategies without knowledge of the surface: hierarchies of bounds, and none at all.
namespace cscd {

// "Base" of the paper's section 7.1: a plain hierarchy of swept 16-DOPs, split at the
// median (Klosowski et al. 1998).
Prepared make_base(const StrategyInput& setup);

// "AABB" of the paper's section 7.1: a hierarchy of swept axis-aligned boxes (van den Bergen, Journal of
// Graphics Tools 2(4), cited there as 1999).
Prepared make_aabb(const StrategyInput& setup);

// All pairs of triangles, the oracle for small meshes. Quadratic.
Prepared make_brute(const StrategyInput& setup);

}  // namespace cscd
