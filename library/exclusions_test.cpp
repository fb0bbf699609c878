#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <set>

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
    for (std::size_t v = 0; v < n; ++v) asked.rigid.push_back(random() % 2 == 0);
    out.expected.set_rigid(step.mesh, asked.rigid);
    if (wrong) asked.rigid.flip();
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

// Mutations: a group that no pair names is taken for one of those that pairs name; a group's number is its
// place in the table.
TEST(SelfCollision, TakesGroupsOfAnyNumber) {
  const auto corners = [](int a, int b, int c) { return Triangle{VertexId{a}, VertexId{b}, VertexId{c}}; };
  const std::vector<std::int32_t> group{7, 4096, std::numeric_limits<std::int32_t>::max(), 7, 0, 5000};
  const std::vector<std::pair<std::int32_t, std::int32_t>> pairs{{7, group[2]}, {4096, 4096}};
  const TriangleMesh mesh({corners(0, 1, 2), corners(3, 4, 5)}, 6);
  Exclusions exclusions;
  exclusions.set_groups(mesh, group, pairs);
  for (std::size_t u = 0; u < 6; ++u)
    for (std::size_t v = 0; v < 6; ++v) {
      const auto is = [&](const auto& pair) {
        return std::pair(group[u], group[v]) == pair || std::pair(group[v], group[u]) == pair;
      };
      EXPECT_EQ(exclusions.excludes(VertexId{static_cast<int>(u)}, VertexId{static_cast<int>(v)}),
                std::ranges::any_of(pairs, is));
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

// What lies within an overlap, by what crossings() says: faces on the two sheets of one curve.
struct Within {
  using Faces = std::set<int>;
  const FaceRows& rows;
  std::vector<std::array<Faces, 2>> sheets;  // of each curve
  Within(const SceneStep& step, const SelfCollision::Crossings& crossings) : rows(step.faces) {
    for (const SelfCollision::Crossings::Overlap& overlap : crossings.overlaps) {
      const auto run_through = [&](const std::array<int, 2>& bound) {
        Faces out;
        for (const auto& both : overlap.curves[static_cast<std::size_t>(bound[0])].faces)
          out.insert(both[static_cast<std::size_t>(bound[1])]);
        return out;
      };
      const auto first = static_cast<std::ptrdiff_t>(sheets.size());
      for (int c = 0; c < static_cast<int>(overlap.curves.size()); ++c)
        sheets.push_back({run_through({c, 0}), run_through({c, 1})});
      for (const auto& region : overlap.regions) {
        Faces faces;
        const std::set<int> vertices(region.vertices.begin(), region.vertices.end());
        for (Eigen::Index f = 0; f < step.faces.rows(); ++f)
          for (int k = 0; k < 3; ++k)
            if (vertices.contains(rows(f, k))) faces.insert(static_cast<int>(f));
        for (const auto& bound : region.bounds) faces.merge(run_through(bound));
        for (const auto& bound : region.bounds)
          sheets[static_cast<std::size_t>(first + bound[0])][static_cast<std::size_t>(bound[1])].insert(
              faces.begin(), faces.end());
      }
    }
  }
  template <class OneOf>
  bool face_each_other(const OneOf& a, const OneOf& b) const {
    return std::ranges::any_of(
        sheets, [&](const std::array<Faces, 2>& s) { return (a(s[0]) && b(s[1])) || (a(s[1]) && b(s[0])); });
  }
  bool operator()(const CrossingPair& pair) const {
    const auto is = [](TriangleId t) {
      return [t](const Faces& faces) { return faces.contains(static_cast<int>(t)); };
    };
    return face_each_other<std::function<bool(const Faces&)>>(is(pair.first), is(pair.second));
  }
  bool operator()(const Truth::value_type& contact) const {
    const bool edges = std::get<0>(contact.first);
    const std::array<int, 4>& v = std::get<1>(contact.first);
    const int face = std::get<2>(contact.first);
    const auto with = [&](std::vector<int> corners) {
      return [this, corners](const Faces& faces) {
        return std::ranges::any_of(faces, [&](int f) {
          return std::ranges::all_of(corners, [&](int c) { return (rows.row(f).array() == c).any(); });
        });
      };
    };
    using OneOf = std::function<bool(const Faces&)>;
    if (edges) return face_each_other<OneOf>(with({v[0], v[1]}), with({v[2], v[3]}));
    return face_each_other<OneOf>(with({v[0]}), [face](const Faces& faces) { return faces.contains(face); });
  }
};

// Mutations: an overlap's pieces are the faces of its curves alone; all pieces face each other; those that no
// region bounds are left out; the first contact is looked for among those that a search for the first of all
// came by.
TEST(SelfCollision, LeavesOutWhatLiesInOverlapsOfTheStart) {
  std::size_t old = 0, later = 0, left_to_cross = 0;
  for (std::uint64_t seed = 1; seed <= 2 * intervals(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SceneStep step(seed);
    SelfCollision::Options options;
    options.exclude.ongoing = true;
    SelfCollision body(step.faces, step.start, options);
    const Within within(step, body.crossings(step.start));
    Truth truth = truth_of(step, {});
    const double earliest_of_all =
        truth.empty() ? 1 : std::ranges::min_element(truth, {}, &Truth::value_type::second)->second;
    old += std::erase_if(truth, within);
    Crossings start = EmbeddingTest(step.mesh, step.all_start).find_all(step.all_start, 10'000);
    std::erase_if(start.pairs, within);
    const bool crosses = !start.pairs.empty();
    left_to_cross += crosses;
    const SelfCollision::Answer all = body.all_contacts(step.start, step.end),
                                first = body.first_contact(step.start, step.end);
    EXPECT_EQ(found(all), truth);
    EXPECT_EQ(all.start_crossings.size(), start.pairs.size());
    EXPECT_EQ(first.contacts.empty(), truth.empty());
    EXPECT_EQ(body.is_free(step.start, step.end), truth.empty() && !crosses);
    if (truth.empty()) continue;
    const double earliest = std::ranges::min_element(truth, {}, &Truth::value_type::second)->second;
    later += earliest > earliest_of_all;
    EXPECT_EQ(first.time(), earliest);
    for (const auto& [key, time] : found(first)) {
      EXPECT_EQ(time, earliest);
      EXPECT_TRUE(truth.contains(key));
    }
    const double largest = body.largest_step(step.start, step.end, 1);
    EXPECT_NEAR(largest, crosses ? 0 : earliest, 1e-12);
    EXPECT_LE(largest, earliest);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(old, intervals());
  EXPECT_GT(later, 0u);
  EXPECT_GT(left_to_cross, 0u);
}

// A hooked strip hangs in a box. Its end meets its own shaft there, which is new although both are in the
// box.
TEST(SelfCollision, LeavesInWhatTouchesWithinOnePieceOfAnOverlap) {
  Rows start(18, 3);
  start << 0, -0.3, 2, 0, 0.3, 2, 0, -0.3, 0, 0, 0.3, 0, 0, -0.3, -0.5, 0, 0.3, -0.5, 0.6, -0.3, -0.5, 0.6,
      0.3, -0.5, 0.6, -0.1, 0.3, 0.6, 0.1, 0.35, -1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1, -1, -1, 1, 1, -1,
      1, -1, 1, 1, 1, 1, 1;
  FaceRows faces(20, 3);
  faces << 0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4, 4, 5, 7, 4, 7, 6, 6, 7, 9, 6, 9, 8,  // the strip, and the box
      10, 12, 13, 10, 13, 11, 14, 15, 17, 14, 17, 16, 10, 11, 15, 10, 15, 14, 12, 16, 17, 12, 17, 13, 10, 14,
      16, 10, 16, 12, 11, 13, 17, 11, 17, 15;
  start.col(1).head(10).array() += 0.05;  // so that no edge of the strip meets one of the box
  Rows end = start;
  end.row(8).x() = end.row(9).x() = -0.2;
  SelfCollision::Options options;
  const auto of_strip = [](const SelfCollision::Contact& c) {
    return std::ranges::all_of(c.vertices, [](int v) { return v < 10; });
  };
  SelfCollision plain(faces, start);
  const auto overlaps = plain.crossings(start).overlaps;
  ASSERT_EQ(overlaps.size(), 1u);
  ASSERT_FALSE(overlaps[0].regions.empty());
  options.exclude.ongoing = true;
  SelfCollision body(faces, start, options);
  EXPECT_TRUE(body.is_free(start, start));
  for (const bool slides : {false, true}) {  // the shaft slides out of the box, which is old
    if (slides) end.row(2).z() = end.row(3).z() = 1.2;
    const SelfCollision::Answer all = body.all_contacts(start, end), every = plain.all_contacts(start, end);
    EXPECT_FALSE(all.intersects_at_start());
    EXPECT_GT(all.contacts.size(), 0u);
    EXPECT_TRUE(std::ranges::all_of(all.contacts, of_strip));
    EXPECT_EQ(static_cast<std::ptrdiff_t>(all.contacts.size()),
              std::ranges::count_if(every.contacts, of_strip));
    EXPECT_EQ(every.contacts.size() > all.contacts.size(), slides);
  }
}

TEST(SelfCollision, LeavesNothingOutThatItIsNotToLookFor) {
  const SceneStep step(1);
  SelfCollision::Options options;
  options.exclude.ongoing = true;
  options.check_start = false;
  EXPECT_THROW(SelfCollision(step.faces, step.start, options), std::invalid_argument);
}

}  // namespace
}  // namespace cscd
