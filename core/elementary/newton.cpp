#include "core/elementary/newton_search.h"
#include "core/elementary/published.h"
#include "core/elementary/question/query_scale.h"

namespace cscd {
namespace {

// If the error bound says nothing about the query, the query is scaled to the size of 1 and tried again. If
// its scales are too far apart for that too, only the relative boxes decide.
template <class Query>
Answer newton(const Query& query) {
  using Search = NewtonSearch<DoubleNumbers>;
  if (const auto answer = Search::answer(query)) return *answer;
  if (const auto answer = Search::answer(scaled_to_unit(query))) return *answer;
  return {relative_boxes_apart(query) ? Verdict::apart : Verdict::undecided, 0};
}

FloatPoint rounded(const MovingPoint& p) {
  return {p.start.cast<float>(), p.end.cast<float>()};
}
FloatVertexFace rounded(const MovingVertexFace& q) {
  return {rounded(q.vertex), {rounded(q.corner[0]), rounded(q.corner[1]), rounded(q.corner[2])}};
}
FloatEdgeEdge rounded(const MovingEdgeEdge& q) {
  return {{rounded(q.first[0]), rounded(q.first[1])}, {rounded(q.second[0]), rounded(q.second[1])}};
}

template <class Query>
Answer newton_in_floats(const Query& query) {
  using Search = NewtonSearch<FloatNumbers>;
  if (const auto answer = Search::answer(rounded(query))) return *answer;
  const auto scaled = rounded(scaled_to_unit(query));
  if (const auto answer = Search::answer(scaled)) return *answer;
  return {relative_boxes_apart(query) ? Verdict::apart : Verdict::undecided, 0};
}

}  // namespace

Answer newton_vertex_face(const MovingVertexFace& query) {
  return newton(query);
}
Answer newton_edge_edge(const MovingEdgeEdge& query) {
  return newton(query);
}
Answer newton_float_vertex_face(const MovingVertexFace& query) {
  return newton_in_floats(query);
}
Answer newton_float_edge_edge(const MovingEdgeEdge& query) {
  return newton_in_floats(query);
}

}  // namespace cscd
