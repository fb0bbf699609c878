#include "core/detect/contact.h"

#include <algorithm>
#include <bit>
#include <span>
#include <tuple>

#include "core/base/digest.h"

namespace cscd {

Answer ask(const ElementaryTest& test, const TriangleMesh& mesh, const Motion& motion,
           const FeaturePair& pair) {
  if (pair.kind == FeaturePair::Kind::vertex_face)
    return test.vertex_face(vertex_face(mesh, motion, VertexId{pair.a}, TriangleId{pair.b}));
  return test.edge_edge(edge_edge(mesh, motion, EdgeId{pair.a}, EdgeId{pair.b}));
}

Answer ask_close(const ElementaryTest& test, const TriangleMesh& mesh, const Motion& motion,
                 const FeaturePair& pair, double distance) {
  if (pair.kind == FeaturePair::Kind::vertex_face)
    return test.answer_close(vertex_face(mesh, motion, VertexId{pair.a}, TriangleId{pair.b}), distance);
  return test.answer_close(edge_edge(mesh, motion, EdgeId{pair.a}, EdgeId{pair.b}), distance);
}

void ContactSet::sort() {
  std::sort(contacts.begin(), contacts.end(), [](const Contact& x, const Contact& y) {
    return std::tie(x.time, x.pair) < std::tie(y.time, y.pair);
  });
}

void keep_first(ContactSet& sorted) {
  const auto first = std::find_if(sorted.contacts.begin(), sorted.contacts.end(),
                                  [](const Contact& c) { return c.verdict == Verdict::contact; });
  if (first == sorted.contacts.end()) return;
  const double time = first->time;
  std::erase_if(sorted.contacts,
                [&](const Contact& c) { return c.verdict == Verdict::contact && c.time > time; });
}

std::string digest(const ContactSet& sorted) {
  std::uint64_t hash = kDigestOfNothing;
  const auto mix = [&](std::uint64_t word) { hash = digest_of(std::as_bytes(std::span(&word, 1)), hash); };
  for (const Contact& contact : sorted.contacts) {
    mix(static_cast<std::uint64_t>(contact.pair.kind));
    mix(static_cast<std::uint64_t>(contact.pair.a));
    mix(static_cast<std::uint64_t>(contact.pair.b));
    mix(static_cast<std::uint64_t>(contact.verdict));
    mix(std::bit_cast<std::uint64_t>(contact.time));
  }
  return hex_text(hash);
}

}  // namespace cscd
