#include "core/elementary/catalogue.h"

#include <array>

#include "core/elementary/certified/filtered_exact.h"
#include "core/elementary/exact/closeness.h"
#include "core/elementary/exact/exact.h"
#include "core/elementary/published.h"
#include "core/elementary/question/filter.h"
#include "core/elementary/question/relative_box.h"

namespace cscd {
namespace {

// The oracle behind two certified filters. The filters' "apart" is a proof, so every answer is the
// oracle's.
template <class Query>
Answer filtered_oracle(const Query& query) {
  if (never_coplanar(query) || relative_boxes_apart(query)) return {Verdict::apart, 0};
  const auto time = exact::first_contact(query);
  return time ? Answer{Verdict::contact, time->lo} : Answer{Verdict::apart, 0};
}

template <class Query>
Answer filtered_close_oracle(const Query& query, double r) {
  if (relative_boxes_apart(query, r)) return {Verdict::apart, 0};
  const auto time = exact::first_closeness(query, r);
  return time ? Answer{Verdict::contact, time->lo} : Answer{Verdict::apart, 0};
}

template <class Query>
void all_of_filtered_exact(std::span<const Query> queries, const TestParameters&, std::span<Answer> answers) {
  filtered_exact(queries, answers);
}

template <class Query>
void all_of_filtered_exact_close(std::span<const Query> queries, std::span<const double> distances,
                                 const TestParameters&, std::span<Answer> answers) {
  filtered_exact_close(queries, distances, answers);
}

constexpr std::array kTests = {
    ElementaryTest{
        .name = "newton",
        .source = "non-penetration filter (Tang et al. 2010) and interval Newton, double precision",
        .apart_is_proof = false,
        .contact_is_proof = false,
        .ask_vertex_faces = one_by_one<newton_vertex_face>,
        .ask_edge_edges = one_by_one<newton_edge_edge>,
    },
    ElementaryTest{
        .name = "newton_float",
        .source = "the same in single precision, coordinates rounded to floats",
        .apart_is_proof = false,
        .contact_is_proof = false,
        .ask_vertex_faces = one_by_one<newton_float_vertex_face>,
        .ask_edge_edges = one_by_one<newton_float_edge_edge>,
    },
    ElementaryTest{
        .name = "filtered_exact",
        .source = "ours: certified signs in double precision, then in integers of fixed capacity",
        .apart_is_proof = true,
        .contact_is_proof = true,
        .ask_vertex_faces = all_of_filtered_exact,
        .ask_edge_edges = all_of_filtered_exact,
        .single_precision_first = true,
        .close_vertex_faces = all_of_filtered_exact_close,
        .close_edge_edges = all_of_filtered_exact_close,
    },
    ElementaryTest{
        .name = "exact",
        .source = "the oracle: exact arithmetic behind certified filters",
        .apart_is_proof = true,
        .contact_is_proof = true,
        .ask_vertex_faces = one_by_one<filtered_oracle<MovingVertexFace>>,
        .ask_edge_edges = one_by_one<filtered_oracle<MovingEdgeEdge>>,
        .close_vertex_faces = close_one_by_one<filtered_close_oracle<MovingVertexFace>>,
        .close_edge_edges = close_one_by_one<filtered_close_oracle<MovingEdgeEdge>>,
    },
    ElementaryTest{
        .name = "cubic",
        .source = "closed root finding on the coplanarity cubic, distance at the roots (Bridson et al. 2002)",
        .apart_is_proof = false,
        .contact_is_proof = false,
        .ask_vertex_faces = one_by_one<cubic_vertex_face>,
        .ask_edge_edges = one_by_one<cubic_edge_edge>,
        .parameters = {.tolerance = 1e-6},
        .tolerance = "distance that counts as touching, in extents of the query",
    },
    ElementaryTest{
        .name = "inclusion",
        .source =
            "inclusion-based root finding over (t, u, v) with an error bound (Snyder 1992, Wang et al. 2021)",
        .apart_is_proof = true,
        .contact_is_proof = false,
        .ask_vertex_faces = one_by_one<inclusion_vertex_face>,
        .ask_edge_edges = one_by_one<inclusion_edge_edge>,
        .parameters = {.tolerance = 1e-6, .steps = 20'000},
        .tolerance = "distance that counts as touching, along each axis, in extents of the query",
        .close_vertex_faces = close_one_by_one<inclusion_vertex_face_close>,
        .close_edge_edges = close_one_by_one<inclusion_edge_edge_close>,
    },
    ElementaryTest{
        .name = "additive",
        .source = "conservative advancement by distance over relative displacement (Li et al. 2021)",
        .apart_is_proof = false,
        .contact_is_proof = false,
        .ask_vertex_faces = one_by_one<additive_vertex_face>,
        .ask_edge_edges = one_by_one<additive_edge_edge>,
        .parameters = {.tolerance = 0.1, .steps = 10'000},
        .tolerance = "share of the starting distance that counts as touching",
        .close_vertex_faces = close_one_by_one<additive_vertex_face_close>,
        .close_edge_edges = close_one_by_one<additive_edge_edge_close>,
    },
};

}  // namespace

std::span<const ElementaryTest> elementary_tests() {
  return kTests;
}

const ElementaryTest* find_elementary_test(std::string_view name) {
  for (const ElementaryTest& test : kTests)
    if (test.name == name) return &test;
  return nullptr;
}

}  // namespace cscd
