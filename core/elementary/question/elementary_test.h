#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

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

// Answers as many queries as there are answers.
template <class Query>
using AskAll = void (*)(std::span<const Query>, const TestParameters&, std::span<Answer>);

// One row of the catalogue of elementary tests.
struct ElementaryTest {
  std::string_view name;
  std::string_view source;
  bool apart_is_proof;    // "apart" is never wrong
  bool contact_is_proof;  // "contact" is never wrong
  AskAll<MovingVertexFace> ask_vertex_faces;
  AskAll<MovingEdgeEdge> ask_edge_edges;
  TestParameters parameters = {};
  std::string_view tolerance = "";  // what the tolerance is
  // Whether what goes before it (core/detect/filter_block.h) may be told in single precision, where that says
  // the same: published tests have their filter in double precision.
  bool single_precision_first = false;

  void answer(std::span<const MovingVertexFace> queries, std::span<Answer> answers) const {
    ask_vertex_faces(queries, parameters, answers);
  }
  void answer(std::span<const MovingEdgeEdge> queries, std::span<Answer> answers) const {
    ask_edge_edges(queries, parameters, answers);
  }
  template <class Query>
  Answer answer(const Query& query) const {
    Answer one;
    answer(std::span(&query, 1), std::span(&one, 1));
    return one;
  }
  Answer vertex_face(const MovingVertexFace& query) const { return answer(query); }
  Answer edge_edge(const MovingEdgeEdge& query) const { return answer(query); }
};

// For rows that take queries one by one, without parameters or with them: one_by_one<newton_edge_edge>. (No
// lambda inside a template: clang 14 takes those of several files for one.)
template <auto test, class Query>
void one_by_one(std::span<const Query> queries, const TestParameters& parameters, std::span<Answer> answers) {
  for (std::size_t i = 0; i < queries.size(); ++i)
    if constexpr (std::is_invocable_v<decltype(test), const Query&>)
      answers[i] = test(queries[i]);
    else
      answers[i] = test(queries[i], parameters);
}

}  // namespace cscd
