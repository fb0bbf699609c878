#include <algorithm>
#include <gmpxx.h>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "bench/strategies/verify.h"
#include "bench/testing/rule_case.h"
#include "core/detect/test_list_culler.h"
#include "core/elementary/question/relative_box.h"
#include "core/geometry/kdop.h"
#include "scenes/random/random_interval.h"
#include "scenes/random/surface.h"

// Rules outward-rounding to closed-interval: bounds, relative boxes, signs and roots. Rules any-carrier,
// three-vertices, component and fair-comparison: what a cluster may drop. Counter-examples: two octahedra and
// a fingertip against representative triangles, a finger over a segment observer, nested shells, a thin flap.
namespace cscd::bench {

namespace {

using namespace rules;

// Mutations of vertex_bounds.cpp: rounded to the nearest float (only this test notices: rounding is monotone,
// so bodies that touch still overlap); rounded up; the start alone bounded.
TEST(Rules, OutwardRoundingBoundsContainTheExactMotionAtBothEnds) {
  constexpr int kDirection[8][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1},  {1, 1, 0},
                                    {1, 0, 1}, {0, 1, 1}, {1, -1, 0}, {1, 0, -1}};
  for (std::uint64_t seed = 1; seed <= 33; ++seed) {
    const scenes::RandomInterval random = scenes::make_random_interval(seed);
    const TriangleMesh mesh(random.clip.header().triangles, random.clip.header().vertex_count);
    const Motion motion = random.clip.interval(0).motion;
    const Tree tree = build_tree(mesh, motion.start());
    SweptBounds bounds(mesh, tree);
    bounds.refit(motion);
    for (NodeIndex node = 0; node < static_cast<NodeIndex>(tree.node_count()); ++node) {
      if (!tree.is_leaf(node)) continue;
      for (const VertexId vertex : mesh.corners(tree.triangle(node)))
        for (const Vec3& p : {motion[vertex].start, motion[vertex].end})
          for (std::size_t k = 0; k < 8; ++k) {
            mpq_class along = 0;
            for (int i = 0; i < 3; ++i) along += kDirection[k][i] * mpq_class(p[i]);
            EXPECT_LE(mpq_class(bounds[node].at_least[k]), along);
            EXPECT_LE(mpq_class(bounds[node].at_least[8 + k]), -along);
            EXPECT_LE(mpq_class(bounds[0].at_least[k]), along);
          }
    }
  }
}

// Mutations of vertex_bounds.cpp: rounded up; the start alone bounded.
TEST(Rules, OutwardRoundingBodiesThatTouchExactlyAreFound) {
  std::size_t touching = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const scenes::RandomInterval random = scenes::make_random_interval(seed);
    if (random.family != "touching_lattice") continue;
    const TriangleMesh mesh(random.clip.header().triangles, random.clip.header().vertex_count);
    const std::span<const Vec3> start = random.clip.frame(0).positions;
    ContactSet truth, found;
    for (const auto& [strategy, set] :
         {std::pair{&all_pairs(), &truth}, std::pair{&complete_reference(), &found}}) {
      strategy->make({mesh, start, nullptr, exact()})
          .detector->detect({random.clip.interval(0).motion}, *set);
      set->sort();
    }
    EXPECT_EQ(digest(found), digest(truth)) << "seed " << seed;
    touching += !truth.contacts.empty();
  }
  EXPECT_GT(touching, 10u);
}

// Two triangles rush by together, far away, and touch at the very end in one exact point. Mutation:
// relative_boxes_apart compares start + ((end - start) - mean) instead of end - mean.
TEST(Rules, RelativeMotionRelativeBoxesKeepTrianglesThatTouchInFastCommonMotion) {
  std::mt19937_64 random(6);
  const auto uniform = [&](double half) {
    return half * (static_cast<double>(random() >> 11) * 0x1p-52 - 1);
  };
  const auto in_box = [&](double half) -> Vec3 { return {uniform(half), uniform(half), uniform(half)}; };
  for (int i = 0; i < 20000; ++i) {
    const Vec3 rush = in_box(std::pow(10, i % 7)), offset = in_box(std::pow(10, i % 5));
    const Vec3 meeting = offset + rush;
    // One triangle on either side of a plane through the meeting point.
    const int axis = i % 3;
    MovingPoint a[3], b[3];
    for (int k = 0; k < 3; ++k) {
      a[k] = {offset + in_box(1), meeting + in_box(1)};
      b[k] = {offset + in_box(1), meeting + in_box(1)};
      a[k].start[axis] = offset[axis] - 1 - std::abs(uniform(1));
      b[k].start[axis] = offset[axis] + 1 + std::abs(uniform(1));
      a[k].end[axis] = std::min(a[k].end[axis], meeting[axis]);
      b[k].end[axis] = std::max(b[k].end[axis], meeting[axis]);
    }
    a[0].end = b[0].end = meeting;
    ASSERT_FALSE(relative_boxes_apart(a, b)) << "case " << i;
  }
}

// Two triangles without a common vertex in their own motions.
ContactSet contacts_of_two(const std::vector<Vec3>& start, const std::vector<Vec3>& end) {
  const TriangleMesh mesh({test::corners(0, 1, 2), test::corners(3, 4, 5)}, 6);
  ContactSet found[2];
  int which = 0;
  for (const Strategy* strategy : {&all_pairs(), &complete_reference()}) {
    strategy->make({mesh, start, nullptr, exact()}).detector->detect({Motion(start, end)}, found[which]);
    found[which++].sort();
  }
  EXPECT_EQ(digest(found[0]), digest(found[1]));
  return found[0];
}

std::vector<Vec3> second_moved(std::vector<Vec3> positions, const Vec3& by) {
  return shifted(std::move(positions), 3, 6, by);
}

// A triangle in the plane z = 0 whose legs have this length, and a second one.
std::vector<Vec3> beside_flat(double leg, std::vector<Vec3> second) {
  const std::vector<Vec3> flat = {{0, 0, 0}, {leg, 0, 0}, {0, leg, 0}};
  second.insert(second.begin(), flat.begin(), flat.end());
  return second;
}

// Mutation: certain_sign compares with >= and an error of zero, so that four zeros share a sign.
TEST(Rules, CertainSignCoplanarForAllTimeIsNotApart) {
  const std::vector<Vec3> start = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {5, 0.5, 0}, {7, 0.25, 0}, {7, 1.5, 0}};
  const ContactSet found = contacts_of_two(start, second_moved(start, {-8, 0, 0}));
  ASSERT_FALSE(found.contacts.empty());
  EXPECT_EQ(found.contacts.front().time, 3.5 / 8);
  for (const Contact& contact : found.contacts) EXPECT_EQ(contact.verdict, Verdict::contact);
}

// Mutation: exact::first_contact answers "apart" for the zero polynomial.
TEST(Rules, DegenerateDegenerateFeaturesStillTouch) {
  const auto with = [](std::vector<Vec3> second) { return beside_flat(2, std::move(second)); };
  struct {
    const char* what;
    std::vector<Vec3> start;
    Vec3 by;
    double time;
  } const cases[] = {
      {"a triangle shrunk to a point, in the plane",
       with({{4, 0.5, 0}, {4, 0.5, 0}, {4, 0.5, 0}}),
       {-5, 0, 0},
       0.5},
      {"a triangle shrunk to a line, from above",
       with({{0.25, 0.25, 1}, {0.5, 0.5, 1}, {0.75, 0.75, 1}}),
       {0, 0, -4},
       0.25},
      {"parallel edges that slide onto each other",
       with({{3, 0, 0}, {5, 0, 0}, {4, -2, 0}}),
       {-2, 0, 0},
       0.5},
      {"zero motion, touching", with({{1, 0, 0}, {1, -1, 1}, {1, -1, -1}}), {0, 0, 0}, 0},
      {"one moving along itself", with({{3, 0, 0}, {4, 0, 0}, {5, 0, 0}}), {-4, 0, 0}, 0.25},
  };
  for (const auto& c : cases) {
    const ContactSet found = contacts_of_two(c.start, second_moved(c.start, c.by));
    ASSERT_FALSE(found.contacts.empty()) << c.what;
    EXPECT_EQ(found.contacts.front().time, c.time) << c.what;
  }
}

// Mutation: roots_in_unit_interval leaves out roots at 0 and 1; even roots dropped.
TEST(Rules, ClosedIntervalRootsAtTheEndsAndDoubleRootsCount) {
  const auto with = [](std::vector<Vec3> second) { return beside_flat(4, std::move(second)); };
  const auto first_time = [&](const std::vector<Vec3>& start, const std::vector<Vec3>& end) {
    const ContactSet found = contacts_of_two(start, end);
    return found.contacts.empty() ? -1.0 : found.contacts.front().time;
  };
  // A tip that leaves at once, arrives at the very end, touches an edge, a corner.
  const std::vector<Vec3> on_face = with({{1, 1, 0}, {1, 2, 3}, {2, 1, 3}});
  EXPECT_EQ(first_time(on_face, second_moved(on_face, {0, 0, 5})), 0);
  const std::vector<Vec3> above = second_moved(on_face, {0, 0, 1});
  EXPECT_EQ(first_time(above, on_face), 1);
  EXPECT_EQ(first_time(second_moved(above, {1, 1, 0}), second_moved(on_face, {1, 1, 0})), 1) << "edge";
  EXPECT_EQ(first_time(second_moved(above, {-1, -1, 0}), second_moved(on_face, {-1, -1, 0})), 1) << "corner";
  EXPECT_EQ(first_time(above, second_moved(on_face, {0, 0, 0.125})), -1) << "just not";
  // A double root: the face turns about the x axis up to slope t, the tip at height 1/4 moves to y = 1 - t;
  // it is above the face by 1/4 - t (1 - t) = (t - 1/2)^2.
  std::vector<Vec3> start = with({{1, 1, 0.25}, {1, 1, 9}, {2, 1, 9}}), end = second_moved(start, {0, -1, 0});
  end[2] = {0, 4, 4};
  EXPECT_EQ(first_time(start, end), 0.5) << "double root";
}

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
          const auto detector =
              compose(std::make_unique<test::ListCuller>(std::vector{TrianglePair{a, b}}), scene.setup());
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
