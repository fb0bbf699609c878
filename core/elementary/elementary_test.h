#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "core/geometry/feature_motion.h"

namespace cscd {

// `undecided` is kept, counted and reported; it never means "apart".
enum class Verdict { apart, contact, undecided };

// `time` is the earliest contact time (a lower bound of it for `undecided`); meaningless for `apart`.
struct Answer {
  Verdict verdict;
  double time;
};

// What the caller of a row may choose; each row that takes any says what they mean. Negative: takes none.
struct TestParameters {
  double tolerance = -1;
  std::int64_t steps = -1;  // after so many it is undecided
};

// One row of the catalogue of elementary tests.
struct ElementaryTest {
  std::string_view name;
  std::string_view source;
  bool apart_is_proof;    // "apart" is never wrong
  bool contact_is_proof;  // "contact" is never wrong
  Answer (*ask_vertex_face)(const MovingVertexFace&, const TestParameters&);
  Answer (*ask_edge_edge)(const MovingEdgeEdge&, const TestParameters&);
  TestParameters parameters = {};
  std::string_view tolerance = "";  // what the tolerance is

  Answer vertex_face(const MovingVertexFace& query) const { return ask_vertex_face(query, parameters); }
  Answer edge_edge(const MovingEdgeEdge& query) const { return ask_edge_edge(query, parameters); }
};

// For rows that take no parameters: plain<MovingEdgeEdge, newton_edge_edge>.
template <class Query, Answer (*test)(const Query&)>
Answer plain(const Query& query, const TestParameters&) {
  return test(query);
}

std::span<const ElementaryTest> elementary_tests();
const ElementaryTest* find_elementary_test(std::string_view name);  // null when there is none

}  // namespace cscd
