#include "baselines/selfccd.h"

#include <optional>

#include "core/base/sort_unique.h"
#include "core/detect/compose.h"
#include "core/detect/plain_culler.h"

// Idea: many triangle pairs carry the same feature pair (about six for a vertex and a face, four for two
// edges), and it need be tested for only one of them, its *representative*. Triangle pairs that share a
// vertex, of which a hierarchy yields hundreds of thousands, then need no test at all: the few feature pairs
// that only such triangle pairs carry, the *orphans*, are listed once and tested at every interval.
//
// Rule any-carrier is about this method. It is sound here because the bounds alone cull: the representative
// of a pair in contact are two triangles that touch, so their bounds overlap whatever other pairs are
// dropped. Under culling by orientation it would lose contacts. A "no" proves that the swept bounds are
// disjoint.
//
// Fidelity: own code after descriptions of the published code. As there, the representative is found by a
// rule instead of a table. For a vertex and a face, the rule takes the first triangle at the vertex that
// shares no vertex with the face. For two edges, it takes the first such pair of a triangle at the edge with
// the smaller index and one at the other edge. The published hierarchy has 18-DOPs in float, its filter has
// no bound of the rounding, and its cubics have a tolerance. Here, bounds, tree, filter and elementary test
// are those of all strategies. The normal cones of the published code are the strategy `mcd`.
//
// Tuning: pairs of adjacent triangles are dropped where the descent meets them, before they are stored; the
// rule looks at one triangle in most cases.
namespace cscd {
namespace {

class Representatives : public FeatureAssignment {
 public:
  explicit Representatives(const TriangleMesh& mesh) : mesh_(mesh) {
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const TriangleId id{static_cast<std::int32_t>(t)};
      for (const VertexId corner : mesh.corners(id))
        for (const TriangleId other : mesh.triangles_at(corner)) {
          if (other <= id) continue;
          for_each_carried(mesh, TrianglePair{id, other}, [&](const FeaturePair& pair) {
            if (!representative(pair)) orphans_.push_back(pair);
          });
        }
    }
    sort_unique(orphans_);
  }

  void append(std::span<const TrianglePair> block, std::vector<CarriedPairs>& out) const override {
    for (const TrianglePair& pair : block) {
      unsigned places = 0, place = 1;
      const auto ask = [&](const FeaturePair& features) {
        const std::optional<TrianglePair> chosen = representative(features);
        if (chosen &&
            ((chosen->a == pair.a && chosen->b == pair.b) || (chosen->a == pair.b && chosen->b == pair.a)))
          places |= place;
        place <<= 1;
      };
      // The two triangles have no common vertex, so they carry all fifteen feature pairs. These loops
      // are ones that compilers unroll.
      for (const VertexId v : mesh_.corners(pair.a)) ask(FeaturePair::of(v, pair.b));
      for (const VertexId v : mesh_.corners(pair.b)) ask(FeaturePair::of(v, pair.a));
      for (const EdgeId e : mesh_.edges_of(pair.a))
        for (const EdgeId f : mesh_.edges_of(pair.b)) ask(FeaturePair::of(e, f));
      if (places != 0) out.push_back({pair, static_cast<CarriedPlaces>(places)});
    }
  }
  std::span<const FeaturePair> always() const override { return orphans_; }

 private:
  bool adjacent(TriangleId a, TriangleId b) const { return share_vertex(mesh_.corners(a), mesh_.corners(b)); }

  // Returns the triangle pair for which the feature pair is tested, or nullopt for an orphan.
  std::optional<TrianglePair> representative(const FeaturePair& pair) const {
    if (pair.kind == FeaturePair::Kind::vertex_face) {
      const TriangleId face{pair.b};
      for (const TriangleId t : mesh_.triangles_at(VertexId{pair.a}))
        if (!adjacent(t, face)) return TrianglePair{t, face};
      return std::nullopt;
    }
    for (const TriangleId t : mesh_.triangles_at(EdgeId{pair.a}))
      for (const TriangleId u : mesh_.triangles_at(EdgeId{pair.b}))
        if (!adjacent(t, u)) return TrianglePair{t, u};
    return std::nullopt;
  }

  const TriangleMesh& mesh_;
  std::vector<FeaturePair> orphans_;
};

}  // namespace

std::unique_ptr<const FeatureAssignment> representative_triangles(const TriangleMesh& mesh) {
  return std::make_unique<Representatives>(mesh);
}

Prepared make_selfccd(const StrategyInput& setup) {
  PairOptions options;
  options.assignment = representative_triangles(setup.mesh);
  return {compose(std::make_unique<PlainCuller<Kdop16, false>>(setup), setup, std::move(options)), {}};
}

}  // namespace cscd
