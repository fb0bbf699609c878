#include "core/fast/joints_of_parts.h"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "core/fast/clusters/seams.h"

namespace cscd::fast {
namespace {

Vec3 middle_of(const TriangleMesh& mesh, std::span<const Vec3> reference, TriangleId t) {
  const Triangle& c = mesh.corners(t);
  return (reference[+c[0]] + reference[+c[1]] + reference[+c[2]]) / 3;
}

struct Seam {
  std::size_t edges = 0;
  Vec3 sum = Vec3::Zero();  // of the middles of the triangles on both sides
};

}  // namespace

Rig joints_of_parts(const TriangleMesh& mesh, std::span<const Vec3> reference,
                    std::span<const std::int32_t> part_of) {
  const std::size_t parts = static_cast<std::size_t>(*std::ranges::max_element(part_of)) + 1;
  Rig rig{std::vector<BoneId>(parts, BoneId{-1}), std::vector<Bone>(parts)};
  std::vector<std::size_t> triangles(parts);
  std::vector<Vec3> sum(parts, Vec3::Zero());
  for (std::size_t t = 0; t < part_of.size(); ++t) {
    const auto part = static_cast<std::size_t>(part_of[t]);
    ++triangles[part];
    sum[part] += middle_of(mesh, reference, TriangleId{static_cast<std::int32_t>(t)});
  }
  for (std::size_t p = 0; p < parts; ++p) rig.reference[p].tail = sum[p] / static_cast<double>(triangles[p]);

  std::vector<std::map<std::size_t, Seam>> seams(parts);
  for_each_seam_edge(mesh, part_of, [&](TriangleId left, TriangleId right) {
    const auto a = static_cast<std::size_t>(part_of[+left]), b = static_cast<std::size_t>(part_of[+right]);
    const Vec3 both = middle_of(mesh, reference, left) + middle_of(mesh, reference, right);
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
      ++seams[from][to].edges;
      seams[from][to].sum += both;
    }
  });

  std::vector<std::size_t> largest_first(parts);
  for (std::size_t p = 0; p < parts; ++p) largest_first[p] = p;
  std::ranges::stable_sort(largest_first, std::greater{}, [&](std::size_t p) { return triangles[p]; });
  std::vector<bool> placed(parts);
  std::vector<std::size_t> reached;  // the parts of one connected component that have been placed
  for (const std::size_t root : largest_first) {
    if (placed[root]) continue;
    placed[root] = true;
    rig.reference[root].head = rig.reference[root].tail;
    reached = {root};
    while (true) {
      std::size_t parent = 0, child = parts;
      const Seam* longest = nullptr;
      for (const std::size_t p : reached)
        for (const auto& [to, seam] : seams[p])
          if (!placed[to] && (longest == nullptr || seam.edges > longest->edges)) {
            parent = p;
            child = to;
            longest = &seam;
          }
      if (longest == nullptr) break;
      placed[child] = true;
      rig.parent[child] = BoneId{static_cast<std::int32_t>(parent)};
      rig.reference[child].head = longest->sum / (2 * static_cast<double>(longest->edges));
      reached.push_back(child);
    }
  }
  return rig;
}

}  // namespace cscd::fast
