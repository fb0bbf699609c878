#pragma once

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

// One row of the catalogue of elementary tests.
struct ElementaryTest {
  std::string_view name;
  std::string_view source;
  bool apart_is_proof;    // "apart" is never wrong
  bool contact_is_proof;  // "contact" is never wrong
  Answer (*vertex_face)(const MovingVertexFace&);
  Answer (*edge_edge)(const MovingEdgeEdge&);
};

std::span<const ElementaryTest> elementary_tests();
const ElementaryTest* find_elementary_test(std::string_view name);  // null when there is none

}  // namespace cscd
