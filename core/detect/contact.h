#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "core/elementary/question/elementary_test.h"

namespace cscd {

// A vertex of some triangle and a triangle that does not contain it, or two edges that share no vertex.
struct FeaturePair {
  enum class Kind : std::uint8_t { vertex_face, edge_edge };
  Kind kind;
  std::int32_t a;  // the vertex, or the edge with the smaller index
  std::int32_t b;  // the triangle, or the edge with the larger index

  static FeaturePair of(VertexId vertex, TriangleId triangle) {
    return {Kind::vertex_face, static_cast<std::int32_t>(vertex), static_cast<std::int32_t>(triangle)};
  }
  static FeaturePair of(EdgeId one, EdgeId other) {
    const auto i = static_cast<std::int32_t>(one), j = static_cast<std::int32_t>(other);
    return {Kind::edge_edge, i < j ? i : j, i < j ? j : i};
  }
  auto operator<=>(const FeaturePair&) const = default;
};

// Asks an elementary test about one feature pair of a mesh in motion.
Answer ask(const ElementaryTest& test, const TriangleMesh& mesh, const Motion& motion,
           const FeaturePair& pair);

// A feature pair that touches at `time` (earliest), or whose test could not tell (`undecided`).
struct Contact {
  FeaturePair pair;
  Verdict verdict;  // contact or undecided
  double time;
};

// What one interval found. Detectors append in any order; `sort` makes it canonical.
struct ContactSet {
  std::vector<Contact> contacts;

  void clear() { contacts.clear(); }
  void sort();  // by time, then feature pair
};

// Leaves the contacts of the earliest time, and what is undecided.
void keep_first(ContactSet& sorted);

// 64-bit FNV-1a over the sorted set (pairs, verdicts and the bits of the times), as 16 hex digits.
std::string digest(const ContactSet& sorted);

}  // namespace cscd
