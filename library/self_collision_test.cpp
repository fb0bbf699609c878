#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <set>

#include "core/detect/exclusions.h"
#include "core/detect/start/embedding.h"
#include "core/elementary/catalogue.h"
#include "core/mesh/adjacency.h"
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

struct Step {
  scenes::RandomInterval random;
  TriangleMesh mesh;
  FaceRows faces;
  Rows start, end;

  explicit Step(std::uint64_t seed)
      : random(seed % 3 == 0 ? scenes::make_torn_interval(seed) : scenes::make_random_interval(seed)),
        mesh(random.clip.header().triangles, random.clip.header().vertex_count),
        faces(static_cast<Eigen::Index>(mesh.triangle_count()), 3),
        start(rows(random.clip.frame(0).positions)),
        end(rows(random.clip.frame(1).positions)) {
    for (Eigen::Index f = 0; f < faces.rows(); ++f)
      for (int k = 0; k < 3; ++k)
        faces(f, k) =
            static_cast<int>(mesh.triangles()[static_cast<std::size_t>(f)][static_cast<std::size_t>(k)]);
  }
  Motion motion() const { return {random.clip.frame(0).positions, random.clip.frame(1).positions}; }
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

// Mutations: a pair of features is excluded by one pair of vertices; excluded contacts are followed.
TEST(SelfCollision, LeavesOutWhatIsExcluded) {
  std::size_t left_out = 0, left = 0;
  for (std::uint64_t seed = 1; seed <= intervals(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Step step(seed);
    const std::size_t n = step.mesh.vertex_count();
    std::mt19937 random(static_cast<unsigned>(seed));
    SelfCollision::Options options;
    SelfCollision::Exclusions& asked = options.exclude;
    Exclusions expected;
    if (seed % 5 == 0) {
      for (std::size_t v = 0; v < n; ++v) asked.obstacle.push_back(random() % 2 == 0);
      expected.set_obstacles(step.mesh, asked.obstacle);
    }
    if (seed % 5 == 1) {
      for (std::size_t v = 0; v < n; ++v) asked.group.push_back(v < n / 2 ? 0 : 1);
      asked.groups_that_ignore_each_other = {{0, seed % 2 == 0 ? 0 : 1}};
      expected.set_groups(step.mesh, asked.group, asked.groups_that_ignore_each_other);
    }
    if (seed % 5 == 2) {
      asked.rings = 3;
      expected.exclude_rings(step.mesh, 3);
    }
    if (seed % 5 == 3) {
      asked.rest_distance = 0.3;
      expected.exclude_near(step.motion().start(), 0.3);
    }
    if (seed % 5 == 4) {
      std::vector<std::pair<VertexId, VertexId>> pairs;
      for (std::size_t i = 0; i < n * n / 2; ++i) {
        asked.vertex_pairs.emplace_back(static_cast<int>(random() % n), static_cast<int>(random() % n));
        pairs.emplace_back(VertexId{asked.vertex_pairs.back().first},
                           VertexId{asked.vertex_pairs.back().second});
      }
      expected.exclude(step.mesh, pairs);
    }
    SelfCollision body(step.faces, step.start, options);
    expect_right(step, body, expected);
    const std::size_t kept = truth_of(step, expected).size();
    left += kept;
    left_out += truth_of(step, {}).size() - kept;
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(left_out, intervals());
  EXPECT_GT(left, intervals());
}

// Candidates are exactly the feature pairs whose boxes are near enough, found here from all pairs.
TEST(SelfCollision, GivesAllCandidates) {
  std::size_t seen = 0;
  for (std::uint64_t seed = 1; seed <= intervals() / 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Step step(seed);
    SelfCollision body(step.faces, step.start);
    for (const double radius : {0.0, 0.05, 0.5}) {
      std::set<std::array<int, 4>> edge_edge;
      std::set<std::array<int, 2>> vertex_face;
      for_each_feature_pair(
          step.mesh, step.motion(), [&](const FeaturePair& pair, const Box& a, const Box& b) {
            if (((a.min() - b.max()).array() > radius).any() || ((b.min() - a.max()).array() > radius).any())
              return;
            if (pair.kind == FeaturePair::Kind::vertex_face)
              vertex_face.insert({pair.a, pair.b});
            else
              edge_edge.insert(vertices_of(step.mesh, pair));
          });
      const SelfCollision::Candidates got = body.candidates(step.start, step.end, radius);
      EXPECT_EQ(std::set(got.vertex_face.begin(), got.vertex_face.end()), vertex_face);
      EXPECT_EQ(std::set(got.edge_edge.begin(), got.edge_edge.end()), edge_edge);
      EXPECT_EQ(got.vertex_face.size(), vertex_face.size()) << "each pair once";
      EXPECT_EQ(got.edge_edge.size(), edge_edge.size());
      seen += got.vertex_face.size();
    }
  }
  EXPECT_GT(seen, 1000u);
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
}

}  // namespace
}  // namespace cscd
