#pragma once

#include "core/elementary/question/filter.h"
#include "core/geometry/sideways.h"

// The second part of the filter for one query, which the engine asks about eight at a time.
namespace cscd::test {

// Calls apart_sideways (sideways.h) for one query, given as three points seen from the fourth.
inline bool stay_apart_sideways(const MovingVector (&seen)[3], bool vertex_face) {
  SeenFromFirst<double> p;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) p[k][0][i] = seen[k].start[i], p[k][1][i] = seen[k].end[i];
  return apart_sideways(p, vertex_face);
}
// True proves that the features never touch.
inline bool never_meet_in_plane(const MovingVertexFace& q) {
  const MovingPoint& from = q.corner[0];
  return stay_apart_sideways(
      {difference(from, q.corner[1]), difference(from, q.corner[2]), difference(from, q.vertex)}, true);
}
inline bool never_meet_in_plane(const MovingEdgeEdge& q) {
  const MovingPoint& from = q.first[0];
  return stay_apart_sideways(
      {difference(from, q.first[1]), difference(from, q.second[0]), difference(from, q.second[1])}, false);
}

}  // namespace cscd::test
