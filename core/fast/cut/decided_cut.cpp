#include "core/fast/cut/decided_cut.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/fast/cut/patch_cutter.h"

namespace cscd::fast {
namespace {

void check_cover(const TriangleMesh& mesh, const Cover& cover) {
  for (const FollowingPoint& observer : cover.observers)
    for (const VertexId v : observer.vertices())
      if (static_cast<std::int32_t>(v) < 0 || +v >= mesh.vertex_count())
        refuse_preparation("has an observer at a vertex that the mesh lacks");
  std::vector<std::int32_t> component(cover.observers.size(), kNone);
  for (std::size_t t = 0; t < cover.cluster_of.size(); ++t) {
    if (cover.cluster_of[t] == kNone) continue;
    std::int32_t& own = component[static_cast<std::size_t>(cover.cluster_of[t])];
    const std::int32_t here = mesh.component(TriangleId{static_cast<std::int32_t>(t)});
    if (own != kNone && own != here) refuse_preparation("has a cluster in two components");
    own = here;
  }
  if (std::ranges::find(component, kNone) != component.end()) refuse_preparation("has an empty cluster");
}

void check_patches(const TriangleMesh& mesh, const DecidedCut& decided) {
  std::vector<bool> met(mesh.triangle_count(), false);
  std::size_t triangles = 0;
  for (const std::vector<TriangleId>& patch : decided.patches.triangles) {
    for (const TriangleId t : patch) {
      if (static_cast<std::int32_t>(t) < 0 || +t >= met.size() || met[+t])
        refuse_preparation("has a triangle in two patches");
      met[+t] = true;
      ++triangles;
      for (const Cover& cover : decided.covers)
        if (cover.cluster_of[+t] != cover.cluster_of[+patch.front()])
          refuse_preparation("has a patch in two clusters");
    }
    if (vertices_of(mesh, patch).size() > kLanes16) refuse_preparation("has a patch of too many vertices");
  }
  if (triangles != met.size()) refuse_preparation("has a triangle in no patch");
}

}  // namespace

void refuse_preparation(const std::string& fault) {
  throw InputError("preparation: " + fault + "; prepare anew without it");
}

void check(const TriangleMesh& mesh, const DecidedCut& decided) {
  for (const Cover& cover : decided.covers) check_cover(mesh, cover);
  const std::vector<std::int32_t>& first = decided.covers[0].cluster_of;
  if (std::ranges::find(first, kNone) != first.end()) refuse_preparation("has a triangle without a cluster");
  check_patches(mesh, decided);
}

CutSurface finished(const TriangleMesh& mesh, std::span<const Vec3> reference, DecidedCut decided) {
  CutSurface cut{std::move(decided.covers), {}};
  cut.tree = make_tree(mesh, reference, decided.patches, cut.covers[0].cluster_of);
  for (std::size_t c = 0; c < kCovers; ++c) enter_cover(mesh, cut.covers[c], c, cut.tree);
  return cut;
}

}  // namespace cscd::fast
