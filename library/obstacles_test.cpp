#include <gtest/gtest.h>
#include <random>

#include "core/mesh/test_shapes.h"
#include "library/test_steps.h"

// Holds the answers of an object with an obstacle to a search of all feature pairs of both surfaces.
namespace cscd {
namespace {

using namespace test;

// Mutations: obstacles are held against themselves; the bounds of an obstacle are those of the step before;
// a step that starts elsewhere is taken to start free; triangles of obstacles are numbered from 0.
TEST(SelfCollision, HoldsTheMeshAgainstObstacles) {
  std::size_t touching = 0, crossing = 0, apart = 0;
  for (std::uint64_t seed = 1; seed <= intervals(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    SceneStep step = beside(seed);
    const Rows before = step.beside(step.all_start), after = step.beside(step.all_end);
    SelfCollision::Options options;
    options.obstacles.push_back(obstacle_of(step, before));
    SelfCollision body(step.faces, step.start, options);
    body.move_obstacle(0, before, after);
    const Exclusions exclusions = obstacle_against_obstacle(step);
    expect_right(step, body, exclusions);

    const std::size_t own = step.own();
    for (const auto& [key, time] : truth_of(step, exclusions))
      touching += std::ranges::any_of(std::get<1>(key), [&](int v) { return v >= static_cast<int>(own); });
    crossing += !body.all_contacts(step.start, step.end).start_crossings.empty();
    apart += body.is_free(step.start, step.end);
    // Back again: the surface from where it is, the obstacle from there too or from elsewhere.
    std::swap(step.all_start, step.all_end), std::swap(step.start, step.end);
    if (seed % 3 == 0) {
      body.place_obstacle(0, after);
      std::copy(step.all_start.begin() + static_cast<std::ptrdiff_t>(own), step.all_start.end(),
                step.all_end.begin() + static_cast<std::ptrdiff_t>(own));
    } else {
      body.move_obstacle(0, after, before);
    }
    expect_right(step, body, exclusions);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(touching, intervals());
  EXPECT_GT(crossing, intervals() / 20);
  EXPECT_GT(apart, intervals() / 20);
}

// An obstacle that stands a little elsewhere than the library is told gives other answers.
TEST(SelfCollision, SeesAnObstacleThatIsMisplaced) {
  std::size_t seen = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const SceneStep step = beside(seed);
    SelfCollision::Options options;
    options.obstacles.push_back(obstacle_of(step, step.beside(step.all_start)));
    SelfCollision body(step.faces, step.start, options);
    body.move_obstacle(0, step.beside(step.all_start), step.beside(step.all_end).array() + 0.05);
    seen += found(body.all_contacts(step.start, step.end)) != truth_of(step, obstacle_against_obstacle(step));
  }
  EXPECT_GT(seen, 2u);
}

// A surface goes to and fro beside an obstacle, in steps that each start where the last one ended or not.
// Mutation: a free step of which the obstacle has moved since is taken to leave its end known.
TEST(SelfCollision, RemembersNothingOfObstaclesThatChangesAnAnswer) {
  std::size_t crossing = 0;
  for (std::uint64_t seed = 1; seed <= intervals() / 4; ++seed) {
    const SceneStep step = beside(seed);
    const Rows at[] = {step.beside(step.all_start), step.beside(step.all_end),
                       step.beside(step.all_end).array() + 20};
    const Rows poses[] = {step.start, 0.5 * (step.start + step.end), step.end};
    SelfCollision::Options options;
    options.obstacles.push_back(obstacle_of(step, at[0]));
    SelfCollision body(step.faces, step.start, options);
    std::mt19937 random(static_cast<unsigned>(seed));
    std::size_t pose = 0, place = 0;
    for (int i = 0; i < 10; ++i) {
      const std::size_t next = random() % 3, to = random() % 3;
      if (random() % 5 == 0) pose = random() % 3, place = random() % 3;
      body.move_obstacle(0, at[place], at[to]);
      SelfCollision fresh(step.faces, step.start, options);
      fresh.move_obstacle(0, at[place], at[to]);
      const SelfCollision::Answer got = body.all_contacts(poses[pose], poses[next]),
                                  expected = fresh.all_contacts(poses[pose], poses[next]);
      ASSERT_EQ(found(got), found(expected)) << seed << ", " << i;
      ASSERT_EQ(got.start_crossings, expected.start_crossings) << seed << ", " << i;
      crossing += !got.start_crossings.empty();
      pose = next, place = to;
    }
  }
  EXPECT_GT(crossing, intervals() / 10);
}

// A free step leaves its end known, until an obstacle has moved twice since: what it crosses after the first
// of these moves nobody has looked at. Mutation: the second move is taken for the first.
TEST(SelfCollision, LooksAtObstaclesThatMovedTwiceSinceAFreeStep) {
  const Shape ball = icosphere(2);
  const FaceRows faces = face_rows(ball.triangles);
  const Rows rest = rows(ball.positions);
  const auto at = [&](double x, double y) { return Rows(rest.rowwise() + Eigen::RowVector3d(x, y, 0)); };
  const Rows beside = at(1.5, 1.5), further = at(1.5, 1.51), inside = at(0.5, 0), deeper = at(0.4, 0);
  SelfCollision::Options options;
  options.obstacles.push_back({faces, beside});
  SelfCollision body(faces, rest, options);
  body.move_obstacle(0, beside, further);
  EXPECT_TRUE(body.all_contacts(rest, rest).free());
  body.move_obstacle(0, further, inside);
  body.move_obstacle(0, inside, deeper);
  EXPECT_TRUE(body.all_contacts(rest, rest).intersects_at_start());
}

}  // namespace
}  // namespace cscd
