#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "core/detect/exclusions.h"
#include "core/detect/start/crossings.h"
#include "core/detect/start/embedding.h"
#include "core/elementary/catalogue.h"
#include "core/fast/drvbc_fast.h"
#include "core/mesh/adjacency.h"
#include "core/session/session.h"
#include "scenes/random/random_interval.h"

#include "cscd/cscd.h"

// Holds every answer of the library to a search of all feature pairs with the exact test, on random steps of
// closed, torn and open surfaces of one and of several pieces. CSCD_RANDOM_INTERVALS sets how many.
namespace cscd {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using FaceRows = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

std::size_t intervals() {
  const char* asked = std::getenv("CSCD_RANDOM_INTERVALS");
  return asked != nullptr ? std::strtoul(asked, nullptr, 10) : 120;
}

Rows rows(std::span<const Vec3> positions) {
  Rows out(static_cast<Eigen::Index>(positions.size()), 3);
  for (std::size_t v = 0; v < positions.size(); ++v) out.row(static_cast<Eigen::Index>(v)) = positions[v];
  return out;
}

FaceRows face_rows(std::span<const Triangle> triangles) {
  FaceRows out(static_cast<Eigen::Index>(triangles.size()), 3);
  for (Eigen::Index f = 0; f < out.rows(); ++f)
    for (int k = 0; k < 3; ++k)
      out(f, k) = static_cast<int>(triangles[static_cast<std::size_t>(f)][static_cast<std::size_t>(k)]);
  return out;
}

// A step of a whole scene. What the object under test is told of it: the first `own` vertices.
struct Step {
  TriangleMesh mesh;
  FaceRows faces;  // of the first vertices alone
  std::vector<Vec3> all_start, all_end;
  Rows start, end;  // of the first vertices alone

  explicit Step(std::uint64_t seed) : Step(scenes_of(seed), nullptr) {}
  // A second surface stands beside the first.
  Step(std::uint64_t seed, std::uint64_t beside, const Vec3& offset)
      : Step(scenes_of(seed), std::make_unique<scenes::RandomInterval>(scenes_of(beside)), offset) {}
  Motion motion() const { return {all_start, all_end}; }
  std::size_t own() const { return static_cast<std::size_t>(start.rows()); }
  Rows beside(const std::vector<Vec3>& pose) const { return rows(std::span(pose).subspan(own())); }

 private:
  static scenes::RandomInterval scenes_of(std::uint64_t seed) {
    return seed % 3 == 0 ? scenes::make_torn_interval(seed) : scenes::make_random_interval(seed);
  }
  static std::vector<Vec3> list(std::span<const Vec3> positions) {
    return {positions.begin(), positions.end()};
  }
  static std::vector<Triangle> together(const scenes::Clip& own, const scenes::RandomInterval* beside) {
    std::vector<Triangle> out = own.header().triangles;
    if (beside == nullptr) return out;
    const auto first = static_cast<std::int32_t>(own.header().vertex_count);
    for (Triangle t : beside->clip.header().triangles) {
      for (VertexId& v : t) v = VertexId{first + static_cast<std::int32_t>(v)};
      out.push_back(t);
    }
    return out;
  }
  Step(const scenes::RandomInterval& own, std::unique_ptr<scenes::RandomInterval> beside,
       const Vec3& offset = Vec3::Zero())
      : mesh(together(own.clip, beside.get()),
             own.clip.header().vertex_count + (beside ? beside->clip.header().vertex_count : 0)),
        faces(face_rows(own.clip.header().triangles)),
        all_start(list(own.clip.frame(0).positions)),
        all_end(list(own.clip.frame(1).positions)),
        start(rows(all_start)),
        end(rows(all_end)) {
    if (!beside) return;
    for (const Vec3& p : beside->clip.frame(0).positions) all_start.push_back(p + offset);
    for (const Vec3& p : beside->clip.frame(1).positions) all_end.push_back(p + offset);
  }
};

using Box = Eigen::AlignedBox3d;

template <class Vertices>
Box box_of(const Motion& motion, const Vertices& vertices) {
  Box box;
  for (const VertexId v : vertices) box.extend(motion.start()[+v]).extend(motion.end()[+v]);
  return box;
}

// Calls take(pair, first box, second box) for every feature pair of the mesh.
template <class Take>
void for_each_feature_pair(const TriangleMesh& mesh, const Motion& motion, const Take& take) {
  std::vector<Box> face, edge, vertex;
  for (const Triangle& t : mesh.triangles()) face.push_back(box_of(motion, t));
  for (const Edge& e : mesh.edges()) edge.push_back(box_of(motion, e));
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    vertex.push_back(box_of(motion, std::array{VertexId{static_cast<std::int32_t>(v)}}));
  for (std::size_t v = 0; v < vertex.size(); ++v) {
    const VertexId id{static_cast<std::int32_t>(v)};
    if (mesh.triangles_at(id).empty()) continue;  // a vertex without a triangle is no feature
    for (std::size_t t = 0; t < face.size(); ++t)
      if (!contains(mesh.triangles()[t], id))
        take(FeaturePair::of(id, TriangleId{static_cast<std::int32_t>(t)}), vertex[v], face[t]);
  }
  for (std::size_t e = 0; e < edge.size(); ++e)
    for (std::size_t f = e + 1; f < edge.size(); ++f)
      if (!share_vertex(mesh.edges()[e], mesh.edges()[f]))
        take(FeaturePair::of(EdgeId{static_cast<std::int32_t>(e)}, EdgeId{static_cast<std::int32_t>(f)}),
             edge[e], edge[f]);
}

std::array<int, 4> vertices_of(const TriangleMesh& mesh, const FeaturePair& pair) {
  std::array<int, 4> out{};
  std::size_t n = 0;
  const auto add = [&](const auto& vertices) {
    for (const VertexId v : vertices) out[n++] = static_cast<int>(v);
  };
  if (pair.kind == FeaturePair::Kind::vertex_face) {
    add(std::array{VertexId{pair.a}});
    add(mesh.corners(TriangleId{pair.b}));
  } else {
    add(mesh.ends(EdgeId{pair.a}));
    add(mesh.ends(EdgeId{pair.b}));
  }
  return out;
}

// A contact as the library names it: edges or not, the vertices, the face.
using Key = std::tuple<bool, std::array<int, 4>, int>;
using Truth = std::map<Key, double>;  // the time of each contact

Truth truth_of(const Step& step, const Exclusions& exclusions) {
  const ElementaryTest& exact = *find_elementary_test("filtered_exact");
  Truth truth;
  for_each_feature_pair(step.mesh, step.motion(), [&](const FeaturePair& pair, const Box& a, const Box& b) {
    if (!a.intersects(b) || exclusions.excludes(step.mesh, pair)) return;
    if (std::ranges::all_of(carriers(step.mesh, pair), [&](const CrossingPair& triangles) {
          return exclusions.excludes(step.mesh, TrianglePair{triangles.first, triangles.second});
        }))
      return;
    const cscd::Answer answer = ask(exact, step.mesh, step.motion(), pair);
    const bool edges = pair.kind == FeaturePair::Kind::edge_edge;
    if (answer.verdict == Verdict::contact)
      truth.emplace(Key{edges, vertices_of(step.mesh, pair), edges ? -1 : pair.b}, answer.time);
  });
  return truth;
}

Truth found(const SelfCollision::Answer& answer) {
  Truth out;
  for (const SelfCollision::Contact& c : answer.contacts)
    out.emplace(Key{c.edges, c.vertices, c.face}, c.time);
  return out;
}

// Every promise of the library about one step.
void expect_right(const Step& step, SelfCollision& body, const Exclusions& exclusions) {
  const Truth truth = truth_of(step, exclusions);
  Crossings crossings = EmbeddingTest(step.mesh, step.motion().start())
                            .find_all(step.motion().start(), step.mesh.triangle_count() * 100);
  std::erase_if(crossings.pairs, [&](const CrossingPair& pair) {
    return exclusions.excludes(step.mesh, TrianglePair{pair.first, pair.second});
  });
  const bool crosses = !crossings.pairs.empty();
  EXPECT_EQ(body.is_free(step.start, step.end), truth.empty() && !crosses);

  const SelfCollision::Answer all = body.all_contacts(step.start, step.end);
  EXPECT_EQ(found(all), truth);
  ASSERT_EQ(all.start_crossings.size(), crossings.pairs.size());
  for (std::size_t i = 0; i < crossings.pairs.size(); ++i) {
    EXPECT_EQ(all.start_crossings[i][0], static_cast<int>(crossings.pairs[i].first));
    EXPECT_EQ(all.start_crossings[i][1], static_cast<int>(crossings.pairs[i].second));
  }
  const auto earliest =
      std::ranges::min_element(truth, {}, [](const Truth::value_type& contact) { return contact.second; });
  const SelfCollision::Answer first = body.first_contact(step.start, step.end);
  ASSERT_EQ(first.contacts.empty(), truth.empty());
  for (const SelfCollision::Contact& contact : first.contacts) {
    EXPECT_EQ(contact.time, earliest->second);
    EXPECT_TRUE(truth.contains({contact.edges, contact.vertices, contact.face}));
  }
  for (const double safety : {0.5, 1.0}) {
    const double step_size = body.largest_step(step.start, step.end, safety);
    if (crosses) {
      EXPECT_EQ(step_size, 0);
    } else if (truth.empty()) {
      EXPECT_EQ(step_size, 1);
    } else {
      EXPECT_LE(step_size, safety * earliest->second);
      EXPECT_GE(step_size, std::max(0.0, safety * (earliest->second - 1e-12)));
    }
  }
}

TEST(SelfCollision, AnswersRandomStepsAsASearchOfAllFeaturePairsDoes) {
  std::size_t free = 0, crossing = 0;
  for (std::uint64_t seed = 1; seed <= intervals(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Step step(seed);
    SelfCollision body(step.faces, step.start);
    EXPECT_EQ(body.closed(), step.mesh.closed_and_oriented());
    expect_right(step, body, {});
    const SelfCollision::Answer answer = body.first_contact(step.start, step.end);
    free += answer.free();
    crossing += answer.intersects_at_start();
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(free, intervals() / 20);
  EXPECT_GT(crossing, intervals() / 20);
}

// What is left out, as the library is told and as the search of all pairs is told.
struct Filter {
  SelfCollision::Exclusions asked;
  Exclusions expected;
};
constexpr std::uint64_t kFilters = 6;  // kinds

// A filter of one kind. A wrong one tells the library something else in one place.
Filter filter_of(std::uint64_t kind, const Step& step, bool wrong = false) {
  const std::size_t n = step.mesh.vertex_count(), m = step.mesh.triangle_count();
  std::mt19937 random(static_cast<unsigned>(17 * n + m));
  const auto some = [&](std::size_t count) { return static_cast<int>(random() % count); };
  Filter out;
  SelfCollision::Exclusions& asked = out.asked;
  if (kind == 0) {
    for (std::size_t v = 0; v < n; ++v) asked.obstacle.push_back(random() % 2 == 0);
    out.expected.set_obstacles(step.mesh, asked.obstacle);
    if (wrong) asked.obstacle.flip();
  } else if (kind == 1) {
    for (std::size_t v = 0; v < n; ++v) asked.group.push_back(v < n / 2 ? 0 : 1);
    asked.groups_that_ignore_each_other = {{0, some(2)}};
    out.expected.set_groups(step.mesh, asked.group, asked.groups_that_ignore_each_other);
    if (wrong) asked.groups_that_ignore_each_other = {{1, 1}};
  } else if (kind == 2) {
    asked.rings = wrong ? 2 : 3;
    out.expected.exclude_rings(step.mesh, 3);
  } else if (kind == 3) {
    asked.rest_distance = wrong ? 0.5 : 1;
    out.expected.exclude_near(step.all_start, 1);
  } else if (kind == 4) {
    std::vector<std::pair<VertexId, VertexId>> pairs;
    for (std::size_t i = 0; i < n * n / 2; ++i) {
      asked.vertex_pairs.emplace_back(some(n), some(n));
      pairs.emplace_back(VertexId{asked.vertex_pairs.back().first},
                         VertexId{asked.vertex_pairs.back().second});
    }
    out.expected.exclude(step.mesh, pairs);
    if (wrong) asked.vertex_pairs.resize(asked.vertex_pairs.size() / 2);
  } else {
    std::vector<std::pair<TriangleId, TriangleId>> pairs;
    for (std::size_t i = 0; i < m * m / 2; ++i) {
      asked.face_pairs.emplace_back(some(m), some(m));
      pairs.emplace_back(TriangleId{asked.face_pairs.back().first},
                         TriangleId{asked.face_pairs.back().second});
    }
    out.expected.exclude(step.mesh, pairs);
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
    const Step step(seed);
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
      const Step step(seed);
      const Filter filter = filter_of(kind, step, true);
      SelfCollision::Options options;
      options.exclude = filter.asked;
      seen += found(SelfCollision(step.faces, step.start, options).all_contacts(step.start, step.end)) !=
              truth_of(step, filter.expected);
    }
    EXPECT_GT(seen, 0u) << "kind " << kind;
  }
}

// The second surface of the step as an obstacle that moves.
SelfCollision::Obstacle obstacle_of(const Step& step, const Rows& where) {
  std::vector<Triangle> triangles;
  for (Triangle t : step.mesh.triangles().subspan(static_cast<std::size_t>(step.faces.rows()))) {
    for (VertexId& v : t) v = VertexId{static_cast<std::int32_t>(static_cast<std::size_t>(v) - step.own())};
    triangles.push_back(t);
  }
  return {face_rows(triangles), where};
}
// The seed's surface, and beside it that of another seed, which is at rest every second time.
Step beside(std::uint64_t seed) {
  Step step(seed, 7 * seed + 2, Vec3(0.3 * static_cast<double>(seed % 7) - 1, 0.4, 0.2));
  if (seed % 2 == 0)
    std::copy(step.all_start.begin() + static_cast<std::ptrdiff_t>(step.own()), step.all_start.end(),
              step.all_end.begin() + static_cast<std::ptrdiff_t>(step.own()));
  return step;
}
Exclusions obstacle_against_obstacle(const Step& step) {
  std::vector<bool> obstacle(step.mesh.vertex_count(), false);
  std::fill(obstacle.begin() + static_cast<std::ptrdiff_t>(step.own()), obstacle.end(), true);
  Exclusions out;
  out.set_obstacles(step.mesh, obstacle);
  return out;
}

// Mutations: obstacles are held against themselves; the bounds of an obstacle are those of the step before;
// a step that starts elsewhere is taken to start free; triangles of obstacles are numbered from 0.
TEST(SelfCollision, HoldsTheMeshAgainstObstacles) {
  std::size_t touching = 0, crossing = 0, apart = 0;
  for (std::uint64_t seed = 1; seed <= intervals(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Step step = beside(seed);
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

// Filters name vertices and faces of obstacles behind those of the mesh.
TEST(SelfCollision, LeavesOutWhatIsExcludedOfObstacles) {
  for (std::uint64_t seed = 1; seed <= intervals() / 2; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Step step = beside(seed);
    const Rows before = step.beside(step.all_start), after = step.beside(step.all_end);
    Filter filter = filter_of(1 + seed % (kFilters - 1), step);
    std::vector<bool> obstacle(step.mesh.vertex_count(), false);
    std::fill(obstacle.begin() + static_cast<std::ptrdiff_t>(step.own()), obstacle.end(), true);
    filter.expected.set_obstacles(step.mesh, obstacle);
    SelfCollision::Options options;
    options.obstacles.push_back(obstacle_of(step, before));
    options.exclude = filter.asked;
    SelfCollision body(step.faces, step.start, options);
    body.move_obstacle(0, before, after);
    expect_right(step, body, filter.expected);
    if (testing::Test::HasFailure()) return;
  }
}

// An obstacle that stands a little elsewhere than the library is told gives other answers.
TEST(SelfCollision, SeesAnObstacleThatIsMisplaced) {
  std::size_t seen = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const Step step = beside(seed);
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
    const Step step = beside(seed);
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

// With a radius, candidates are exactly the feature pairs whose boxes are near enough, found here from all
// pairs; without, they are some of these, and all that touch. Mutation: a radius of 0 takes what touches
// last.
TEST(SelfCollision, GivesAllCandidates) {
  std::size_t seen = 0, fewer = 0;
  for (std::uint64_t seed = 1; seed <= intervals() / 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Step step = seed % 2 == 0 ? Step(seed) : beside(seed);
    const bool obstacle = step.own() < step.mesh.vertex_count();
    const Exclusions exclusions = obstacle ? obstacle_against_obstacle(step) : Exclusions();
    SelfCollision::Options options;
    if (obstacle) options.obstacles.push_back(obstacle_of(step, step.beside(step.all_start)));
    SelfCollision body(step.faces, step.start, options);
    if (obstacle) body.move_obstacle(0, step.beside(step.all_start), step.beside(step.all_end));
    for (const double radius : {0.0, 0.05, 0.5}) {
      std::set<std::array<int, 4>> edge_edge;
      std::set<std::array<int, 2>> vertex_face;
      for_each_feature_pair(
          step.mesh, step.motion(), [&](const FeaturePair& pair, const Box& a, const Box& b) {
            if (((a.min() - b.max()).array() > radius).any() || ((b.min() - a.max()).array() > radius).any())
              return;
            if (exclusions.excludes(step.mesh, pair)) return;
            if (pair.kind == FeaturePair::Kind::vertex_face)
              vertex_face.insert({pair.a, pair.b});
            else
              edge_edge.insert(vertices_of(step.mesh, pair));
          });
      const SelfCollision::Candidates got = body.candidates(step.start, step.end, radius);
      const std::set got_vertex_face(got.vertex_face.begin(), got.vertex_face.end());
      const std::set got_edge_edge(got.edge_edge.begin(), got.edge_edge.end());
      EXPECT_EQ(got.vertex_face.size(), got_vertex_face.size()) << "each pair once";
      EXPECT_EQ(got.edge_edge.size(), got_edge_edge.size());
      seen += got.vertex_face.size();
      if (radius > 0) {
        EXPECT_EQ(got_vertex_face, vertex_face);
        EXPECT_EQ(got_edge_edge, edge_edge);
        continue;
      }
      EXPECT_TRUE(std::ranges::includes(vertex_face, got_vertex_face));
      EXPECT_TRUE(std::ranges::includes(edge_edge, got_edge_edge));
      fewer += got_edge_edge.size() < edge_edge.size();
      for (const auto& [key, time] : truth_of(step, exclusions)) {
        const auto& [edges, vertices, face] = key;
        EXPECT_TRUE(edges ? got_edge_edge.contains(vertices) : got_vertex_face.contains({vertices[0], face}));
      }
    }
  }
  EXPECT_GT(seen, 1000u);
  EXPECT_GT(fewer, intervals() / 8);
}

// One object that answers many steps, in any order, gives the answers of fresh objects.
TEST(SelfCollision, RemembersNothingThatChangesAnAnswer) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Step step(seed);
    SelfCollision body(step.faces, step.start);
    const Rows middle = 0.5 * (step.start + step.end);
    const Rows* way[] = {&step.start, &middle, &step.end, &step.start, &step.end, &middle, &step.start};
    for (std::size_t i = 0; i + 1 < std::size(way); ++i) {
      SelfCollision fresh(step.faces, step.start);
      const SelfCollision::Answer got = body.all_contacts(*way[i], *way[i + 1]);
      const SelfCollision::Answer expected = fresh.all_contacts(*way[i], *way[i + 1]);
      EXPECT_EQ(found(got), found(expected)) << seed << ", " << i;
      EXPECT_EQ(got.start_crossings, expected.start_crossings) << seed << ", " << i;
      EXPECT_EQ(body.first_contact(*way[i], *way[i + 1]).time(), expected.time()) << seed << ", " << i;
    }
  }
}

// Sessions on several threads over one const mesh answer as each would alone.
TEST(SelfCollision, SessionsOnSeveralThreadsShareOneMesh) {
  const ElementaryTest& exact = *find_elementary_test("filtered_exact");
  const auto make = [](const cscd::Setup& setup) {
    return make_drvbc_fast(setup, {.name = "drvbc_fast_complete", .complete = true});
  };
  const Strategy complete{"drvbc_fast_complete", "", Guarantee::complete, {}, make};
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Step step(seed);
    const cscd::Setup setup{step.mesh, step.all_start, nullptr, exact};
    const auto answers = [&] {
      Session session("mesh", setup, complete, complete, step.all_start, {.keep_rest_crossings = true});
      std::vector<std::string> out;
      StepAnswer answer;
      for (int i = 0; i < 20; ++i) {
        session.step(i % 2 == 0 ? step.motion() : Motion(step.all_end, step.all_start), nullptr, answer);
        out.push_back(digest(answer.found) + std::to_string(answer.start.total));
      }
      return out;
    };
    const std::vector<std::string> expected = answers();
    std::vector<std::vector<std::string>> got(4);
    std::vector<std::thread> threads;
    for (auto& one : got) threads.emplace_back([&one, &answers] { one = answers(); });
    for (std::thread& thread : threads) thread.join();
    for (const auto& one : got) EXPECT_EQ(one, expected);
  }
}

// Triangles are added and removed by preparing the object anew.
TEST(SelfCollision, IsPreparedAnewForOtherTriangles) {
  const Step step(2);
  SelfCollision body(step.faces, step.start);
  for (const Eigen::Index left : {step.faces.rows() - 1, step.faces.rows() / 2, step.faces.rows()}) {
    body = SelfCollision(step.faces.topRows(left), step.start);
    SelfCollision fresh(step.faces.topRows(left), step.start);
    EXPECT_EQ(body.face_count(), static_cast<std::size_t>(left));
    EXPECT_EQ(found(body.all_contacts(step.start, step.end)),
              found(fresh.all_contacts(step.start, step.end)));
  }
  EXPECT_EQ(found(body.all_contacts(step.start, step.end)), truth_of(step, {}));
}

TEST(SelfCollision, SaysWhatIsWrongWithItsInput) {
  FaceRows faces(1, 3);
  faces << 0, 1, 2;
  const Rows triangle = Rows::Identity(3, 3);
  const auto message = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  FaceRows wrong = faces;
  wrong(0, 2) = 3;
  EXPECT_TRUE(has(message([&] { SelfCollision(wrong, triangle); }), "3"));
  Rows nan = triangle;
  nan(1, 1) = std::nan("");
  EXPECT_TRUE(has(message([&] { SelfCollision(faces, nan); }), "reference positions"));
  SelfCollision body(faces, triangle);
  EXPECT_TRUE(has(message([&] { body.is_free(nan, triangle); }), "start positions"));
  EXPECT_TRUE(has(message([&] { body.is_free(triangle, Rows::Zero(4, 3)); }), "4 rows for 3 vertices"));
  EXPECT_TRUE(has(message([&] { body.largest_step(triangle, triangle, 0); }), "safety"));
  EXPECT_TRUE(has(message([&] { body.candidates(triangle, triangle, -1); }), "radius"));
  SelfCollision::Options options;
  options.threads = 0;
  EXPECT_TRUE(has(message([&] { SelfCollision(faces, triangle, options); }), "threads"));
  options = {};
  options.exclude.vertex_pairs = {{0, 7}};
  EXPECT_TRUE(has(message([&] { SelfCollision(faces, triangle, options); }), "vertex 7"));
  options = {};
  options.exclude.group = {0, 1};
  EXPECT_TRUE(has(message([&] { SelfCollision(faces, triangle, options); }), "2 entries for 3 vertices"));
  EXPECT_TRUE(body.is_free(triangle, triangle)) << "an object outlives wrong calls";
  // Also from where a step ended that is known to be free, where positions are checked in another way.
  EXPECT_TRUE(has(message([&] { body.is_free(triangle, nan); }), "end positions: vertex 1"));
  EXPECT_TRUE(body.is_free(triangle, triangle));
  EXPECT_TRUE(has(message([&] { body.place_obstacle(0, triangle); }), "obstacle 0: there are 0"));
  options = {};
  options.obstacles = {{faces, Rows(triangle.array() + 5)}, {wrong, triangle}};
  EXPECT_TRUE(has(message([&] { SelfCollision(faces, triangle, options); }), "obstacle 1, faces"));
  options.obstacles.pop_back();
  SelfCollision beside(faces, triangle, options);
  EXPECT_TRUE(has(message([&] { beside.move_obstacle(0, triangle, nan); }), "obstacle 0, end positions"));
  EXPECT_TRUE(has(message([&] { beside.place_obstacle(0, Rows::Zero(4, 3)); }), "4 rows for 3 vertices"));
  EXPECT_TRUE(has(message([&] { beside.candidates(triangle, nan, 1); }), "end positions"));
  EXPECT_TRUE(beside.is_free(triangle, triangle));
}

}  // namespace
}  // namespace cscd
