#pragma once

#include <span>
#include <string>

#include "core/detect/strategy.h"

namespace cscd::radial {

// Throws InputError, naming what lacks, unless the mesh is closed and consistently oriented and there are
// bones.
void require_radial_setup(const Setup& setup, const std::string& strategy);

// Cells along the longest side of the mesh's box that make a cell about a mean edge wide; at most 256.
int full_resolution(const TriangleMesh& mesh, std::span<const Vec3> reference);

}  // namespace cscd::radial
