#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/fast/prepare/cut_surface.h"

namespace cscd::fast {

// A cut surface as bytes, which a caller may keep in a file, so that the same surface need not be cut again,
// and a surface that has changed in places only there (carried_cut.h).
//
// The bytes hold what was decided: the patches, and the clusters and observers of the covers. The rest is
// made from these and the mesh. Whatever was decided, answers are right, because no theorem of
// core/soundness.md asks how clusters and observers were found; a bad decision takes time alone. What the
// theorems do ask, that each triangle is in one patch and no cluster in two components, is checked when the
// bytes are read.
//
// The format is of one build: numbers as the machine has them, and a version that changes with the layout.

// `covers` is how many of the covers are looked from.
std::vector<std::byte> saved_cut(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                 const CutSurface& cut, std::size_t covers);

struct RestoredCut {
  CutSurface cut;
  std::size_t covers;
  std::size_t new_triangles;  // that the surface of the bytes lacked
};
// Throws InputError, with what is wrong and how to mend it, for bytes that are damaged, of another version,
// or of another surface: less than half of the triangles were there, at the same places of the reference
// pose, bit for bit.
RestoredCut restored_cut(const TriangleMesh& mesh, std::span<const Vec3> reference,
                         std::span<const std::byte> bytes);

}  // namespace cscd::fast
