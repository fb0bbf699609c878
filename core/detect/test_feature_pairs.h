#pragma once

// For tests only: all feature pairs of a mesh, and its contacts, found by asking about each pair.

#include <vector>

#include "core/detect/contact.h"
#include "core/mesh/adjacency.h"

namespace cscd::test {

// Returns every vertex with every triangle that does not contain it, and every two edges that share no
// vertex, in ascending order. A vertex of no triangle is a feature too.
inline std::vector<FeaturePair> all_feature_pairs(const TriangleMesh& mesh) {
  std::vector<FeaturePair> pairs;
  const auto ids = [](std::size_t count) { return static_cast<std::int32_t>(count); };
  for (std::int32_t v = 0; v < ids(mesh.vertex_count()); ++v)
    for (std::int32_t t = 0; t < ids(mesh.triangle_count()); ++t)
      if (!contains(mesh.corners(TriangleId{t}), VertexId{v}))
        pairs.push_back(FeaturePair::of(VertexId{v}, TriangleId{t}));
  for (std::int32_t e = 0; e < ids(mesh.edge_count()); ++e)
    for (std::int32_t f = e + 1; f < ids(mesh.edge_count()); ++f)
      if (!share_vertex(mesh.ends(EdgeId{e}), mesh.ends(EdgeId{f})))
        pairs.push_back(FeaturePair::of(EdgeId{e}, EdgeId{f}));
  return pairs;
}

// Returns the contacts among all feature pairs, in the order of the pairs.
inline ContactSet contacts_by_asking(const TriangleMesh& mesh, const Motion& motion,
                                     const ElementaryTest& test) {
  ContactSet found;
  for (const FeaturePair& pair : all_feature_pairs(mesh)) {
    const Answer answer = ask(test, mesh, motion, pair);
    if (answer.verdict != Verdict::apart) found.contacts.push_back({pair, answer.verdict, answer.time});
  }
  return found;
}

}  // namespace cscd::test
