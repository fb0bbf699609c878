#include "core/radial/heat_weights.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <tuple>
#include <vector>

#include "core/mesh/test_shapes.h"

namespace cscd::radial {
namespace {

using test::Shape;

VisibleBones visible_in(const Shape& shape, const std::vector<Bone>& bones) {
  const TriangleMesh mesh = shape.mesh();
  return find_visible_bones(mesh, shape.positions, bones, make_distance_field(mesh, shape.positions, 24));
}

std::map<BoneId, Eigen::VectorXd> weights_of(const Shape& shape, const VisibleBones& visible) {
  std::map<BoneId, Eigen::VectorXd> weights;
  BoneId before{-1};
  EXPECT_TRUE(diffuse_heat(shape.mesh(), shape.positions, visible, [&](BoneId bone, const auto& w) {
    EXPECT_LT(before, bone);
    before = bone;
    weights[bone] = w;
  }));
  return weights;
}

// Solves by Gauss elimination, entry by entry. The matrices below are diagonally dominant and need no
// pivoting.
Eigen::VectorXd solve(Eigen::MatrixXd matrix, Eigen::VectorXd side) {
  const Eigen::Index n = side.size();
  for (Eigen::Index k = 0; k < n; ++k)
    for (Eigen::Index i = k + 1; i < n; ++i) {
      const double factor = matrix(i, k) / matrix(k, k);
      for (Eigen::Index j = k; j < n; ++j) matrix(i, j) -= factor * matrix(k, j);
      side[i] -= factor * side[k];
    }
  for (Eigen::Index k = n - 1; k >= 0; --k) {
    for (Eigen::Index j = k + 1; j < n; ++j) side[k] -= matrix(k, j) * side[j];
    side[k] /= matrix(k, k);
  }
  return side;
}

// Returns the weights of one bone from plainly computed angles and areas and one dense solve.
Eigen::VectorXd dense_solution(const Shape& shape, const VisibleBones& visible, BoneId bone) {
  const auto n = static_cast<Eigen::Index>(shape.positions.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd area = Eigen::VectorXd::Zero(n), source = Eigen::VectorXd::Zero(n);
  for (const Triangle& t : shape.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<Eigen::Index>(t[k]), j = static_cast<Eigen::Index>(t[(k + 1) % 3]);
      const Vec3 u = shape.positions[+t[k]] - shape.positions[+t[(k + 2) % 3]],
                 v = shape.positions[+t[(k + 1) % 3]] - shape.positions[+t[(k + 2) % 3]];
      const double angle = std::acos(u.dot(v) / (u.norm() * v.norm())), half = 0.5 / std::tan(angle);
      matrix(i, j) -= half;
      matrix(j, i) -= half;
      matrix(i, i) += half;
      matrix(j, j) += half;
      area[i] += u.norm() * v.norm() * std::sin(angle) / 6;
    }
  for (Eigen::Index v = 0; v < n; ++v) {
    const auto row = visible.of(static_cast<std::size_t>(v));
    if (row.empty()) continue;
    const double d = visible.distance[static_cast<std::size_t>(v)], pull = area[v] / (d * d);
    matrix(v, v) += pull;
    for (const BoneId b : row)
      if (b == bone) source[v] += pull / static_cast<double>(row.size());
  }
  return solve(matrix, source);
}

Shape capsule() {
  return test::uneven_tube(10, 20, 3,
                           [](double x) { return std::sqrt(std::max(0.0, 0.6 * std::min(x, 3 - x))); });
}

// Compares entry by entry, because gcc 12 takes Eigen's AVX-512 reductions for uninitialised.
double largest_difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double most = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

struct Case {
  Shape shape;
  std::vector<Bone> bones;
};

std::vector<Case> cases() {
  const std::vector<Bone> two{{{-0.5, 0, 0}, {0, 0, 0}}, {{0, 0, 0}, {0.5, 0.1, 0}}};
  const std::vector<Bone> along{{{0, 0, 0}, {1, 0, 0}}, {{1, 0, 0}, {2, 0, 0}}, {{2, 0, 0}, {3, 0, 0}}};
  Shape stretched = test::capped_tube(12, 4, 0.2, 3);  // all angles obtuse or tiny, once pressed flat
  for (Vec3& p : stretched.positions) p.z() *= 1e-4;
  Shape collapsed = test::capped_tube(6, 6, 0.4, 3);
  for (std::size_t v = 12; v < 18; ++v) collapsed.positions[v] = collapsed.positions[12];
  Shape nothing = test::octahedron();
  for (Vec3& p : nothing.positions) p.setZero();
  return {
      {test::octahedron(), two},
      {test::icosphere(2), two},
      {test::torus(), {{{2, 0, 0}, {2, 0.2, 0}}, {{0, 2, 0}, {0.2, 2, 0}}, {{-2, 0, 0}, {-2, -0.3, 0}}}},
      {test::capped_tube(9, 30, 0.3, 3), along},
      {stretched, along},
      {collapsed, along},
      {nothing, two},
      {capsule(), along},
      {test::together(test::octahedron(), test::moved(test::octahedron(), {7, 0, 0}, 1e-3)), two},
      {test::octahedron(), {{{1e6, 0, 0}, {1e6, 1, 0}}, {{-1e200, 0, 0}, {0, 1e200, 0}}}},
      {test::octahedron(), {{{-1, 0, 0}, {1, 0, 0}}, {{0, 1, 0}, {0, 1, 0}}}}};  // bones that touch vertices
}

TEST(HeatWeights, LieBetweenZeroAndOneAndSumToOne) {
  int which = 0;
  for (const Case& c : cases()) {
    SCOPED_TRACE(which++);
    const auto weights = weights_of(c.shape, visible_in(c.shape, c.bones));
    ASSERT_FALSE(weights.empty());
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(c.shape.positions.size()));
    for (const auto& [bone, w] : weights) {
      ASSERT_TRUE(w.allFinite());
      for (Eigen::Index v = 0; v < w.size(); ++v) {
        EXPECT_GE(w[v], 0);  // an M-matrix: no cancellation on the way, so not even rounding goes below
        EXPECT_LE(w[v], 1 + 1e-7);
      }
      sum += w;
    }
    EXPECT_LE(largest_difference(sum, Eigen::VectorXd::Ones(sum.size())), 1e-7);
  }
}

TEST(HeatWeights, SolveTheSystemOfThePaper) {
  // Shapes without obtuse angles opposite to each other, so that no edge weight is bounded.
  std::vector<Bone> many;  // more than are solved for at a time
  for (int b = 0; b < 19; ++b)
    many.push_back({{0, 0, 0}, {0.5 * std::cos(b), 0.5 * std::sin(b), 0.3 * std::sin(5 * b)}});
  const std::tuple<Shape, std::vector<Bone>> shapes[] = {
      {test::icosphere(2), many},
      {test::octahedron(), {{{-0.5, 0, 0}, {0, 0, 0}}, {{0, 0, 0}, {0.5, 0.1, 0}}}},
      {test::icosphere(2),
       {{{-0.5, 0.3, 0}, {0, 0, 0.2}}, {{0, 0, 0.2}, {0.5, 0.1, 0}}, {{0, 0, 0.2}, {0, 0, 0.6}}}}};
  for (const auto& [shape, bones] : shapes) {
    const VisibleBones visible = visible_in(shape, bones);
    const auto weights = weights_of(shape, visible);
    EXPECT_GT(weights.size(), bones.size() / 2);
    for (const auto& [bone, w] : weights)
      EXPECT_LE(largest_difference(w, dense_solution(shape, visible, bone)), 1e-12);
  }
}

TEST(HeatWeights, OneBoneHeatsEverythingFully) {
  const Shape shape = test::icosphere(1);
  const auto weights = weights_of(shape, visible_in(shape, {{{0, 0, 0}, {0.2, 0, 0}}}));
  ASSERT_EQ(weights.size(), 1u);
  const Eigen::VectorXd& w = weights.at(BoneId{0});
  EXPECT_LE(largest_difference(w, Eigen::VectorXd::Ones(w.size())), 1e-12);
}

TEST(HeatWeights, HiddenVerticesAreHeatedByTheirNeighbours) {
  const Shape shape = test::capped_tube(8, 40, 0.5, 8);
  VisibleBones visible = visible_in(shape, {{{0, 0, 0}, {4, 0, 0}}, {{4, 0, 0}, {8, 0, 0}}});
  // Remove the visible bones of all vertices but those of the first and the last ring.
  VisibleBones ends{{0}, {}, visible.distance};
  for (std::size_t v = 0; v < shape.positions.size(); ++v) {
    if (v < 8 || (v >= 320 && v < 328)) ends.bones.push_back(visible.of(v).front());
    ends.offset.push_back(static_cast<std::int32_t>(ends.bones.size()));
  }
  const auto weights = weights_of(shape, ends);
  // Between the rings heat falls linearly with the distance along the tube.
  const Eigen::VectorXd& w = weights.at(BoneId{0});
  for (Eigen::Index ring = 1; ring < 40; ++ring) {
    EXPECT_LT(w[8 * ring], w[8 * (ring - 1)]);
    EXPECT_NEAR(w[8 * ring] - w[8 * (ring - 1)], w[8] - w[0], 1e-9);
  }
}

TEST(HeatWeights, VertexWithoutTrianglesHasNone) {
  Shape shape = test::octahedron();
  shape.positions.emplace_back(0, 0, 0);
  for (const auto& [bone, w] : weights_of(shape, visible_in(shape, {{{0, 0, 0}, {0.2, 0, 0}}})))
    EXPECT_EQ(w[6], 0);
}

}  // namespace
}  // namespace cscd::radial
