#include "core/detect/start/embedding.h"

#include <algorithm>

#include "core/detect/plain_culler.h"
#include "core/elementary/exact/static_contact.h"
#include "core/mesh/adjacency.h"

namespace cscd {
namespace {

struct Frame {
  const TriangleMesh& mesh;
  std::span<const Vec3> x;

  bool touch(VertexId vertex, const Triangle& t) const {
    return vertex_touches_triangle(x[+vertex], x[+t[0]], x[+t[1]], x[+t[2]]);
  }
  bool touch(const Edge& e, const Triangle& t) const {
    return segment_touches_triangle(x[+e[0]], x[+e[1]], x[+t[0]], x[+t[1]], x[+t[2]]);
  }
  bool touch(const Edge& e, const Edge& f) const {
    return segments_touch(x[+e[0]], x[+e[1]], x[+f[0]], x[+f[1]]);
  }

  // Returns whether a feature of the first triangle meets the second triangle outside the vertices
  // and edges that both share. An edge without a vertex of the second triangle is tested as a
  // whole, which covers its two ends.
  bool reaches(TriangleId from, TriangleId to) const {
    const Triangle& target = mesh.corners(to);
    for (const VertexId vertex : mesh.corners(from))
      if (!contains(target, vertex) && touch(vertex, target)) return true;
    for (const EdgeId id : mesh.edges_of(from)) {
      const Edge& edge = mesh.ends(id);
      const int shared = contains(target, edge[0]) + contains(target, edge[1]);
      if (shared == 0 && touch(edge, target)) return true;
      if (shared != 1) continue;
      // One end of the edge is shared. If the edge lies in the plane of the target, it can still cross
      // the side opposite to that end.
      for (const EdgeId side : mesh.edges_of(to)) {
        const Edge& other = mesh.ends(side);
        if (!share_vertex(edge, other) && touch(edge, other)) return true;
      }
    }
    return false;
  }
};

// Tests every pair of triangles that a culler passes on, until found() returns false.
class ExactTester : public TrianglePairSink {
 public:
  ExactTester(const TriangleMesh& mesh, std::span<const Vec3> positions,
              const std::function<bool(const CrossingPair&)>& found)
      : TrianglePairSink(kBlock), mesh_(mesh), positions_(positions), found_(found) {}

 private:
  static constexpr std::size_t kBlock = 64;  // a closed sink is noticed after so many pairs

  void take(const std::vector<TrianglePair>& block) override {
    for (const TrianglePair& pair : block) {
      const CrossingPair crossing(std::min(pair.a, pair.b), std::max(pair.a, pair.b));
      if (!closed() && triangles_meet(mesh_, positions_, crossing) && !found_(crossing)) close();
    }
  }

  const TriangleMesh& mesh_;
  std::span<const Vec3> positions_;
  const std::function<bool(const CrossingPair&)>& found_;
};

}  // namespace

bool triangles_meet(const TriangleMesh& mesh, std::span<const Vec3> positions, const CrossingPair& pair) {
  const Frame frame{mesh, positions};
  return frame.reaches(pair.first, pair.second) || frame.reaches(pair.second, pair.first);
}

EmbeddingTest::EmbeddingTest(const TriangleMesh& mesh, std::span<const Vec3> reference)
    : EmbeddingTest(mesh, std::make_unique<PlainCuller<Kdop16>>(mesh, reference)) {}

EmbeddingTest::EmbeddingTest(const TriangleMesh& mesh, std::unique_ptr<Culler> culler)
    : mesh_(&mesh), culler_(std::move(culler)) {}

void EmbeddingTest::search(std::span<const Vec3> positions,
                           const std::function<bool(const CrossingPair&)>& found) {
  const Motion at_rest(positions, positions);
  ExactTester tester(*mesh_, positions, found);
  culler_->refit(at_rest);
  culler_->classify(at_rest, nullptr);
  culler_->cull(tester);
  tester.flush();
  pairs_tested_ = tester.count();
}

std::optional<CrossingPair> EmbeddingTest::find_intersection(std::span<const Vec3> positions) {
  std::optional<CrossingPair> first;
  search(positions, [&](const CrossingPair& pair) {
    first = pair;
    return false;
  });
  return first;
}

Crossings EmbeddingTest::find_all(std::span<const Vec3> positions, std::size_t most) {
  Crossings all;
  search(positions, [&](const CrossingPair& pair) {
    if (all.total++ < most) all.pairs.push_back(pair);
    return true;
  });
  std::sort(all.pairs.begin(), all.pairs.end());
  return all;
}

}  // namespace cscd
