#pragma once

#include "scenes/shape/shape.h"

namespace cscd::scenes {

// Returns the same character with four times the triangles, by one step of Loop's subdivision ("Smooth
// subdivision surfaces based on triangles", 1987) with Warren's weights ("Subdivision methods for geometric
// design", 1995), which need no cosine. Skinning weights are blended like positions; if more than four
// bones have weight, the heaviest four stay. The skeleton stays as it is. Throws InputError for a surface
// that is not closed and oriented.
Shape subdivided(const Shape& shape);

}  // namespace cscd::scenes
