#include "core/elementary/filtered_exact.h"

#include "core/elementary/exact.h"
#include "core/elementary/filter.h"
#include "core/elementary/integer_contact.h"
#include "core/elementary/relative_box.h"

namespace cscd {
namespace {

struct Decision {
  Answer answer;
  ExactStage stage;
};

template <class Query>
Decision decide(const Query& query) {
  if (never_coplanar(query)) return {{Verdict::apart, 0}, ExactStage::filter};
  if (relative_boxes_apart(query)) return {{Verdict::apart, 0}, ExactStage::filter};
  const integer::Result result = integer::first_contact(query);
  if (result.outcome == integer::Outcome::contact)
    return {{Verdict::contact, result.time}, ExactStage::integers};
  if (result.outcome == integer::Outcome::apart) return {{Verdict::apart, 0}, ExactStage::integers};
  const auto time = exact::first_contact(query);
  return {time ? Answer{Verdict::contact, time->lo} : Answer{Verdict::apart, 0}, ExactStage::referee};
}

}  // namespace

Answer filtered_exact_vertex_face(const MovingVertexFace& query) {
  return decide(query).answer;
}
Answer filtered_exact_edge_edge(const MovingEdgeEdge& query) {
  return decide(query).answer;
}
ExactStage filtered_exact_stage(const MovingVertexFace& query) {
  return decide(query).stage;
}
ExactStage filtered_exact_stage(const MovingEdgeEdge& query) {
  return decide(query).stage;
}

}  // namespace cscd
