// Lays out FCL's classes as the library does; see fcl.cpp.
#define EIGEN_MAX_ALIGN_BYTES 16
#include "baselines/fcl/fcl_elementary.h"

#include <fcl/narrowphase/detail/traversal/collision/intersect.h>

#include "core/elementary/question/query_scale.h"

// FCL 0.7 of Debian, called as its continuous traversal calls it. Idea: find roots of the coplanarity cubic
// by interval Newton, then test the features at the root with absolute tolerances. The answer "apart" proves
// nothing: the cubic has no error bound, and a cubic whose coefficients are all zero is given up.
namespace cscd {
namespace {

using Kernel = fcl::detail::Intersect<double>;

Answer answer(bool touch, double time) {
  return touch ? Answer{Verdict::contact, time} : Answer{Verdict::apart, 0};
}
template <class Query>
bool too_far(const Query& q) {
  return largest_coordinates(q).maxCoeff() > kFclFarthest;
}
Answer fcl_vertex_face(const MovingVertexFace& q) {
  if (too_far(q)) return {Verdict::undecided, 0};
  double time = 0;
  Vec3 where;
  const bool touch =
      Kernel::intersect_VF(q.corner[0].start, q.corner[1].start, q.corner[2].start, q.vertex.start,
                           q.corner[0].end, q.corner[1].end, q.corner[2].end, q.vertex.end, &time, &where);
  return answer(touch, time);
}
Answer fcl_edge_edge(const MovingEdgeEdge& q) {
  if (too_far(q)) return {Verdict::undecided, 0};
  double time = 0;
  Vec3 where;
  const bool touch =
      Kernel::intersect_EE(q.first[0].start, q.first[1].start, q.second[0].start, q.second[1].start,
                           q.first[0].end, q.first[1].end, q.second[0].end, q.second[1].end, &time, &where);
  return answer(touch, time);
}

}  // namespace

ElementaryTest fcl_elementary_test() {
  return {"fcl",
          "FCL 0.7's own vertex-face and edge-edge tests (Pan et al. 2012)",
          false,
          false,
          one_by_one<fcl_vertex_face>,
          one_by_one<fcl_edge_edge>};
}

}  // namespace cscd
