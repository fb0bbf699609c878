#pragma once

// For tests only: random steps of closed, torn and open surfaces of one and of several pieces, and what is
// true of them by a search of all feature pairs with the exact test.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <gtest/gtest.h>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "core/detect/exclusions.h"
#include "core/detect/start/crossings.h"
#include "core/detect/start/embedding.h"
#include "core/detect/test_feature_pairs.h"
#include "core/elementary/catalogue.h"
#include "scenes/random/random_interval.h"

#include "cscd/cscd.h"

namespace cscd::test {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using FaceRows = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

// The number of random steps of a test. CSCD_RANDOM_INTERVALS sets it.
inline std::size_t intervals() {
  const char* asked = std::getenv("CSCD_RANDOM_INTERVALS");
  return asked != nullptr ? std::strtoul(asked, nullptr, 10) : 120;
}

inline Rows rows(std::span<const Vec3> positions) {
  Rows out(static_cast<Eigen::Index>(positions.size()), 3);
  for (std::size_t v = 0; v < positions.size(); ++v) out.row(static_cast<Eigen::Index>(v)) = positions[v];
  return out;
}

inline FaceRows face_rows(std::span<const Triangle> triangles) {
  FaceRows out(static_cast<Eigen::Index>(triangles.size()), 3);
  for (Eigen::Index f = 0; f < out.rows(); ++f)
    for (int k = 0; k < 3; ++k)
      out(f, k) = static_cast<int>(triangles[static_cast<std::size_t>(f)][static_cast<std::size_t>(k)]);
  return out;
}

// A step of a whole scene: of a surface, and of a second one beside it if there is one. The object under test
// takes the first surface as its mesh, and the second one as an obstacle. Every fourth surface has loose
// vertices, which are of no face.
struct SceneStep {
  TriangleMesh mesh;  // both surfaces
  FaceRows faces;     // of the first surface alone
  std::vector<Vec3> all_start, all_end;
  Rows start, end;  // of the first surface alone

  explicit SceneStep(std::uint64_t seed) : SceneStep(seed, scenes_of(seed), nullptr) {}
  // A second surface stands beside the first.
  SceneStep(std::uint64_t seed, std::uint64_t beside, const Vec3& offset)
      : SceneStep(seed, scenes_of(seed), std::make_unique<scenes::RandomInterval>(scenes_of(beside)),
                  offset) {}
  Motion motion() const { return {all_start, all_end}; }
  // The number of vertices of the first surface.
  std::size_t own() const { return static_cast<std::size_t>(start.rows()); }
  // Returns the positions of the second surface in a pose of both.
  Rows beside(const std::vector<Vec3>& pose) const { return rows(std::span(pose).subspan(own())); }

 private:
  static scenes::RandomInterval scenes_of(std::uint64_t seed) {
    return seed % 3 == 0 ? scenes::make_torn_interval(seed) : scenes::make_random_interval(seed);
  }
  static std::size_t loose_of(std::uint64_t seed) { return seed % 4 == 1 ? 12 : 0; }
  // Positions with as many loose ones behind them, each somewhere between two vertices.
  static std::vector<Vec3> with_loose(std::span<const Vec3> positions, std::size_t count,
                                      std::uint64_t seed) {
    std::vector<Vec3> out(positions.begin(), positions.end());
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> share(-0.2, 1.2);
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 &a = positions[random() % positions.size()], &b = positions[random() % positions.size()];
      out.push_back(a + share(random) * (b - a));
    }
    return out;
  }
  static std::vector<Triangle> together(const scenes::Clip& own, std::size_t loose,
                                        const scenes::RandomInterval* beside) {
    std::vector<Triangle> out = own.header().triangles;
    if (beside == nullptr) return out;
    const auto first = static_cast<std::int32_t>(own.header().vertex_count + loose);
    for (Triangle t : beside->clip.header().triangles) {
      for (VertexId& v : t) v = VertexId{first + static_cast<std::int32_t>(v)};
      out.push_back(t);
    }
    return out;
  }
  SceneStep(std::uint64_t seed, const scenes::RandomInterval& own,
            std::unique_ptr<scenes::RandomInterval> beside, const Vec3& offset = Vec3::Zero())
      : mesh(together(own.clip, loose_of(seed), beside.get()),
             own.clip.header().vertex_count + loose_of(seed) +
                 (beside ? beside->clip.header().vertex_count : 0)),
        faces(face_rows(own.clip.header().triangles)),
        all_start(with_loose(own.clip.frame(0).positions, loose_of(seed), seed)),
        all_end(with_loose(own.clip.frame(1).positions, loose_of(seed), seed + (seed % 8 == 1))),
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
  for (const FeaturePair& pair : all_feature_pairs(mesh)) {
    const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
    const bool edges = pair.kind == FeaturePair::Kind::edge_edge;
    take(pair, edges ? edge[a] : vertex[a], edges ? edge[b] : face[b]);
  }
}

// Returns the vertices of the first feature and then those of the second.
inline std::array<int, 4> indices_of(const TriangleMesh& mesh, const FeaturePair& pair) {
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

// Returns all contacts that are not excluded, found among all feature pairs with the exact test.
inline Truth truth_of(const SceneStep& step, const Exclusions& exclusions, const Thickness& thickness = {}) {
  const ElementaryTest& exact = *find_elementary_test("filtered_exact");
  Truth truth;
  for_each_feature_pair(step.mesh, step.motion(), [&](const FeaturePair& pair, const Box& a, const Box& b) {
    const double thick = thickness.of(step.mesh, pair);
    if (a.exteriorDistance(b) > thick * (1 + 1e-12) || exclusions.excludes(step.mesh, pair)) return;
    const std::vector<CrossingPair> carried_by = carriers(step.mesh, pair);
    if (!carried_by.empty() && std::ranges::all_of(carried_by, [&](const CrossingPair& triangles) {
          return exclusions.excludes(step.mesh, TrianglePair{triangles.first, triangles.second});
        }))
      return;
    const cscd::Answer answer = ask_close(exact, step.mesh, step.motion(), pair, thick);
    const bool edges = pair.kind == FeaturePair::Kind::edge_edge;
    if (answer.verdict == Verdict::contact)
      truth.emplace(Key{edges, indices_of(step.mesh, pair), edges ? -1 : pair.b}, answer.time);
  });
  return truth;
}

inline Truth found(const SelfCollision::Answer& answer) {
  Truth out;
  for (const SelfCollision::Contact& c : answer.contacts)
    out.emplace(Key{c.edges, c.vertices, c.face}, c.time);
  return out;
}

// Holds every promise of the library about one step to the search of all feature pairs.
inline void expect_right(const SceneStep& step, SelfCollision& body, const Exclusions& exclusions,
                         const Thickness& thickness = {}) {
  const Truth truth = truth_of(step, exclusions, thickness);
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
  const auto at_start = static_cast<std::size_t>(
      std::ranges::count_if(truth, [](const auto& contact) { return contact.second == 0; }));
  EXPECT_EQ(all.close_at_start(), at_start);
  const auto earliest =
      std::ranges::min_element(truth, {}, [](const Truth::value_type& contact) { return contact.second; });
  const SelfCollision::Answer first = body.first_contact(step.start, step.end);
  ASSERT_EQ(first.contacts.empty(), truth.empty());
  EXPECT_EQ(first.close_at_start(), at_start);
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

// Returns the second surface of the step as an obstacle that stands at `where`.
inline SelfCollision::Obstacle obstacle_of(const SceneStep& step, const Rows& where) {
  std::vector<Triangle> triangles;
  for (Triangle t : step.mesh.triangles().subspan(static_cast<std::size_t>(step.faces.rows()))) {
    for (VertexId& v : t) v = VertexId{static_cast<std::int32_t>(static_cast<std::size_t>(v) - step.own())};
    triangles.push_back(t);
  }
  return {face_rows(triangles), where};
}
// The seed's surface, and beside it that of another seed, which is at rest every second time.
inline SceneStep beside(std::uint64_t seed) {
  SceneStep step(seed, 7 * seed + 2, Vec3(0.3 * static_cast<double>(seed % 7) - 1, 0.4, 0.2));
  if (seed % 2 == 0)
    std::copy(step.all_start.begin() + static_cast<std::ptrdiff_t>(step.own()), step.all_start.end(),
              step.all_end.begin() + static_cast<std::ptrdiff_t>(step.own()));
  return step;
}
// Excludes the pairs of two features of the second surface.
inline void exclude_obstacle_against_obstacle(const SceneStep& step, Exclusions& out) {
  std::vector<bool> obstacle(step.mesh.vertex_count(), false);
  std::fill(obstacle.begin() + static_cast<std::ptrdiff_t>(step.own()), obstacle.end(), true);
  out.set_rigid(step.mesh, obstacle);
}
inline Exclusions obstacle_against_obstacle(const SceneStep& step) {
  Exclusions out;
  exclude_obstacle_against_obstacle(step, out);
  return out;
}

}  // namespace cscd::test
