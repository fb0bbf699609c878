#pragma once

#include <span>
#include <string>

#include "core/fast/cut/cut_surface.h"

namespace cscd::fast {

// What takes time to decide when a surface is cut. The rest of a CutSurface is made from it and the mesh.
struct DecidedCut {
  std::size_t covers_used;  // how many of the covers are looked from
  Covers covers;
  PatchList patches;
};

// Throws InputError, saying that a preparation has this fault.
[[noreturn]] void refuse_preparation(const std::string& fault);

// Throws InputError for what breaks a rule that the theorems rely on (core/soundness.md): each triangle is in
// one patch and one cluster of the first cover, no patch is in two clusters of a cover, no cluster is in two
// components, and observers follow vertices that there are. The numbers of clusters must be in range.
void check(const TriangleMesh& mesh, const DecidedCut& decided);

// Makes the rest. `decided` has been checked.
CutSurface finished(const TriangleMesh& mesh, std::span<const Vec3> reference, DecidedCut decided);

}  // namespace cscd::fast
