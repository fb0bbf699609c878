#include "core/detect/first_only.h"

#include <gtest/gtest.h>
#include <random>

#include "core/detect/compose.h"
#include "core/elementary/elementary_test.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

class AllPairs : public Culler {
 public:
  explicit AllPairs(std::size_t triangles) : count_(static_cast<std::int32_t>(triangles)) {}
  void refit(const Motion&) override {}
  CullCounts cull(TrianglePairSink& sink) override {
    for (std::int32_t a = 0; a < count_; ++a)
      for (std::int32_t b = a + 1; b < count_; ++b) sink.add(TriangleId{a}, TriangleId{b});
    return {};
  }

 private:
  std::int32_t count_;
};

// Two noisy balls that run into each other, or a lattice whose features touch by the dozen at one instant.
struct Crash {
  test::Shape shape;
  TriangleMesh mesh;
  std::vector<Vec3> end;

  explicit Crash(unsigned seed)
      : shape(seed % 4 == 0
                  ? test::together(test::box({-1, -1, -1}, {1, 1, 1}), test::box({2, -1, -1}, {4, 1, 1}))
                  : test::together(test::icosphere(1), test::moved(test::icosphere(1), {3, 0, 0}))),
        mesh(shape.mesh()) {
    std::mt19937 random(seed);
    const auto dice = [&] { return static_cast<double>(random() >> 8) * 0x1p-23 - 1; };
    const double noise = seed % 4 == 0 ? 0 : 0.1 * (seed % 3);
    for (Vec3& p : shape.positions) p += noise * Vec3(dice(), dice(), dice());
    end = shape.positions;
    for (std::size_t i = 0; i < end.size(); ++i)
      end[i] += Vec3(i < end.size() / 2 ? 2 : 0, 0, 0) + noise * Vec3(dice(), dice(), dice());
  }
  Motion motion() const { return Motion(shape.positions, end); }
};

ContactSet sorted_answer(Detector& detector, const Crash& crash, std::uint64_t* asked = nullptr) {
  ContactSet found;
  const Report report = detector.detect(crash.motion(), nullptr, found);
  if (asked != nullptr) *asked += report.pairs.elementary_tests;
  found.sort();
  return found;
}

// Mutations: the error is left out of `no_root_before` twice over; the crossing is taken from the first
// coefficient to the last alone.
TEST(FirstOnly, NothingTouchesBeforeTheBoundAndTheBoundIsOfUse) {
  const ElementaryTest& exact = *find_elementary_test("exact");
  std::size_t useful = 0, contacts = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    const Crash crash(seed);
    const auto detector = compose(std::make_unique<AllPairs>(crash.mesh.triangle_count()), crash.mesh, exact);
    for (const Contact& contact : sorted_answer(*detector, crash).contacts) {
      const double before = no_contact_before(crash.mesh, crash.motion(), contact.pair);
      EXPECT_LE(before, contact.time);
      useful += before > contact.time / 2;
      ++contacts;
    }
  }
  EXPECT_GT(contacts, 1000u);
  EXPECT_GT(useful, contacts / 2);
}

// Mutations: it stops at the first contact it finds, or is not reset between intervals.
TEST(FirstOnly, ReportsTheContactsOfTheEarliestTimeForFewerTests) {
  const ElementaryTest& exact = *find_elementary_test("exact");
  std::uint64_t tests_for_all = 0, tests_for_first = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    const Crash crash(seed);
    const auto make = [&] {
      return compose(std::make_unique<AllPairs>(crash.mesh.triangle_count()), crash.mesh, exact);
    };
    const auto all = make(), first = make();
    ASSERT_TRUE(look_for_first_only(*first));
    ContactSet expected = sorted_answer(*all, crash, &tests_for_all);
    ASSERT_FALSE(expected.contacts.empty());
    keep_first(expected);
    for (int again = 0; again < 2; ++again) {
      ContactSet found = sorted_answer(*first, crash, again == 0 ? &tests_for_first : nullptr);
      keep_first(found);
      EXPECT_EQ(digest(found), digest(expected)) << seed;
    }
  }
  EXPECT_LT(tests_for_first, tests_for_all * 3 / 4);
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

class Other : public Detector {
  Report detect(const Motion&, const Rig::Interval*, ContactSet&) override { return {}; }
};

TEST(FirstOnly, DetectorsOfOtherKindsFindAll) {
  Other other;
  EXPECT_FALSE(look_for_first_only(other));
}

}  // namespace
}  // namespace cscd
