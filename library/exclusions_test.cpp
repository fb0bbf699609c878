#include <gtest/gtest.h>
#include <random>

#include "library/test_steps.h"

// Holds the answers of an object that leaves something out to a search of all feature pairs that leaves out
// the same.
namespace cscd {
namespace {

using namespace test;

// What is left out, as the library is told and as the search of all pairs is told.
struct Filter {
  SelfCollision::Exclusions asked;
  Exclusions expected;
};
constexpr std::uint64_t kFilters = 6;  // kinds

int drawn(std::mt19937& random, std::size_t count) {
  return static_cast<int>(random() % count);
}

// Draws half as many pairs as there are ordered pairs of `count` things. Returns the pairs as identifiers,
// and appends them to `asked` as numbers.
template <class Id>
std::vector<std::pair<Id, Id>> draw_pairs(std::size_t count, std::mt19937& random,
                                          std::vector<std::pair<int, int>>& asked) {
  std::vector<std::pair<Id, Id>> pairs;
  for (std::size_t i = 0; i < count * count / 2; ++i) {
    asked.emplace_back(drawn(random, count), drawn(random, count));
    pairs.emplace_back(Id{asked.back().first}, Id{asked.back().second});
  }
  return pairs;
}

// A filter of one kind. A wrong one tells the library something else in one place.
Filter filter_of(std::uint64_t kind, const SceneStep& step, bool wrong = false) {
  const std::size_t n = step.mesh.vertex_count(), m = step.mesh.triangle_count();
  std::mt19937 random(static_cast<unsigned>(17 * n + m));
  Filter out;
  SelfCollision::Exclusions& asked = out.asked;
  if (kind == 0) {
    for (std::size_t v = 0; v < n; ++v) asked.obstacle.push_back(random() % 2 == 0);
    out.expected.set_obstacles(step.mesh, asked.obstacle);
    if (wrong) asked.obstacle.flip();
  } else if (kind == 1) {
    for (std::size_t v = 0; v < n; ++v) asked.group.push_back(v < n / 2 ? 0 : 1);
    asked.groups_that_ignore_each_other = {{0, drawn(random, 2)}};
    out.expected.set_groups(step.mesh, asked.group, asked.groups_that_ignore_each_other);
    if (wrong) asked.groups_that_ignore_each_other = {{1, 1}};
  } else if (kind == 2) {
    asked.rings = wrong ? 2 : 3;
    out.expected.exclude_rings(step.mesh, 3);
  } else if (kind == 3) {
    asked.rest_distance = wrong ? 0.5 : 1;
    out.expected.exclude_near(step.all_start, 1);
  } else if (kind == 4) {
    out.expected.exclude(step.mesh, draw_pairs<VertexId>(n, random, asked.vertex_pairs));
    if (wrong) asked.vertex_pairs.resize(asked.vertex_pairs.size() / 2);
  } else {
    out.expected.exclude(step.mesh, draw_pairs<TriangleId>(m, random, asked.face_pairs));
    if (wrong) asked.face_pairs.resize(asked.face_pairs.size() / 2);
  }
  return out;
}

// Mutations: a pair of features is excluded by one pair of vertices; excluded contacts are followed; the
// first contact is looked for among those that a search for the first of all came by.
TEST(SelfCollision, LeavesOutWhatIsExcluded) {
  std::size_t left_out = 0, left = 0;
  for (std::uint64_t seed = 1; seed <= intervals(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SceneStep step(seed);
    const Filter filter = filter_of(seed % kFilters, step);
    SelfCollision::Options options;
    options.exclude = filter.asked;
    SelfCollision body(step.faces, step.start, options);
    expect_right(step, body, filter.expected);
    const std::size_t kept = truth_of(step, filter.expected).size();
    left += kept;
    left_out += truth_of(step, {}).size() - kept;
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(left_out, intervals());
  EXPECT_GT(left, intervals());
}

// A filter of each kind that is wrong in one place gives other contacts: the tests above would see it.
TEST(SelfCollision, SeesAWrongFilterOfEachKind) {
  for (std::uint64_t kind = 0; kind < kFilters; ++kind) {
    std::size_t seen = 0;
    for (std::uint64_t seed = 1; seed <= 24 && seen == 0; ++seed) {
      const SceneStep step(seed);
      const Filter filter = filter_of(kind, step, true);
      SelfCollision::Options options;
      options.exclude = filter.asked;
      seen += found(SelfCollision(step.faces, step.start, options).all_contacts(step.start, step.end)) !=
              truth_of(step, filter.expected);
    }
    EXPECT_GT(seen, 0u) << "kind " << kind;
  }
}

// Filters name vertices and faces of obstacles behind those of the mesh.
TEST(SelfCollision, LeavesOutWhatIsExcludedOfObstacles) {
  for (std::uint64_t seed = 1; seed <= intervals() / 2; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SceneStep step = beside(seed);
    const Rows before = step.beside(step.all_start), after = step.beside(step.all_end);
    Filter filter = filter_of(1 + seed % (kFilters - 1), step);
    exclude_obstacle_against_obstacle(step, filter.expected);
    SelfCollision::Options options;
    options.obstacles.push_back(obstacle_of(step, before));
    options.exclude = filter.asked;
    SelfCollision body(step.faces, step.start, options);
    body.move_obstacle(0, before, after);
    expect_right(step, body, filter.expected);
    if (testing::Test::HasFailure()) return;
  }
}

}  // namespace
}  // namespace cscd
