#pragma once

// For tests only: the pairs of triangles that touch, by the exact oracle.

#include <Eigen/Geometry>
#include <utility>
#include <vector>

#include "core/detect/carried_pairs.h"
#include "core/elementary/catalogue.h"
#include "core/mesh/adjacency.h"

namespace cscd::test {

// Returns all pairs of triangles that carry a feature pair in contact.
inline std::vector<std::pair<TriangleId, TriangleId>> touching(const TriangleMesh& mesh,
                                                               const Motion& motion) {
  const ElementaryTest& exact = *find_elementary_test("exact");
  std::vector<Eigen::AlignedBox3d> box(mesh.triangle_count());
  for (std::size_t t = 0; t < box.size(); ++t)
    for (const VertexId v : mesh.triangles()[t]) box[t].extend(motion.start()[+v]).extend(motion.end()[+v]);
  std::vector<std::pair<TriangleId, TriangleId>> pairs;
  for (std::size_t t = 0; t < box.size(); ++t)
    for (std::size_t u = t + 1; u < box.size(); ++u) {
      if (!box[t].intersects(box[u])) continue;
      const TrianglePair pair{TriangleId{static_cast<std::int32_t>(t)},
                              TriangleId{static_cast<std::int32_t>(u)}};
      bool contact = false;
      for_each_carried(mesh, pair, [&](const FeaturePair& features) {
        contact = contact || ask(exact, mesh, motion, features).verdict != Verdict::apart;
      });
      if (contact) pairs.emplace_back(pair.a, pair.b);
    }
  return pairs;
}

}  // namespace cscd::test
