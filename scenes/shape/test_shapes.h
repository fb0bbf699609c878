#pragma once

#include <algorithm>
#include <gtest/gtest.h>
#include <set>

#include "core/mesh/triangle_mesh.h"
#include "scenes/shape/shape.h"

namespace cscd::scenes {

inline double volume(const Shape& shape) {
  double six = 0;
  for (const Triangle& t : shape.triangles)
    six += shape.positions[+t[0]].dot(shape.positions[+t[1]].cross(shape.positions[+t[2]]));
  return six / 6;
}

// Checks the promises of every shape: a closed surface of genus 0 that faces outward, weights that sum to
// one, and a skeleton whose bones have different names.
inline void expect_well_formed(const Shape& shape) {
  ASSERT_EQ(shape.weights.size(), shape.positions.size());
  const TriangleMesh mesh(shape.triangles, shape.positions.size());
  EXPECT_TRUE(mesh.closed_and_oriented());
  EXPECT_EQ(mesh.component_count(), 1);
  EXPECT_EQ(mesh.vertex_count() + mesh.triangle_count(), mesh.edge_count() + 2) << "genus 0";
  EXPECT_GT(volume(shape), 0);

  const std::size_t bones = shape.rig.parent.size();
  EXPECT_NO_THROW(validate(shape.rig));
  EXPECT_EQ(shape.rig.reference.size(), bones);
  ASSERT_EQ(shape.bone_names.size(), bones);
  EXPECT_EQ(std::set<std::string>(shape.bone_names.begin(), shape.bone_names.end()).size(), bones);
  for (const JointWeights& weights : shape.weights) {
    double sum = 0;
    for (std::size_t k = 0; k < JointWeights::most; ++k) {
      EXPECT_GE(weights.weight[k], 0);
      EXPECT_EQ(weights.bone[k] == BoneId{-1}, weights.weight[k] == 0);
      EXPECT_LT(static_cast<int>(weights.bone[k]), static_cast<int>(bones));
      sum += weights.weight[k];
    }
    EXPECT_NEAR(sum, 1, 1e-14);
  }
}

// The largest difference of a bone's weight between the two ends of an edge.
inline double steepest_weight(const Shape& shape) {
  const TriangleMesh mesh(shape.triangles, shape.positions.size());
  const auto weight_of = [&](VertexId vertex, BoneId bone) {
    const JointWeights& weights = shape.weights[+vertex];
    double sum = 0;
    for (std::size_t k = 0; k < JointWeights::most; ++k)
      if (weights.bone[k] == bone) sum += weights.weight[k];
    return sum;
  };
  double steepest = 0;
  for (const Edge& edge : mesh.edges())
    for (const VertexId end : edge)
      for (const BoneId bone : shape.weights[+end].bone)
        if (bone != BoneId{-1})
          steepest = std::max(steepest, std::abs(weight_of(edge[0], bone) - weight_of(edge[1], bone)));
  return steepest;
}

}  // namespace cscd::scenes
