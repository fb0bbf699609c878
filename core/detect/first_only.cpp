#include "core/detect/first_only.h"

#include <algorithm>

#include "core/elementary/filter.h"

namespace cscd {
namespace {

// The leftmost crossing of the axis by a line between a point of the hull before and one behind it, each
// moved left by the error; and by the roundings in here.
double no_root_before(const BernsteinCubic& f) {
  const double side = f.c[0] < 0 ? -1 : 1;
  double before = 2;
  for (int i = 0; i < 4; ++i) {
    const double height = side * f.c[i] - f.error;
    if (!(height > 0)) {
      if (i == 0) return 0;
      continue;
    }
    for (int j = i + 1; j < 4; ++j) {
      const double depth = f.error - side * f.c[j];
      if (depth < 0) continue;
      before = std::min(before, (i + (j - i) * (height / (height + depth))) / 3);
    }
  }
  return before * (1 - 8 * kUnitRoundoff);
}

}  // namespace

double no_contact_before(const TriangleMesh& mesh, const Motion& motion, const FeaturePair& pair) {
  return no_root_before(pair.kind == FeaturePair::Kind::vertex_face
                            ? coplanarity(vertex_face(mesh, motion, VertexId{pair.a}, TriangleId{pair.b}))
                            : coplanarity(edge_edge(mesh, motion, EdgeId{pair.a}, EdgeId{pair.b})));
}

void keep_first(ContactSet& sorted) {
  const auto first = std::find_if(sorted.contacts.begin(), sorted.contacts.end(),
                                  [](const Contact& c) { return c.verdict == Verdict::contact; });
  if (first == sorted.contacts.end()) return;
  const double time = first->time;
  std::erase_if(sorted.contacts,
                [&](const Contact& c) { return c.verdict == Verdict::contact && c.time > time; });
}

}  // namespace cscd
