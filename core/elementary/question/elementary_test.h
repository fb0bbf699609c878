#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "core/base/error.h"
#include "core/geometry/feature_motion.h"

namespace cscd {

// An elementary test decides a query: two features in motion, and the question whether they touch at some t
// in [0, 1]. `undecided` means that the test ended without an answer. It is stored, counted and reported, and
// it never means "apart".
//
// A test may know distances too. Two features are *close* at a distance r if the least distance of the two
// closed features is at most r at some t in [0, 1]. Asked about closeness, `contact` means close, and its
// time is the earliest such t. Closeness at r = 0 is touching.
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

// The same at a distance for each query, which is finite and above 0.
template <class Query>
using AskAllClose = void (*)(std::span<const Query>, std::span<const double> distances, const TestParameters&,
                             std::span<Answer>);

// Throws an InputError unless r is finite and not negative. Whoever takes a distance from a user asks this.
inline void require_distance(double r) {
  if (r >= 0 && std::isfinite(r)) return;
  char number[32];
  std::snprintf(number, sizeof number, "%g", r);
  throw InputError(std::string("a distance must be finite and at least 0, but is ") + number);
}

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
  // Null in a test that knows no distances.
  AskAllClose<MovingVertexFace> close_vertex_faces = nullptr;
  AskAllClose<MovingEdgeEdge> close_edge_edges = nullptr;

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
  bool knows_distance() const { return close_vertex_faces != nullptr; }
  // Tells which queries are close, each at the distance of the same number. At 0 the answer is that of
  // `answer`, bit for bit. Above 0 the test must know distances. Throws an InputError if a distance is
  // negative or not finite.
  template <class Query>
  void answer_close(std::span<const Query> queries, std::span<const double> distances,
                    std::span<Answer> answers) const;
  template <class Query>
  Answer answer_close(const Query& query, double distance) const {
    Answer one;
    answer_close(std::span(&query, 1), std::span(&distance, 1), std::span(&one, 1));
    return one;
  }
  Answer vertex_face(const MovingVertexFace& query) const { return answer(query); }
  Answer edge_edge(const MovingEdgeEdge& query) const { return answer(query); }
};

template <class Query>
void ElementaryTest::answer_close(std::span<const Query> queries, std::span<const double> distances,
                                  std::span<Answer> answers) const {
  for (const double r : distances) require_distance(r);
  // Neighbouring queries that are all at 0, or all above 0, are asked together.
  for (std::size_t from = 0, to = 0; from < queries.size(); from = to) {
    const bool touching = distances[from] == 0;
    while (to < queries.size() && (distances[to] == 0) == touching) ++to;
    const auto asked = queries.subspan(from, to - from);
    const auto answered = answers.subspan(from, to - from);
    if (touching) {
      answer(asked, answered);
      continue;
    }
    if (!knows_distance())
      throw InputError("the elementary test '" + std::string(name) + "' knows no distances");
    const auto r = distances.subspan(from, to - from);
    if constexpr (std::is_same_v<Query, MovingVertexFace>)
      close_vertex_faces(asked, r, parameters, answered);
    else
      close_edge_edges(asked, r, parameters, answered);
  }
}

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

// The same for type AskAllClose.
template <auto test, class Query>
void close_one_by_one(std::span<const Query> queries, std::span<const double> distances,
                      const TestParameters& parameters, std::span<Answer> answers) {
  for (std::size_t i = 0; i < queries.size(); ++i)
    if constexpr (std::is_invocable_v<decltype(test), const Query&, double>)
      answers[i] = test(queries[i], distances[i]);
    else
      answers[i] = test(queries[i], distances[i], parameters);
}

}  // namespace cscd
