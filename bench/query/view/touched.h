#pragma once

#include <vector>

#include "core/detect/contact.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::bench {

// Marks the triangles that have a feature of the pair, in `touched` [triangles].
void mark_touched(const TriangleMesh& mesh, const FeaturePair& pair, std::vector<bool>& touched);

}  // namespace cscd::bench
