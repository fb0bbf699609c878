#include "core/detect/compose.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <set>

#include "core/detect/test_feature_pairs.h"
#include "core/detect/test_list_culler.h"
#include "core/elementary/catalogue.h"
#include "core/elementary/exact/exact.h"
#include "core/elementary/question/filter.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

using test::all_pairs;
using test::ListCuller;

TrianglePair pair_of(std::int32_t a, std::int32_t b) {
  return {TriangleId{a}, TriangleId{b}};
}

// An elementary test that counts how often it is asked about each query. It tells
// vertices apart by their x at t = 0.
std::map<std::vector<double>, int> g_asked;
const ElementaryTest kRecorder{
    "recorder",
    "",
    false,
    false,
    one_by_one<[](const MovingVertexFace& q) {
      ++g_asked[{q.vertex.start.x(), q.corner[0].start.x(), q.corner[1].start.x(), q.corner[2].start.x()}];
      return Answer{Verdict::apart, 0};
    }>,
    one_by_one<[](const MovingEdgeEdge& q) {
      ++g_asked[{-1, q.first[0].start.x(), q.first[1].start.x(), q.second[0].start.x(),
                 q.second[1].start.x()}];
      return Answer{Verdict::apart, 0};
    }>};

// Vertices in the plane z = 0, no two with the same x. The tests mirror them within the interval, so
// that the filter proves nothing.
std::vector<Vec3> flat(std::size_t vertices) {
  std::vector<Vec3> positions;
  for (std::size_t i = 0; i < vertices; ++i)
    positions.emplace_back(static_cast<double>(i), static_cast<double>(i * i % 7), 0);
  return positions;
}

std::vector<Vec3> mirrored(std::vector<Vec3> positions) {
  for (Vec3& p : positions) p = -p;
  return positions;
}

Report run(const TriangleMesh& mesh, const std::vector<Vec3>& start, const std::vector<Vec3>& end,
           std::vector<TrianglePair> pairs, ContactSet& out, const ElementaryTest& test,
           PairOptions options = {}) {
  const auto detector = compose(std::make_unique<ListCuller>(std::move(pairs)),
                                StrategyInput{mesh, start, nullptr, test}, std::move(options));
  const Report report = detector->detect({Motion(start, end)}, out);
  out.sort();
  return report;
}

struct Expansion {
  const char* name;
  std::vector<Triangle> triangles;
  std::uint64_t vertex_face, edge_edge;
};

TEST(Compose, ExpandsAPairOfTrianglesIntoTheFeaturePairsThatShareNoVertex) {
  using test::corners;
  for (const Expansion& e : {Expansion{"disjoint", {corners(0, 1, 2), corners(3, 4, 5)}, 6, 9},
                             Expansion{"share a vertex", {corners(0, 1, 2), corners(2, 3, 4)}, 4, 5},
                             Expansion{"share an edge", {corners(0, 1, 2), corners(2, 1, 3)}, 2, 2}}) {
    const std::size_t vertices = e.vertex_face == 6 ? 6 : e.vertex_face == 4 ? 5 : 4;
    const TriangleMesh mesh(e.triangles, vertices);
    const std::vector<Vec3> x = flat(vertices);
    g_asked.clear();
    ContactSet out;
    const Report report = run(mesh, x, mirrored(x), {pair_of(0, 1)}, out, kRecorder);
    std::uint64_t vertex_face = 0, edge_edge = 0;
    for (const auto& [query, times] : g_asked) {
      EXPECT_EQ(times, 1);
      ++(query.size() == 4 ? vertex_face : edge_edge);
      // No vertex occurs twice in a query.
      EXPECT_EQ(std::set<double>(query.begin(), query.end()).size(), query.size()) << e.name;
    }
    EXPECT_EQ(vertex_face, e.vertex_face) << e.name;
    EXPECT_EQ(edge_edge, e.edge_edge) << e.name;
    EXPECT_EQ(report.pairs.feature_pairs, e.vertex_face + e.edge_edge) << e.name;
    EXPECT_EQ(report.pairs.elementary_tests, e.vertex_face + e.edge_edge) << e.name;
    EXPECT_EQ(report.pairs.adjacent_pctp, e.vertex_face == 6 ? 0u : 1u) << e.name;
    EXPECT_EQ(report.cull.pctp, 1u);
  }
}

// Rule any-carrier: all triangle pairs carry all feature pairs, each is tested once, however often it is
// carried and in however many blocks.
TEST(Compose, TestsEachFeaturePairOnceOverManyBlocks) {
  const TriangleMesh mesh = test::icosphere(1).mesh();
  const std::vector<Vec3> x = flat(mesh.vertex_count());
  std::vector<TrianglePair> pairs;
  std::mt19937 random(1);
  while (pairs.size() < 100'000)  // several blocks of 2^15
    for (TrianglePair pair : all_pairs(mesh)) {
      if (random() % 2) std::swap(pair.a, pair.b);
      pairs.push_back(pair);
    }
  std::shuffle(pairs.begin(), pairs.end(), random);
  g_asked.clear();
  ContactSet out;
  const Report report = run(mesh, x, mirrored(x), pairs, out, kRecorder);
  EXPECT_EQ(report.cull.pctp, pairs.size());
  const std::size_t expected = test::all_feature_pairs(mesh).size();
  EXPECT_EQ(g_asked.size(), expected);
  EXPECT_EQ(report.pairs.elementary_tests, expected);
  EXPECT_GE(report.pairs.feature_pairs, expected);
  for (const auto& [query, times] : g_asked) ASSERT_EQ(times, 1);
}

// A crumpled sphere has contacts of all kinds.
struct Crumple {
  test::Shape shape = test::icosphere(1);
  TriangleMesh mesh = shape.mesh();
  std::vector<Vec3> end = shape.positions;
  explicit Crumple(unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (Vec3& p : end) p += Vec3(unit(random), unit(random), unit(random));
  }
};

TEST(Compose, FindsWhatAskingAboutEveryFeaturePairFinds) {
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const Crumple c(seed);
    ContactSet expected =
        test::contacts_by_asking(c.mesh, Motion(c.shape.positions, c.end), *find_elementary_test("exact"));
    expected.sort();
    EXPECT_GT(expected.contacts.size(), 50u);
    std::vector<TrianglePair> pairs = all_pairs(c.mesh);
    std::mt19937 random(seed);
    for (int order = 0; order < 3; ++order) {
      for (const bool relative_boxes : {false, true}) {
        ContactSet out;
        const Report report = run(c.mesh, c.shape.positions, c.end, pairs, out,
                                  *find_elementary_test("exact"), {relative_boxes});
        EXPECT_EQ(digest(out), digest(expected));
        EXPECT_EQ(report.pairs.relative_dropped > 0, relative_boxes);
        EXPECT_LT(report.pairs.elementary_tests, test::all_feature_pairs(c.mesh).size());
      }
      std::shuffle(pairs.begin(), pairs.end(), random);
      for (TrianglePair& pair : pairs)
        if (random() % 2) std::swap(pair.a, pair.b);
      if (order == 1)  // more blocks
        while (pairs.size() < 100'000) pairs.insert(pairs.end(), pairs.begin(), pairs.begin() + 3000);
    }
  }
}

// Saboteur: if a triangle pair that alone carries a contact is lost, the digest changes.
TEST(Compose, ALostTrianglePairIsNoticed) {
  const TriangleMesh mesh({test::corners(0, 1, 2), test::corners(3, 4, 5), test::corners(6, 7, 8)}, 9);
  const std::vector<Vec3> start = {{0, 0, 0},     {1, 0, 0}, {0, 1, 0}, {0.1, 0.1, 1}, {0.3, 0.1, 2},
                                   {0.1, 0.3, 2}, {5, 5, 5}, {6, 5, 5}, {5, 6, 5}};
  std::vector<Vec3> end = start;
  for (std::size_t v = 3; v < 6; ++v) end[v].z() -= 1.5;
  const ElementaryTest& exact = *find_elementary_test("exact");
  ContactSet whole, lost;
  run(mesh, start, end, all_pairs(mesh), whole, exact);
  run(mesh, start, end, {pair_of(0, 2), pair_of(1, 2)}, lost, exact);
  ASSERT_EQ(whole.contacts.size(), 1u);
  EXPECT_EQ(whole.contacts[0].pair, FeaturePair::of(VertexId{3}, TriangleId{0}));
  EXPECT_NEAR(whole.contacts[0].time, 2.0 / 3, 1e-15);
  EXPECT_NE(digest(whole), digest(lost));
}

// Rule fresh-detector: one detector that is used in any order of intervals gives
// the answers of fresh detectors.
TEST(Compose, KeepsNothingBetweenIntervals) {
  const Crumple a(1), b(2);
  const ElementaryTest& exact = *find_elementary_test("exact");
  const auto detector =
      compose(std::make_unique<ListCuller>(all_pairs(a.mesh)), StrategyInput{a.mesh, {}, nullptr, exact});
  ContactSet out;
  std::mt19937 random(1);
  std::string expected[2];
  for (int i = 0; i < 2; ++i) {
    const Crumple& c = i ? b : a;
    ContactSet fresh;
    run(c.mesh, c.shape.positions, c.end, all_pairs(c.mesh), fresh, exact);
    expected[i] = digest(fresh);
  }
  ASSERT_NE(expected[0], expected[1]);
  std::uint64_t tests[2] = {};
  for (int i = 0; i < 12; ++i) {
    const bool second = random() % 2;
    const Crumple& c = second ? b : a;
    const Report report = detector->detect({Motion(c.shape.positions, c.end)}, out);
    out.sort();
    EXPECT_EQ(digest(out), expected[second]);
    if (tests[second] == 0) tests[second] = report.pairs.elementary_tests;
    EXPECT_EQ(report.pairs.elementary_tests, tests[second]);
    EXPECT_EQ(report.cull.pctp, all_pairs(c.mesh).size());
  }
}

TEST(Compose, UndecidedPairsAreKept) {
  const TriangleMesh mesh({test::corners(0, 1, 2), test::corners(3, 4, 5)}, 6);
  const ElementaryTest shrug{"shrug",
                             "",
                             false,
                             false,
                             one_by_one<[](const MovingVertexFace&) {
                               return Answer{Verdict::undecided, 0.5};
                             }>,
                             one_by_one<[](const MovingEdgeEdge&) {
                               return Answer{Verdict::apart, 0};
                             }>};
  ContactSet out;
  run(mesh, flat(6), mirrored(flat(6)), {pair_of(0, 1)}, out, shrug);
  ASSERT_EQ(out.contacts.size(), 6u);
  for (const Contact& contact : out.contacts) EXPECT_EQ(contact.verdict, Verdict::undecided);
}

TEST(Compose, RelativeBoxesAreForNonAdjacentPairsOnly) {
  // Two adjacent triangles and a far one move together.
  const TriangleMesh mesh({test::corners(0, 1, 2), test::corners(2, 1, 3), test::corners(4, 5, 6)}, 7);
  std::vector<Vec3> start = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {9, 0, 0}, {10, 0, 0}, {9, 1, 0}};
  std::vector<Vec3> end = start;
  for (Vec3& p : end) p += Vec3(-20, 0, 0);
  ContactSet out;
  g_asked.clear();
  const Report report = run(mesh, start, end, all_pairs(mesh), out, kRecorder, {true});
  EXPECT_EQ(report.pairs.adjacent_pctp, 1u);
  EXPECT_EQ(report.pairs.relative_dropped, 2u);
  EXPECT_EQ(report.pairs.feature_pairs, 4u);
}

TEST(Compose, StagesThatDoNotExistAreAbsent) {
  const TriangleMesh mesh({test::corners(0, 1, 2), test::corners(3, 4, 5)}, 6);
  const std::vector<Vec3> x = flat(6);
  for (const bool classifies : {false, true}) {
    const auto detector =
        compose(std::make_unique<ListCuller>(std::vector<TrianglePair>{pair_of(0, 1)}, classifies),
                StrategyInput{mesh, x, nullptr, kRecorder});
    ContactSet out;
    const Report report = detector->detect({Motion(x, x)}, out);
    EXPECT_EQ(report.ms.classify.has_value(), classifies);
    EXPECT_FALSE(report.cull.radial.has_value());
    EXPECT_GT(report.ms.elementary, 0);
    EXPECT_EQ(detector->radial_view().cluster, std::vector<std::int32_t>{7});
  }
}

// Blocks of every size hand on the same pairs in the same order.
TEST(TrianglePairSink, HandsOnEveryPairOnceInBlocksOfAnySize) {
  struct Collector : TrianglePairSink {
    using TrianglePairSink::TrianglePairSink;
    void take(const std::vector<TrianglePair>& block) override {
      ++blocks;
      for (const TrianglePair& pair : block) taken.push_back(static_cast<int>(pair.a));
    }
    int blocks = 0;
    std::vector<int> taken;
  };
  for (const std::size_t block : {0u, 1u, 2u, 7u, 100u, 1000u}) {
    Collector sink(block);
    for (int i = 0; i < 100; ++i) sink.add(TriangleId{i}, TriangleId{i + 1});
    sink.flush();
    sink.flush();
    EXPECT_EQ(sink.count(), 100u);
    ASSERT_EQ(sink.taken.size(), 100u);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(sink.taken[static_cast<std::size_t>(i)], i);
    if (block > 0) {
      EXPECT_EQ(sink.blocks, static_cast<int>((100 + block - 1) / block));
    }
    sink.add(TriangleId{0}, TriangleId{1});
    sink.restart();
    sink.flush();
    EXPECT_EQ(sink.count(), 0u);
    EXPECT_LE(sink.taken.size(), 101u);
  }
}

// A flat sheet folds onto itself within its plane, and everything on one side arrives at t = 1/2. Mutations:
// nothing is left out; the search goes on after a contact at t = 0; what is left out is earlier.
TEST(Compose, TheTimeAloneLeavesOutWhatIsNotEarlier) {
  constexpr std::int32_t kSide = 8;
  std::vector<Vec3> start, end;
  std::vector<Triangle> triangles;
  for (std::int32_t j = 0; j <= kSide; ++j)
    for (std::int32_t i = 0; i <= kSide; ++i) {
      start.emplace_back(i, j, 0);
      end.emplace_back(std::min(i, kSide - i), j, 0);
      if (i == kSide || j == kSide) continue;
      const std::int32_t v = j * (kSide + 1) + i, above = v + kSide + 1;
      triangles.push_back({VertexId{v}, VertexId{v + 1}, VertexId{above + 1}});
      triangles.push_back({VertexId{v}, VertexId{above + 1}, VertexId{above}});
    }
  const TriangleMesh mesh(triangles, start.size());
  const StrategyInput setup{mesh, start, nullptr, *find_elementary_test("filtered_exact"), 1, true};
  const auto detector = compose(std::make_unique<ListCuller>(all_pairs(mesh)), setup);
  for (const bool folded : {false, true}) {
    std::uint64_t tests[2];
    for (const bool alone : {false, true}) {
      ContactSet out;
      const Motion motion(folded ? end : start, end);
      tests[alone] = detector->detect({.motion = motion, .time_alone = alone}, out).pairs.elementary_tests;
      out.sort();
      ASSERT_FALSE(out.contacts.empty());
      EXPECT_NEAR(out.contacts.front().time, folded ? 0 : 0.5, 1e-13);
      EXPECT_GT(out.contacts.front().time, folded ? -1 : 0.4999);
    }
    EXPECT_GT(tests[0], 20 * tests[1]) << folded;
  }
  // Of two that arrive one after the other, the earlier is found, in either order.
  test::Shape two;
  two.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 1}, {1, 2, 1}, {2, 1, 1}};
  two.triangles = {{VertexId{0}, VertexId{1}, VertexId{2}}, {VertexId{3}, VertexId{4}, VertexId{5}}};
  std::vector<Vec3> down = two.positions;
  down[3].z() = -1, down[4].z() = -1.5, down[5].z() = -1.25;
  const TriangleMesh pair = two.mesh();
  ContactSet out;
  compose(std::make_unique<ListCuller>(all_pairs(pair)),
          {pair, two.positions, nullptr, *find_elementary_test("filtered_exact"), 1, true})
      ->detect({.motion = Motion(two.positions, down), .time_alone = true}, out);
  out.sort();
  ASSERT_FALSE(out.contacts.empty());
  EXPECT_NEAR(out.contacts.front().time, 0.4, 1e-12);
}

}  // namespace
}  // namespace cscd
