#include "baselines/fcl/fcl.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "baselines/plain.h"
#include "core/base/error.h"
#include "core/elementary/catalogue.h"
#include "core/mesh/test_shapes.h"
#include "scenes/random/random_interval.h"

namespace cscd {
namespace {

// Two boxes pass into each other. They are moved a little out of line, so that nothing is parallel.
TEST(Fcl, FindsWhatIsPlainToSee) {
  test::Shape upper = test::moved(test::box(), {0.3, 0.2, 1.5}, 0.9);
  for (Vec3& p : upper.positions) p.z() += 0.11 * p.x() - 0.07 * p.y();
  const test::Shape shape = test::together(test::box(), upper);
  std::vector<Vec3> end = shape.positions;
  for (std::size_t i = 8; i < 16; ++i) end[i].z() -= 1;
  const TriangleMesh mesh = shape.mesh();
  const ElementaryTest& exact = *find_elementary_test("exact");
  const StrategyInput setup{mesh, shape.positions, nullptr, exact};
  ContactSet found, truth;
  const auto fcl = make_fcl(setup).detector, base = make_base(setup).detector;
  for (int visit = 0; visit < 2; ++visit) {
    const Report report = fcl->detect({Motion(shape.positions, end)}, found);
    base->detect({Motion(shape.positions, end)}, truth);
    found.sort(), truth.sort();
    ASSERT_FALSE(found.contacts.empty());
    EXPECT_NEAR(found.contacts[0].time, truth.contacts[0].time, 1e-3);
    EXPECT_GT(*report.cull.bvot, report.cull.pctp);
    // The way back leaves no contact of the interval before.
    fcl->detect({Motion(shape.positions, shape.positions)}, found);
    EXPECT_TRUE(found.contacts.empty());
  }
}

// If FCL's cubics overflowed, it would search for seconds a pair.
TEST(Fcl, RefusesWhatOverflows) {
  test::Shape shape = test::together(test::box(), test::moved(test::box(), {0.5, 0.5, 0.5}));
  for (Vec3& p : shape.positions) p *= 1e120;
  const TriangleMesh mesh = shape.mesh();
  const auto fcl = make_fcl({mesh, shape.positions, nullptr, *find_elementary_test("exact")}).detector;
  ContactSet found;
  EXPECT_THROW(fcl->detect({Motion(shape.positions, shape.positions)}, found), InputError);
}

// FCL promises nothing. The test records what it does on random intervals, so that a change is noticed: it
// finds most contacts, but not all.
TEST(Fcl, FindsMostContactsOfRandomIntervals) {
  const ElementaryTest& exact = *find_elementary_test("exact");
  std::size_t expected = 0, shared = 0, invented = 0;
  for (std::uint64_t seed = 1; seed <= 66; ++seed) {
    const scenes::RandomInterval random = scenes::make_random_interval(seed);
    const TriangleMesh mesh(random.clip.header().triangles, random.clip.header().vertex_count);
    const Motion motion = random.clip.interval(0).motion;
    const StrategyInput setup{mesh, motion.start(), nullptr, exact};
    ContactSet found, truth;
    make_fcl(setup).detector->detect({motion}, found);
    make_base(setup).detector->detect({motion}, truth);
    expected += truth.contacts.size();
    for (const Contact& contact : found.contacts) {
      const bool real = std::any_of(truth.contacts.begin(), truth.contacts.end(),
                                    [&](const Contact& c) { return c.pair == contact.pair; });
      (real ? shared : invented) += 1;
    }
  }
  RecordProperty("expected", static_cast<int>(expected));
  RecordProperty("found", static_cast<int>(shared));
  RecordProperty("invented", static_cast<int>(invented));
  EXPECT_GT(shared, expected / 2);
  EXPECT_LT(shared, expected);
  EXPECT_LT(invented, expected / 2);
}

}  // namespace
}  // namespace cscd
