#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

using NodeIndex = std::int32_t;

// The topology of a binary tree over triangles, built once in the reference pose. Nodes stand in depth-first
// order: the left child of node n is n + 1, so every subtree is a contiguous range and children follow their
// parents.
class Tree {
 public:
  std::size_t node_count() const { return link_.size(); }
  bool is_leaf(NodeIndex node) const { return link_[static_cast<std::size_t>(node)] < 0; }
  TriangleId triangle(NodeIndex leaf) const { return TriangleId{~link_[static_cast<std::size_t>(leaf)]}; }
  NodeIndex left(NodeIndex node) const { return node + 1; }
  NodeIndex right(NodeIndex node) const { return link_[static_cast<std::size_t>(node)]; }

  // For a tree over clusters: [clusters], the root of each cluster's subtree. Empty for other trees.
  std::span<const NodeIndex> cluster_roots() const { return cluster_roots_; }

 private:
  friend Tree build_tree(const TriangleMesh&, std::span<const Vec3>);
  friend Tree build_tree(const TriangleMesh&, std::span<const Vec3>, std::span<const std::int32_t>, int);
  friend struct TreeBuilder;
  std::vector<std::int32_t> link_;  // [nodes]; an inner node's right child, or ~triangle for a leaf
  std::vector<NodeIndex> cluster_roots_;
};

// Builds a tree by median splits of triangle centroids along the longest axis of their box (Bridson et al.
// 2002), with one triangle a leaf.
Tree build_tree(const TriangleMesh& mesh, std::span<const Vec3> positions);

// Builds a local tree for each cluster, and a global tree over their roots (Wong et al. 2013; section 6 of
// the 2014 paper). `cluster`, [triangles], holds labels in [0, cluster_count), each of which occurs.
Tree build_tree(const TriangleMesh& mesh, std::span<const Vec3> positions,
                std::span<const std::int32_t> cluster, int cluster_count);

}  // namespace cscd
