#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "core/elementary/question/elementary_test.h"

namespace cscd {

// A feature pair is a vertex and a triangle that does not contain it, or two edges that share no vertex.
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

// Asks an elementary test about one feature pair of a moving mesh and returns its answer.
Answer ask(const ElementaryTest& test, const TriangleMesh& mesh, const Motion& motion,
           const FeaturePair& pair);
// Asks when the pair first comes within a distance.
Answer ask_close(const ElementaryTest& test, const TriangleMesh& mesh, const Motion& motion,
                 const FeaturePair& pair, double distance);

// A feature pair that touches, with the earliest time at which it does, or one whose test could not tell
// (`undecided`).
struct Contact {
  FeaturePair pair;
  Verdict verdict;  // contact or undecided
  // The earliest contact time, in [0, 1]; for `undecided`, a lower bound of it.
  double time;
};

// The contacts of one interval. Detectors append them in any order; `sort` makes the order canonical.
struct ContactSet {
  std::vector<Contact> contacts;

  void clear() { contacts.clear(); }
  void sort();  // by time, then by feature pair
};

// Keeps the contacts of the earliest time, and everything that is undecided.
void keep_first(ContactSet& sorted);

// Returns the 64-bit FNV-1a hash of a sorted set (pairs, verdicts and the bits of the times), as 16 hex
// digits.
std::string digest(const ContactSet& sorted);

}  // namespace cscd
