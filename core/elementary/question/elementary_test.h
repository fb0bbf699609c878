#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

#include "core/geometry/feature_motion.h"

namespace cscd {

// An elementary test decides a query: two features in motion, and the question whether they touch at some t
// in [0, 1]. `undecided` means that the test ended without an answer. It is stored, counted and reported, and
// it never means "apart".
enum class Verdict { apart, contact, undecided };

// `time` is in [0, 1]. For `contact` it is the earliest contact time, as precise as the test gives it; for
// `undecided` it is a lower bound of that time; for `apart` it has no meaning.
struct Answer {
  Verdict verdict;
  double time;
};

// The parameters of a test that its caller may choose. A test that has parameters documents their meaning. A
// negative value marks a parameter that the test does not have.
struct TestParameters {
  double tolerance = -1;
  std::int64_t steps = -1;  // after this many steps the answer is `undecided`
};

// A function that answers queries in order. It takes [queries] queries and writes [queries] answers.
template <class Query>
using AskAll = void (*)(std::span<const Query>, const TestParameters&, std::span<Answer>);

// One row of the catalogue of elementary tests.
struct ElementaryTest {
  std::string_view name;
  std::string_view source;  // the method and its paper
  bool apart_is_proof;      // "apart" is never wrong
  bool contact_is_proof;    // "contact" is never wrong
  AskAll<MovingVertexFace> ask_vertex_faces;
  AskAll<MovingEdgeEdge> ask_edge_edges;
  TestParameters parameters = {};
  std::string_view tolerance = "";  // the meaning of the tolerance, in words
  // True if the filter in front of this test (core/detect/filter_block.h) may run in single precision where
  // that certainly gives the same answer. It is false for published tests, whose filter is in double
  // precision (rule fair-comparison, core/soundness.md).
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

// Makes a function of type AskAll from one that answers a single query, with or without parameters, as in
// one_by_one<newton_edge_edge>. It is a function and not a lambda, because clang 14 confuses lambdas inside
// templates of several files with each other.
template <auto test, class Query>
void one_by_one(std::span<const Query> queries, const TestParameters& parameters, std::span<Answer> answers) {
  for (std::size_t i = 0; i < queries.size(); ++i)
    if constexpr (std::is_invocable_v<decltype(test), const Query&>)
      answers[i] = test(queries[i]);
    else
      answers[i] = test(queries[i], parameters);
}

}  // namespace cscd
