// Exact answers at the price of floating-point answers.
//
// There are four stages. Each stage passes the queries that it cannot prove on to the next:
//   filter    proves that the four points are coplanar at no time, or that the relative boxes are apart
//             (the row `exact` of the catalogue has the same filter);
//   doubles   uses certain signs in double precision (doubles_stage.h), and pairs of doubles for the time
//             of a contact (contact_time.h);
//   integers  uses exact integers of fixed capacity (integer_contact.h);
//   referee   answers queries that the integer stage gives up on (exact.h).
// Only the last stage allocates.
#include "core/elementary/certified/filtered_exact.h"

#include <algorithm>
#include <cmath>

#include "core/elementary/certified/contact_time.h"
#include "core/elementary/certified/doubles_stage.h"
#include "core/elementary/certified/exact_lanes.h"
#include "core/elementary/certified/integer_contact.h"
#include "core/elementary/exact/exact.h"
#include "core/elementary/question/query_scale.h"
#include "core/elementary/question/relative_box.h"

namespace cscd {
namespace {

struct Decision {
  Answer answer;
  ExactStage stage;
};
constexpr Answer kApart{Verdict::apart, 0};

template <class Query>
Decision by_referee(const Query& query) {
  const auto time = exact::first_contact(query);
  return {time ? Answer{Verdict::contact, time->lo} : kApart, ExactStage::referee};
}

template <class Query>
Decision by_integers(const Query& query) {
  const integer::Result result = integer::first_contact(query);
  if (result.outcome == integer::Outcome::gave_up) return by_referee(query);
  const bool touch = result.outcome == integer::Outcome::contact;
  return {touch ? Answer{Verdict::contact, result.time} : kApart, ExactStage::integers};
}

template <class Query>
Decision time_by_integers(const Query& query, const DoublesResult& contact) {
  const integer::Result result = integer::contact_time(query, contact.low, contact.high);
  if (result.outcome == integer::Outcome::gave_up) return by_referee(query);
  return {{Verdict::contact, result.time}, ExactStage::integers};
}

// Decides a query whose products of coordinates may underflow or overflow: scales the query's axes to the
// size of 1 first.
template <class Query>
Decision decide_beyond_range(const Query& query) {
  const Query scaled = axes_scaled_to_unit(query);
  const Triple v = triple(triple_points(scaled));
  const BernsteinCubic f = triple_product(v.p, v.q, v.r);
  if (certain_sign(f) != 0) return {kApart, ExactStage::filter};
  if (!std::isfinite(f.error)) return by_integers(query);
  const DoublesResult found = decide_in_doubles<Query>(v, f);
  if (found.kind == DoublesResult::apart) return {kApart, ExactStage::doubles};
  return found.kind == DoublesResult::contact ? time_by_integers(query, found) : by_integers(query);
}

template <class Query>
Decision decide(const Query& query) {
  const TriplePoints<MovingPoint> points = triple_points(query);
  const Triple v = triple(points);
  const BernsteinCubic f = triple_product(v.p, v.q, v.r);
  if (certain_sign(f) != 0 || relative_boxes_apart(query)) return {kApart, ExactStage::filter};
  if (!std::isfinite(f.error)) return decide_beyond_range(query);
  const DoublesResult found = decide_in_doubles<Query>(v, f);
  if (found.kind == DoublesResult::apart) return {kApart, ExactStage::doubles};
  if (found.kind == DoublesResult::unclear) return by_integers(query);
  const CertainTime<double> certain =
      time_in_pairs(points, v.sizes(), Cubic(f, ProvenBounds::cubic), found.low, found.high);
  if (!certain.known) return time_by_integers(query, found);
  return {{Verdict::contact, certain.time}, ExactStage::doubles};
}

constexpr std::size_t kWorthLanes = 2;  // the fewest queries for which lanes are faster than scalar code

template <class Query>
void decide_all(std::span<const Query> queries, std::span<Answer> answers) {
  for (std::size_t first = 0; first < queries.size(); first += kLanes) {
    const std::span<const Query> block = queries.subspan(first, std::min(kLanes, queries.size() - first));
    const LaneAnswers found = block.size() < kWorthLanes ? LaneAnswers{} : decide_in_lanes(block);
    for (std::size_t l = 0; l < block.size(); ++l)
      answers[first + l] = (found.decided >> l & 1) != 0 ? found.answer[l] : decide(block[l]).answer;
  }
}

}  // namespace

Answer filtered_exact_vertex_face(const MovingVertexFace& query) {
  return decide(query).answer;
}
Answer filtered_exact_edge_edge(const MovingEdgeEdge& query) {
  return decide(query).answer;
}
void filtered_exact(std::span<const MovingVertexFace> queries, std::span<Answer> answers) {
  decide_all(queries, answers);
}
void filtered_exact(std::span<const MovingEdgeEdge> queries, std::span<Answer> answers) {
  decide_all(queries, answers);
}
ExactStage filtered_exact_stage(const MovingVertexFace& query) {
  return decide(query).stage;
}
ExactStage filtered_exact_stage(const MovingEdgeEdge& query) {
  return decide(query).stage;
}

}  // namespace cscd
