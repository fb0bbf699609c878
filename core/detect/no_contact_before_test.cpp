#include <gtest/gtest.h>
#include <random>

#include "core/detect/compose.h"
#include "core/detect/filter_block.h"
#include "core/detect/test_list_culler.h"
#include "core/elementary/catalogue.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

// Two noisy balls that run into each other, or two boxes whose features touch by the dozen at one
// instant, sometimes at the start.
struct Crash {
  test::Shape shape;
  TriangleMesh mesh;
  std::vector<Vec3> end;

  // `size` scales a scene whose bodies are about 2 across.
  explicit Crash(unsigned seed, double size = 1)
      : shape(seed % 4 == 0 ? test::together(test::box({-1, -1, -1}, {1, 1, 1}),
                                             test::box({seed % 8 == 0 ? 1.0 : 2.0, -1, -1}, {4, 1, 1}))
                            : test::together(test::icosphere(1), test::moved(test::icosphere(1), {3, 0, 0}))),
        mesh(shape.mesh()) {
    std::mt19937 random(seed);
    const auto dice = [&] { return static_cast<double>(random() >> 8) * 0x1p-23 - 1; };
    const double noise = seed % 4 == 0 ? 0 : 0.1 * (seed % 3);
    for (Vec3& p : shape.positions) p += noise * Vec3(dice(), dice(), dice());
    end = shape.positions;
    for (std::size_t i = 0; i < end.size(); ++i)
      end[i] += Vec3(i < end.size() / 2 ? 2 : 0, 0, 0) + noise * Vec3(dice(), dice(), dice());
    for (std::vector<Vec3>* at : {&shape.positions, &end})
      for (Vec3& p : *at) p *= size;
  }
  Motion motion() const { return Motion(shape.positions, end); }
};

ContactSet sorted_answer(Detector& detector, const Crash& crash, std::uint64_t* asked = nullptr) {
  ContactSet found;
  const Report report = detector.detect({crash.motion()}, found);
  if (asked != nullptr) *asked += report.pairs.elementary_tests;
  found.sort();
  return found;
}

// Returns all triangle pairs that carry a feature pair.
std::vector<TrianglePair> carriers(const TriangleMesh& mesh, const FeaturePair& pair) {
  const bool vertex = pair.kind == FeaturePair::Kind::vertex_face;
  const TriangleId face[] = {TriangleId{pair.b}};
  std::vector<TrianglePair> found;
  for (const TriangleId a : vertex ? mesh.triangles_at(VertexId{pair.a}) : mesh.triangles_at(EdgeId{pair.a}))
    for (const TriangleId b : vertex ? face : mesh.triangles_at(EdgeId{pair.b})) found.push_back({a, b});
  return found;
}

// Rule certain-sign, sizes at which single precision rounds, underflows and overflows. Mutations: no bound on
// rounding; a gap counts though it is below 0 at the start; one end's corners seen from the other's.
TEST(FirstOnly, NothingTouchesBeforeTheBoundAndTheBoundIsOfUse) {
  const ElementaryTest& exact = *find_elementary_test("exact");
  for (const double size : {1.0, 0.3, 1e-9, 1e-30, 1e11, 1e37}) {
    std::size_t useful = 0, never = 0, asked = 0;
    for (unsigned seed = 0; seed < 24; ++seed) {
      const Crash crash(seed, size);
      const auto detector = compose(std::make_unique<test::ListCuller>(test::all_pairs(crash.mesh)),
                                    StrategyInput{crash.mesh, {}, nullptr, exact});
      for (const Contact& contact : sorted_answer(*detector, crash).contacts)
        for (const TrianglePair& pair : carriers(crash.mesh, contact.pair)) {
          const TrianglePair both[] = {{pair.b, pair.a}, pair};
          const auto before = no_contact_before(crash.mesh, crash.motion(), both);
          EXPECT_LE(before[0], contact.time) << size;
          EXPECT_LE(before[1], contact.time) << size;
          useful += before[1] > 0.9 * contact.time;
          never += before[1] == 0;
          ++asked;
        }
    }
    ASSERT_GT(asked, 5000u);
    if (size < 1e-20 || size > 1e20)
      EXPECT_EQ(never, asked) << size;
    else
      EXPECT_GT(useful, asked / 2) << size;
  }
}

// Mutations: the detector stops at the first contact that it finds; the earliest time
// is not reset between intervals.
TEST(FirstOnly, ReportsTheContactsOfTheEarliestTimeForFewerTests) {
  const ElementaryTest& exact = *find_elementary_test("exact");
  std::uint64_t tests_for_all = 0, tests_for_first = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    const Crash crash(seed);
    const auto make = [&](bool first_only) {
      const StrategyInput setup{
          .mesh = crash.mesh, .reference = {}, .rig = nullptr, .elementary = exact, .first_only = first_only};
      return compose(std::make_unique<test::ListCuller>(test::all_pairs(crash.mesh)), setup);
    };
    const auto all = make(false), first = make(true);
    ContactSet expected = sorted_answer(*all, crash, &tests_for_all);
    ASSERT_FALSE(expected.contacts.empty());
    keep_first(expected);
    Crash sooner = crash;
    for (std::size_t i = 0; i < sooner.end.size(); ++i)
      sooner.end[i] += crash.end[i] - crash.shape.positions[i];
    for (int again = 0; again < 2; ++again) {
      ContactSet found = sorted_answer(*first, crash, again == 0 ? &tests_for_first : nullptr);
      keep_first(found);
      EXPECT_EQ(digest(found), digest(expected)) << seed;
      sorted_answer(*first, sooner);
    }
  }
  EXPECT_LT(tests_for_first, tests_for_all / 3);
}

TEST(FirstOnly, KeepsWhatIsUndecidedWhateverItsTime) {
  const auto pair = [](std::int32_t i) { return FeaturePair{FeaturePair::Kind::vertex_face, i, 0}; };
  ContactSet set{{{pair(0), Verdict::undecided, 0.1},
                  {pair(1), Verdict::contact, 0.2},
                  {pair(2), Verdict::contact, 0.2},
                  {pair(3), Verdict::undecided, 0.3},
                  {pair(4), Verdict::contact, 0.4}}};
  keep_first(set);
  ASSERT_EQ(set.contacts.size(), 4u);
  EXPECT_EQ(set.contacts[3].pair, pair(3));
  ContactSet none{{{pair(0), Verdict::undecided, 0.1}}};
  keep_first(none);
  EXPECT_EQ(none.contacts.size(), 1u);
}

}  // namespace
}  // namespace cscd
