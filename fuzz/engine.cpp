// The whole query of the fast engine on tiny meshes, open, torn and closed, against all pairs of features.
#include <bit>
#include <utility>
#include <vector>

#include "baselines/plain.h"
#include "core/detect/start/embedding.h"
#include "core/elementary/catalogue.h"
#include "core/fast/drvbc_fast.h"
#include "fuzz/numbers.h"

namespace cscd::fuzz {
namespace {

constexpr int kMostVertices = 16, kMostTriangles = 24;
constexpr std::size_t kMostCrossings = 10'000;

// Steps that move far are always looked at in parts, for these meshes are too small for long descents.
constexpr std::uint32_t kInParts = 0;
constexpr int kAsked = 3;  // the second and third time, clusters have been cut anew for what is asked

ContactSet sorted_contacts(Detector& detector, const Motion& motion) {
  ContactSet found;
  detector.detect({motion}, found);
  found.sort();
  return found;
}

// Triangles with a repeated corner are left out; a mesh refuses them.
std::vector<Triangle> triangles_of(Numbers& numbers, std::size_t vertices) {
  std::vector<Triangle> triangles;
  for (int left = 1 + numbers.byte() % kMostTriangles; left > 0; --left) {
    Triangle corners;
    for (VertexId& corner : corners) corner = VertexId{static_cast<std::int32_t>(numbers.byte() % vertices)};
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
      triangles.push_back(corners);
  }
  return triangles;
}

// An interval of a mesh, and the pose in which the mesh is prepared.
struct Step {
  std::vector<Triangle> triangles;
  std::vector<Vec3> reference, start, end;
};

Step any_step(Numbers& numbers) {
  const std::size_t vertices = 3 + numbers.byte() % (kMostVertices - 2);
  Step step{triangles_of(numbers, vertices), {}, {}, {}};
  const bool starts_in_reference = numbers.byte() % 2 == 0;
  for (std::vector<Vec3>* pose : {&step.reference, &step.start, &step.end})
    for (std::size_t v = 0; v < vertices; ++v) pose->push_back(numbers.point());
  if (starts_in_reference) step.start = step.reference;
  return step;
}

// A dented octahedron whose vertices go anywhere: few triangles drawn at random close a surface, and few
// poses are embedded.
Step closed_step(Numbers& numbers) {
  Step step;
  for (int face = 0; face < 8; ++face) {  // vertices 2 k and 2 k + 1 lie at both ends of axis k
    Triangle corners;
    for (int k = 0; k < 3; ++k) corners[static_cast<std::size_t>(k)] = VertexId{2 * k + (face >> k & 1)};
    if (std::popcount(static_cast<unsigned>(face)) % 2 != 0) std::swap(corners[1], corners[2]);
    step.triangles.push_back(corners);
  }
  for (int v = 0; v < 6; ++v) {
    Vec3 p = Vec3::Zero();
    p[v / 2] = v % 2 == 0 ? 200 : -200;
    for (int k = 0; k < 3; ++k) p[k] += numbers.integer();
    step.start.push_back(p);
  }
  step.reference = step.start;
  for (int v = 0; v < 6; ++v) step.end.push_back(numbers.point());
  return step;
}

}  // namespace

void target(Bytes bytes) {
  Numbers numbers(bytes);
  const auto [triangles, reference, start, end] =
      numbers.byte() % 2 == 0 ? any_step(numbers) : closed_step(numbers);
  if (triangles.empty()) return;
  const TriangleMesh mesh(triangles, start.size());
  const Motion motion(start, end);
  const StrategyInput setup{mesh, reference, nullptr, *find_elementary_test("filtered_exact")};
  const ContactSet truth = sorted_contacts(*make_brute(setup).detector, motion);

  const Prepared complete =
      make_drvbc_fast(setup, {.name = "drvbc_fast_complete", .long_descent = kInParts, .complete = true});
  for (int asked = 0; asked < kAsked; ++asked)
    if (digest(sorted_contacts(*complete.detector, motion)) != digest(truth))
      broken("drvbc_fast_complete has other contacts than all pairs");
  ContactSet again;
  Crossings crossings;
  complete.detector->detect({.motion = motion, .crossings = &crossings, .most_crossings = kMostCrossings},
                            again);
  again.sort();
  if (digest(again) != digest(truth)) broken("seeing the start changes the contacts");
  const Crossings plain = EmbeddingTest(mesh, reference).find_all(start, kMostCrossings);
  if (crossings.total != plain.total || crossings.pairs != plain.pairs)
    broken("drvbc_fast_complete sees other crossings than the plain test");

  if (!mesh.closed_and_oriented() || plain.total != 0) return;
  const Prepared fast = make_drvbc_fast(setup, {.long_descent = kInParts});
  for (int asked = 0; asked < kAsked; ++asked) {
    const ContactSet first = sorted_contacts(*fast.detector, motion);
    if (first.contacts.empty() != truth.contacts.empty()) broken("drvbc_fast loses the first contact");
    if (!truth.contacts.empty() && first.contacts[0].time != truth.contacts[0].time)
      broken("drvbc_fast is late");
  }
  const Prepared all = make_drvbc_fast(
      setup, {.name = "drvbc_fast_all", .long_descent = kInParts, .complete = true, .starts_embedded = true});
  for (int asked = 0; asked < kAsked; ++asked)
    if (digest(sorted_contacts(*all.detector, motion)) != digest(truth))
      broken("drvbc_fast_all has other contacts than all pairs");
}

}  // namespace cscd::fuzz
