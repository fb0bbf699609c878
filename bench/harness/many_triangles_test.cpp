#include <cmath>
#include <gtest/gtest.h>

#include "bench/strategies/verify.h"
#include "bench/testing/rule_case.h"
#include "core/fast/prepare/coarse_surface.h"
#include "core/fast/trial.h"

// Whole strategies on surfaces of so many triangles that preparation decides on a coarser surface
// (core/fast/trial.h). Random intervals, and most other tests, have far fewer triangles.
namespace cscd::bench {
namespace {

using rules::Case;

// Asks with a test that is always right and filters first. Surfaces of this size have too many feature pairs
// for the plain one.
ContactSet answer_of(const Strategy& strategy, const Case& given) {
  const StrategyInput setup{given.mesh, given.start, &given.rig, elementary_test_named("filtered_exact")};
  return given.ask(*strategy.make(setup).detector);
}

void expect_promises_kept(const Case& given, const std::vector<const Strategy*>& strategies) {
  ASSERT_TRUE(fast::CoarseSurface(given.mesh, given.start, fast::kManyTriangles).is_coarser());
  const ContactSet reference = answer_of(complete_reference(), given);
  ASSERT_GT(reference.contacts.size(), 0u);
  const bool embedded = given.embedded();
  for (const Strategy* strategy : strategies) {
    const Verification verification =
        verify(reference, answer_of(*strategy, given), strategy->guarantee, embedded);
    EXPECT_TRUE(verification.ok) << strategy->name << ": " << verification.failure;
  }
}

std::vector<const Strategy*> for_closed_surfaces() {
  return {&strategy_named("drvbc_fast"), &strategy_named("drvbc_fast_all"),
          &strategy_named("drvbc_fast_complete")};
}

// A ball with a button and a limb beside it; the limb has `sides` sides. The ball bulges, the button is
// pressed towards the ball by the length `pressed`, and the limb bends and moves towards the ball by as much
// or more.
Case dressed_ball(int sides, double pressed) {
  const test::Shape ball = test::icosphere(5), button = test::moved(test::box(), {1.1, 0, 0}, 0.2),
                    limb = test::moved(test::capped_tube(sides, 40, 0.05, 3), {-1, 1.2, 0}, 1);
  const test::Shape all = test::together(test::together(ball, button), limb);
  std::vector<Vec3> end = all.positions;
  const std::size_t first_of_button = ball.positions.size(),
                    first_of_limb = first_of_button + button.positions.size();
  for (std::size_t v = 0; v < end.size(); ++v) {
    Vec3& p = end[v];
    if (v < first_of_button)
      p *= 1 + 0.1 * std::sin(9 * p.x()) * std::cos(7 * p.y() + 5 * p.z());
    else if (v < first_of_limb)
      p.x() -= pressed;
    else
      p.y() -= pressed * (1 + std::sin(4 * p.x()));
  }
  return Case(all, std::move(end), {{-0.5, 0, 0}, {0.5, 0, 0}});
}

TEST(ManyTriangles, KeepPromisesOnClosedSurfaces) {
  for (const int sides : {3, 6})
    for (const double pressed : {0.15, 0.3})
      expect_promises_kept(dressed_ball(sides, pressed), for_closed_surfaces());
}

// From their common middle, both balls are seen well. Mutation: all triangles of the surface become one
// cluster, although clusters must not reach over components.
TEST(ManyTriangles, KeepPromisesOnABallInABall) {
  const test::Shape inner = test::icosphere(4, 0.8), both = test::together(inner, test::icosphere(5));
  std::vector<Vec3> end = both.positions;
  for (std::size_t v = 0; v < inner.positions.size(); ++v)
    if (end[v].x() > 0.7) end[v] *= 1.4;
  expect_promises_kept(Case(both, std::move(end), {{-0.5, 0, 0}, {0.5, 0, 0}}), for_closed_surfaces());
}

// A folded sheet that meets itself along one side, with a fin along another, where edges have three
// triangles.
TEST(ManyTriangles, KeepPromisesOnAnySurface) {
  test::Shape sheet = test::sheet(100);
  for (std::size_t t = 0; t < 200; t += 2) {
    const Triangle& below = sheet.triangles[t];
    const auto tip = static_cast<std::int32_t>(sheet.positions.size());
    sheet.positions.push_back(sheet.positions[+below[0]] + Vec3(0, 0, -0.05));
    sheet.triangles.push_back({below[0], below[1], VertexId{tip}});
  }
  for (Vec3& p : sheet.positions)
    if (p.x() > 0) p = {-p.x(), p.y(), p.z() + 0.3 * p.x()};
  std::vector<Vec3> end = sheet.positions;
  for (Vec3& p : end)
    if (p.z() > 0) p.z() *= p.y() + 0.9;
  expect_promises_kept(Case(sheet, std::move(end), {{0, 0, 0}, {1, 0, 0}}),
                       {&strategy_named("drvbc_fast_complete")});
}

}  // namespace
}  // namespace cscd::bench
