#pragma once

#include <span>
#include <vector>

#include "core/detect/contact.h"
#include "core/detect/culler.h"
#include "core/mesh/adjacency.h"

namespace cscd {

// Calls with every feature pair that two different triangles carry, up to 15: any vertex against the other
// triangle, any edge against any edge, unless they share a vertex.
template <class Take>
void for_each_carried(const TriangleMesh& mesh, const TrianglePair& pair, bool adjacent, const Take& take) {
  const Triangle &a = mesh.corners(pair.a), &b = mesh.corners(pair.b);
  for (const VertexId vertex : a)
    if (!contains(b, vertex)) take(FeaturePair::of(vertex, pair.b));
  for (const VertexId vertex : b)
    if (!contains(a, vertex)) take(FeaturePair::of(vertex, pair.a));
  for (const EdgeId e : mesh.edges_of(pair.a))
    for (const EdgeId f : mesh.edges_of(pair.b))
      if (!adjacent || !share_vertex(mesh.ends(e), mesh.ends(f))) take(FeaturePair::of(e, f));
}

// For strategies in which not every triangle pair is tested for all that it carries. Whatever it leaves out
// must be tested for another pair that the same culler passes on, or always (trap 1).
class FeatureAssignment {
 public:
  virtual ~FeatureAssignment() = default;
  // Appends what the pairs of a block have to be tested for.
  virtual void append(std::span<const TrianglePair> block, std::vector<FeaturePair>& out) const = 0;
  // Tested in every interval.
  virtual std::span<const FeaturePair> always() const = 0;
};

}  // namespace cscd
