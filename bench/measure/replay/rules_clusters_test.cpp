#include <gtest/gtest.h>
#include <numbers>

#include "bench/measure/strategies/verify.h"
#include "bench/testing/rule_case.h"
#include "scenes/random/surface.h"

// Rules any-carrier, three-vertices, component and fair-comparison: what a cluster may drop.
// Counter-examples: two octahedra and a fingertip against representative triangles, a finger over a segment
// observer, nested shells, a thin flap.
namespace cscd::bench {
namespace {

using namespace rules;

// Two octahedra whose silhouette edges towards a point far below collide, crosswise. The first faces at these
// edges are positive.
Case colliding_silhouettes() {
  const auto tilted = [](double degrees, const Vec3& centre) {
    Shape shape = test::octahedron();
    for (Vec3& p : shape.positions)
      p = centre + Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Vec3::UnitX()) *
                       (Eigen::AngleAxisd(std::numbers::pi / 4, Vec3::UnitZ()) * p);
    return shape;
  };
  const Shape shape = test::together(tilted(12, {-1, 0, 0}), tilted(-12, {1, 0, 0}));
  return Case(shape, shifted(shape.positions, 0, 6, {0.7, 0, 0}), kFarBelow);
}

// A fingertip, positive above and negative below, comes down on a positive face. The tip's first face is
// positive.
Case fingertip_on_face() {
  const Shape finger{
      {{0.3, 0.1, 0}, {3, 0, 1.5}, {3, 1, 0.8}, {3, -1, 0.8}},
      {test::corners(0, 1, 2), test::corners(0, 3, 1), test::corners(0, 2, 3), test::corners(1, 3, 2)}};
  const Shape shape = test::together(finger, test::box({-4, -5, -2}, {6.5, 5, -0.5}));
  return Case(shape, shifted(shape.positions, 0, 4, {0, 0, -0.7}), kFarBelow);
}

class OnePair : public Culler {
 public:
  explicit OnePair(TrianglePair pair) : pair_(pair) {}
  void refit(const Step&) override {}
  CullCounts cull(TrianglePairSink& sink) override {
    sink.add(pair_.a, pair_.b);
    return {};
  }

 private:
  TrianglePair pair_;
};

// Mutation: compose::expand meets only the features that have their triangle as the first one at them.
TEST(Rules, AnyCarrierAnyTrianglePairThatCarriesAFeaturePairHasItTested) {
  for (const Case& scene : {colliding_silhouettes(), fingertip_on_face()}) {
    const ContactSet truth = scene.ask(all_pairs());
    ASSERT_FALSE(truth.contacts.empty());
    for (const Contact& contact : truth.contacts) {
      const auto around = [&](std::int32_t id, bool edge) {
        return edge ? scene.mesh.triangles_at(EdgeId{id}) : scene.mesh.triangles_at(VertexId{id});
      };
      const bool edges = contact.pair.kind == FeaturePair::Kind::edge_edge;
      const TriangleId face{contact.pair.b};
      const std::span<const TriangleId> other =
          edges ? around(contact.pair.b, true) : std::span<const TriangleId>(&face, 1);
      for (const TriangleId a : around(contact.pair.a, edges))
        for (const TriangleId b : other) {
          const auto detector = compose(std::make_unique<OnePair>(TrianglePair{a, b}), scene.setup());
          EXPECT_TRUE(holds(scene.ask(*detector), contact.pair));
        }
    }
  }
}

// Mutation: as above.
TEST(Rules, AnyCarrierRepresentativeTrianglesLoseWhatOtherTrianglesShow) {
  for (const Case& scene : {colliding_silhouettes(), fingertip_on_face()}) {
    ASSERT_TRUE(scene.embedded());
    const ContactSet truth = scene.ask(all_pairs());
    ASSERT_FALSE(truth.contacts.empty());
    const ContactSet found = scene.in_one_cluster<Flaw::none>(ObserverKind::bone_centre);
    EXPECT_TRUE(verify(truth, found, Guarantee::first_contact, true).ok);
    EXPECT_TRUE(
        scene.in_one_cluster<Flaw::representative_triangles>(ObserverKind::bone_centre).contacts.empty());
  }
}

// Mutation: viewing_range in orientation.cpp looks at the first corner alone.
TEST(Rules, ThreeVerticesAFingerOverASegmentObserverIsFound) {
  scenes::Surface surface;
  scenes::append_hooked_finger(surface);
  const Shape shape{surface.positions, surface.triangles};
  const Case scene(shape, shifted(shape.positions, 0, 4, scenes::kFingerPoke), {{-1, 0, 0}, {1, 0, 0}});
  ASSERT_TRUE(scene.mesh.closed_and_oriented());
  ASSERT_EQ(scene.mesh.component_count(), 1);
  ASSERT_TRUE(scene.embedded());
  const ContactSet truth = scene.ask(all_pairs());
  ASSERT_EQ(truth.contacts.size(), 1u);
  EXPECT_NEAR(truth.contacts[0].time, 0.968, 1e-9);

  EXPECT_EQ(digest(scene.in_one_cluster<Flaw::none>(ObserverKind::bone_segment)), digest(truth));
  EXPECT_TRUE(scene.in_one_cluster<Flaw::segment_by_one_vertex>(ObserverKind::bone_segment).contacts.empty());
  for (const Strategy* strategy : with_guarantee())
    EXPECT_EQ(digest(scene.ask(*strategy)), digest(truth)) << strategy->name;
}

// Mutation: make_atomic_clusters keys its clusters by bone alone.
TEST(Rules, ComponentAShellThatClosesOnAnotherIsFound) {
  const Shape shape = test::together(test::octahedron(3), test::octahedron(1));
  std::vector<Vec3> end = shape.positions;
  for (std::size_t i = 0; i < 6; ++i) end[i] /= 6;
  const Case scene(shape, end, {{-0.1, 0, 0}, {0.1, 0, 0}});
  ASSERT_TRUE(scene.embedded());
  const ContactSet truth = scene.ask(all_pairs());
  ASSERT_GE(truth.contacts.size(), 64u);
  for (const Strategy* strategy : with_guarantee())
    EXPECT_EQ(digest(scene.ask(*strategy)), digest(truth)) << strategy->name;
  EXPECT_TRUE(
      scene.in_one_cluster<Flaw::clusters_span_components>(ObserverKind::bone_centre).contacts.empty());
}

// A thin flap goes through a positive face: the vertices of its underside first, reported; its upper vertex
// later, positive against positive, which the guarantee allows to be lost. Mutations: verify compares numbers
// of contacts; any contact will do for the first.
TEST(Rules, FairComparisonFewerContactsAreNoFailureWhileTheFirstIsKept) {
  const Shape flap{
      {{-0.5, -2, 1.5}, {0.5, -2, 1.5}, {0, -1, 1.5}, {0, -1.6, 1.55}},
      {test::corners(0, 2, 1), test::corners(0, 1, 3), test::corners(1, 2, 3), test::corners(2, 0, 3)}};
  const Shape shape = test::together(flap, test::box({-4, -4, -2}, {5, 9, 1}));
  const Case scene(shape, shifted(shape.positions, 0, 4, {0, 0, -0.7}), kFarBelow);
  ASSERT_TRUE(scene.embedded());
  const ContactSet truth = scene.ask(all_pairs());
  const ContactSet found = scene.in_one_cluster<Flaw::none>(ObserverKind::bone_centre);
  ASSERT_EQ(truth.contacts.size(), 4u);
  ASSERT_EQ(found.contacts.size(), 3u);
  EXPECT_NEAR(truth.contacts[0].time, 0.5 / 0.7, 1e-12);
  EXPECT_NEAR(truth.contacts[3].time, 0.55 / 0.7, 1e-12);

  EXPECT_TRUE(verify(truth, found, Guarantee::first_contact, true).ok);
  EXPECT_FALSE(verify(truth, found, Guarantee::complete, true).ok);
  ContactSet late;
  late.contacts.assign(1, truth.contacts[3]);
  EXPECT_FALSE(verify(truth, late, Guarantee::first_contact, true).ok) << "one contact, but not the first";
  EXPECT_TRUE(verify(truth, late, Guarantee::first_contact, false).ok) << "nothing was promised";
  EXPECT_TRUE(verify(truth, ContactSet{}, Guarantee::heuristic, true).ok);
}

}  // namespace
}  // namespace cscd::bench
