#include <cmath>
#include <gtest/gtest.h>
#include <iostream>
#include <random>
#include <set>

#include "core/geometry/feature_distance.h"
#include "core/geometry/nearest_points.h"
#include "library/test_steps.h"

// Moves random surfaces within their bounds, and holds what comes near to the exact test.
namespace cscd {
namespace {

using namespace test;

// A pose of a surface, with a thickness below or above its least distance, and its bounds.
struct Bounded {
  SceneStep step;
  SelfCollision::Options options;
  Exclusions exclusions;
  double cap;
  double rounding = 1e-12;  // of a position that moves, with room to spare
  std::unique_ptr<SelfCollision> body;
  std::vector<double> bounds;

  explicit Bounded(std::uint64_t seed) : step(seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    options.thickness = seed % 4 == 0 ? 0 : 0.1 * std::pow(share(random), 4);
    if (seed % 4 == 3)
      for (std::size_t v = 0; v < step.own(); ++v) options.vertex_thickness.push_back(0.01 * share(random));
    if (seed % 5 == 2) {
      options.exclude.rings = 1;
      exclusions.exclude_rings(step.mesh, 1);
    }
    cap = seed % 3 == 0 ? 0.05 : 0.5;
    body = std::make_unique<SelfCollision>(step.faces, step.start, options);
    bounds = body->vertex_bounds(step.start, cap);
    for (const Vec3& p : step.all_start) rounding = std::max(rounding, 1e-15 * p.norm());
  }
  Thickness thickness() const { return Thickness(options.thickness, options.vertex_thickness); }
  std::set<Key> close_at(const Rows& pose) const {
    std::set<Key> out;
    for (const auto& [key, time] : found(body->all_contacts(pose, pose))) out.insert(key);
    return out;
  }
};

Vec3 direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Vec3 out;
  do out = Vec3(normal(random), normal(random), normal(random));
  while (!(out.norm() > 0.1));
  return out.normalized();
}

// A polygon of a few pieces for each vertex, which bends within `share` of its bound. Balls are convex, so a
// piece leaves none that holds its ends. Room is left for the rounding of sums.
std::vector<Rows> paths(const Bounded& bounded, double share, std::mt19937_64& random) {
  constexpr int kPieces = 4;
  std::vector<Rows> out(kPieces + 1, bounded.step.start);
  std::uniform_real_distribution<double> length(0, 1);
  for (std::size_t v = 0; v < bounded.bounds.size(); ++v) {
    const double bound = std::max(0.0, share * bounded.bounds[v] - bounded.rounding);
    for (std::size_t piece = 1; piece < out.size(); ++piece)
      out[piece].row(static_cast<Eigen::Index>(v)) +=
          bound * (piece % 2 == 1 ? 1 : length(random)) * direction(random).transpose();
  }
  return out;
}
// Two features move towards each other as far as their vertices may, and the others as they like.
Rows towards_each_other(const Bounded& bounded, double share, std::mt19937_64& random) {
  Rows end = paths(bounded, share, random)[1];
  const SceneStep& step = bounded.step;
  const SelfCollision::Candidates near = bounded.body->candidates(step.start, step.start, 2 * bounded.cap);
  if (near.edge_edge.empty() || near.vertex_face.empty()) return end;
  std::array<int, 4> vertices = near.edge_edge[random() % near.edge_edge.size()];
  const bool edges = random() % 2 == 0;
  if (!edges) {
    const auto [v, f] = near.vertex_face[random() % near.vertex_face.size()];
    vertices = {v, step.faces(f, 0), step.faces(f, 1), step.faces(f, 2)};
  }
  std::array<Vec3, 4> at;
  for (std::size_t i = 0; i < 4; ++i) at[i] = step.start.row(vertices[i]);
  const Vec3 way = (edges ? nearest_of_edges(at) : nearest_of_vertex_face(at)).way;
  if (!(way.norm() > 0)) return end;
  for (std::size_t i = 0; i < 4; ++i) {
    const double bound =
        std::max(0.0, share * bounded.bounds[static_cast<std::size_t>(vertices[i])] - bounded.rounding);
    end.row(vertices[i]) = at[i] + (i < (edges ? 2u : 1u) ? -bound : bound) * way.normalized();
  }
  return end;
}

// Returns whether every pair that is not close in the pose stays so along a way.
bool stays_apart(const Bounded& bounded, const std::vector<Rows>& way, const std::set<Key>& close) {
  for (std::size_t i = 0; i + 1 < way.size(); ++i)
    for (const auto& [key, time] : found(bounded.body->all_contacts(way[i], way[i + 1])))
      if (!close.contains(key)) return false;
  return true;
}

// Mutations: a bound is the distance and not half of it; the thickness is not subtracted; one vertex takes
// what its neighbours have not used, without saying so; the search does not reach to twice the cap.
TEST(VertexBounds, NothingComesCloserWhateverMovesWithinThem) {
  std::size_t motions = 0, free_poses = 0, bounded_by_cap = 0, zero = 0;
  const std::size_t wanted = intervals() == 120 ? 400 : 10'000;
  for (std::uint64_t seed = 1; motions < wanted; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Bounded bounded(seed);
    const std::set<Key> close = bounded.close_at(bounded.step.start);
    free_poses += close.empty();
    for (const double bound : bounded.bounds) {
      ASSERT_TRUE(bound >= 0 && bound <= bounded.cap);
      bounded_by_cap += bound == bounded.cap, zero += bound == 0;
    }
    EXPECT_EQ(bounded.bounds, bounded.body->vertex_bounds(bounded.step.start, bounded.cap));
    std::mt19937_64 random(seed);
    for (int i = 0; i < 20; ++i, ++motions) {
      const std::vector<Rows> way =
          i % 2 == 0 ? paths(bounded, 1, random)
                     : std::vector{bounded.step.start, towards_each_other(bounded, 1, random)};
      ASSERT_TRUE(stays_apart(bounded, way, close)) << i;
    }
  }
  EXPECT_GT(free_poses, wanted / 200);
  EXPECT_GT(bounded_by_cap, 0u);
  EXPECT_GT(zero, 0u);
}

// Bounds a little larger than these are not safe, so the motions above can fail.
TEST(VertexBounds, LargerOnesAreNotSafe) {
  std::size_t broken = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Bounded bounded(seed);
    const std::set<Key> close = bounded.close_at(bounded.step.start);
    std::mt19937_64 random(seed);
    for (int i = 0; i < 20; ++i)
      broken += !stays_apart(bounded, {bounded.step.start, towards_each_other(bounded, 1.1, random)}, close);
  }
  EXPECT_GT(broken, 5u);
}

// A wide cap says of most vertices what a narrow one says, and takes no more: the near is found first. What
// is far from everything gets the cap. Mutation: pairs within the cap are left out where they matter.
TEST(VertexBounds, WideCapsFindTheNearFirst) {
  for (std::uint64_t seed = 2; seed <= 24; ++seed) {
    const SceneStep step(seed);
    SelfCollision body(step.faces, step.start);
    const std::vector<double> narrow = body.vertex_bounds(step.start, 0.2),
                              wide = body.vertex_bounds(step.start, 20);
    std::size_t same = 0;
    double longest = 0;
    for (std::size_t v = 0; v < narrow.size(); ++v) {
      same += std::abs(narrow[v] - std::min(wide[v], 0.2)) < 1e-9;
      longest = std::max(longest, wide[v]);
    }
    EXPECT_GT(2 * same, narrow.size()) << seed;
    EXPECT_GT(longest, 0);
  }
  // Two faces far apart share the way between them.
  const FaceRows faces{{0, 1, 2}, {3, 4, 5}};
  Rows pose{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 30}, {1, 0, 30}, {0, 1, 30}};
  for (const double bound : SelfCollision(faces, pose).vertex_bounds(pose, 100)) EXPECT_NEAR(bound, 15, 1e-9);
  for (const double bound : SelfCollision(faces, pose).vertex_bounds(pose, 12)) EXPECT_EQ(bound, 12);
}

// What is far from everything is held against all others by itself, whatever the cap, and its bounds and
// those of the others leave every pair of features apart. Mutation: the pairs of its edges or of its faces
// are left out.
TEST(VertexBounds, FarVerticesAreHeldAgainstAll) {
  constexpr int kSide = 16, kSheet = (kSide + 1) * (kSide + 1);
  FaceRows faces(2 * kSide * kSide + 1, 3);
  Rows pose(kSheet + 4, 3);  // a sheet, a triangle beside it, and a particle
  for (int i = 0, f = 0; i <= kSide; ++i)
    for (int j = 0; j <= kSide; ++j) {
      const int v = i * (kSide + 1) + j;
      pose.row(v) << i, j, 0.1 * std::sin(v);
      if (i == kSide || j == kSide) continue;
      faces.row(f++) << v, v + kSide + 1, v + 1;
      faces.row(f++) << v + 1, v + kSide + 1, v + kSide + 2;
    }
  faces.row(faces.rows() - 1) << kSheet, kSheet + 1, kSheet + 2;
  // The first edge of the triangle is nearest to an edge of the sheet.
  pose.bottomRows(4) << 46, 8.3, -20, 46, 8.3, 20, 60, 8, 0, 2, 2, 90;
  for (const double thickness : {0.0, 0.05}) {
    SelfCollision::Options options;
    options.thickness = thickness;
    SelfCollision body(faces, pose, options);
    const std::vector<double> bounds = body.vertex_bounds(pose, 1000);
    for (int v = kSheet; v < kSheet + 3; ++v) EXPECT_GT(bounds[std::size_t(v)], 4) << v;
    EXPECT_LT(bounds[0], 1);
    const SelfCollision::Candidates near = body.candidates(pose, pose, 200);
    EXPECT_GT(near.vertex_face.size(), 140'000u) << "all of them";
    const auto expect_room = [&](const std::array<int, 4>& pair, std::size_t split, const Vec3& way) {
      double least[2] = {1e9, 1e9};
      for (std::size_t i = 0; i < 4; ++i) {
        double& side = least[i < split ? 0 : 1];
        side = std::min(side, bounds[std::size_t(pair[i])]);
      }
      ASSERT_LE(least[0] + least[1], way.norm() - thickness + 1e-9) << pair[0] << " " << pair[2];
    };
    const auto at = [&](const std::array<int, 4>& pair) {
      return std::array<Vec3, 4>{pose.row(pair[0]), pose.row(pair[1]), pose.row(pair[2]), pose.row(pair[3])};
    };
    for (const auto& [v, f] : near.vertex_face) {
      const std::array<int, 4> pair = {v, faces(f, 0), faces(f, 1), faces(f, 2)};
      expect_room(pair, 1, nearest_of_vertex_face(at(pair)).way);
    }
    for (const std::array<int, 4>& pair : near.edge_edge)
      expect_room(pair, 2, nearest_of_edges(at(pair)).way);
  }
}

// An obstacle at rest takes no share of the room, and one that moves takes what it moves.
TEST(VertexBounds, ObstaclesKeepTheirOwnMotion) {
  const FaceRows face{{0, 1, 2}};
  const Rows pose{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  Rows above = pose, lower = pose;
  above.col(2).setConstant(1), lower.col(2).setConstant(0.6);
  SelfCollision::Options options;
  options.thickness = 0.25;
  options.obstacles.emplace_back(face, above);
  SelfCollision body(face, pose, options);
  for (const double bound : body.vertex_bounds(pose, 10)) EXPECT_NEAR(bound, 0.75, 1e-12);
  for (const double bound : body.vertex_bounds(pose, 0.5)) EXPECT_EQ(bound, 0.5);
  body.move_obstacle(0, above, lower);
  for (const double bound : body.vertex_bounds(pose, 10)) EXPECT_NEAR(bound, 0.35, 1e-12);
  body.place_obstacle(0, lower);
  for (const double bound : body.vertex_bounds(pose, 10)) EXPECT_NEAR(bound, 0.35, 1e-12);
  Rows touching = pose;
  touching.col(2).setConstant(0.2);
  body.place_obstacle(0, touching);
  for (const double bound : body.vertex_bounds(pose, 10)) EXPECT_EQ(bound, 0);
}

// Half of the room for every vertex of a pair is the simplest bound. Planes between nearest points that no
// side may pass (planar truncation) allow more in most directions, and are no bound for all of them. The
// vertices get a good part of that without knowing the direction.
TEST(VertexBounds, AreComparedWithHalvesAndWithPlanes) {
  double halves = 0, bounds = 0, planes = 0, half_of_nearest = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const SceneStep step(seed);
    constexpr double kCap = 0.5;
    SelfCollision body(step.faces, step.start);
    const std::vector<double> found = body.vertex_bounds(step.start, kCap);
    const SelfCollision::Candidates near = body.candidates(step.start, step.start, 2 * kCap);
    std::mt19937_64 random(seed);
    std::vector<double> half(step.own(), kCap), nearest(step.own(), kCap), length(step.own(), kCap);
    double largest = 0;
    for (const Vec3& p : step.all_start) largest = std::max(largest, p.norm());
    std::vector<Vec3> along;
    for (std::size_t v = 0; v < step.own(); ++v) along.push_back(direction(random));
    const auto take = [&](const std::array<int, 4>& vertices, bool edges) {
      std::array<Vec3, 4> at;
      for (std::size_t i = 0; i < 4; ++i) at[i] = step.start.row(vertices[i]);
      const std::size_t split = edges ? 2 : 1;
      const Vec3 way = (edges ? nearest_of_edges(at) : nearest_of_vertex_face(at)).way;
      const double distance = way.norm();
      double low = HUGE_VAL, high = -HUGE_VAL;
      for (std::size_t i = 0; i < split; ++i) low = std::min(low, at[i].dot(way));
      for (std::size_t i = split; i < 4; ++i) high = std::max(high, at[i].dot(way));
      for (std::size_t i = 0; i < 4; ++i) {
        const auto v = static_cast<std::size_t>(vertices[i]);
        half[v] = std::min(half[v], distance / 2);
        if (!edges && i == 0) nearest[v] = std::min(nearest[v], distance / 2);
        if (!(distance > 0)) continue;
        const double side = i < split ? 1 : -1, room = std::abs(at[i].dot(way) - (low + high) / 2) / distance;
        const double speed = -side * along[v].dot(way) / distance;
        if (speed > 0) length[v] = std::min(length[v], room / speed);
      }
    };
    for (const auto& [v, f] : near.vertex_face)
      take({v, step.faces(f, 0), step.faces(f, 1), step.faces(f, 2)}, false);
    for (const std::array<int, 4>& ends : near.edge_edge) take(ends, true);
    for (std::size_t v = 0; v < step.own(); ++v) {
      // A loose vertex may be in a face up to rounding.
      EXPECT_GE(found[v], half[v] - 1e-9 - 0x1p-46 * largest)
          << "half of the room is the least that a vertex gets";
      halves += half[v], bounds += found[v], planes += length[v], half_of_nearest += nearest[v];
    }
  }
  std::cout << "in halves of the distance to the nearest face: halves " << halves / half_of_nearest
            << ", bounds " << bounds / half_of_nearest << ", planes in a random direction "
            << planes / half_of_nearest << '\n';
  EXPECT_GT(bounds, 1.02 * halves);
  EXPECT_GT(bounds, 0.8 * half_of_nearest);
  EXPECT_GT(planes, bounds);
}

// Mutation: products of coordinates overflow, or vanish.
TEST(VertexBounds, DoNotDependOnTheUnit) {
  const FaceRows faces{{0, 1, 2}, {3, 4, 5}};
  const Rows pose{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 1}, {2, 1, 1}, {1, 2, 2}};
  const std::vector<double> expected = SelfCollision(faces, pose).vertex_bounds(pose, 8);
  for (const double unit : {0x1p-900, 0x1p-400, 0x1p400, 0x1p900}) {
    const Rows scaled = unit * pose;
    const std::vector<double> found = SelfCollision(faces, scaled).vertex_bounds(scaled, 8 * unit);
    for (std::size_t v = 0; v < expected.size(); ++v)
      EXPECT_NEAR(found[v] / unit, expected[v], 1e-12) << unit;
  }
}

TEST(VertexBounds, RefuseWhatIsNoLength) {
  const FaceRows face{{0, 1, 2}};
  const Rows pose{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  SelfCollision body(face, pose);
  for (const double wrong : {std::nan(""), HUGE_VAL, -1.0, 1e308})
    EXPECT_THROW(body.vertex_bounds(pose, wrong), std::invalid_argument) << wrong;
  EXPECT_THROW(body.vertex_bounds(Rows::Zero(4, 3), 1), std::invalid_argument);
  EXPECT_EQ(body.vertex_bounds(pose, 3), std::vector<double>(3, 3.0));
  EXPECT_EQ(body.vertex_bounds(pose, 0), std::vector<double>(3, 0.0));
}

}  // namespace
}  // namespace cscd
