#pragma once

#include <cstdint>

#include "core/hierarchy/bounds.h"
#include "core/hierarchy/tree.h"

// Finds the pairs of leaves of a tree whose bounds overlap: pair_descent() below two nodes, self_descent()
// below one node. Strategies differ in three callables:
//   is_leaf(node)     true where the descent stops: at leaves of the tree, or at the roots of cluster trees
//   skip(a, b)        true if no pair below the two nodes (for a == b: below the node) needs a test
//   emit(a, b)        takes two leaves whose bounds overlap
// Both functions return the number of bounding volume overlap tests.
namespace cscd {

template <class Volume, class IsLeaf, class Skip, class Emit>
struct Descent {
  const Tree& tree;
  const SweptVolumes<Volume>& bounds;
  IsLeaf is_leaf;
  Skip skip;
  Emit emit;
  std::uint64_t tests = 0;

  // Visits all pairs of one leaf below `a` and one leaf below `b`, two nodes of
  // which neither contains the other.
  void pair(NodeIndex a, NodeIndex b) {
    if (skip(a, b)) return;
    ++tests;
    if (overlap(bounds[a], bounds[b])) below(a, b);
  }

  // Does the same as pair() for two nodes that are known to overlap.
  void below(NodeIndex a, NodeIndex b) {
    const bool leaf_a = is_leaf(a), leaf_b = is_leaf(b);
    if (leaf_a && leaf_b) {
      emit(a, b);
    } else if (leaf_a) {
      pair(a, tree.left(b));
      pair(a, tree.right(b));
    } else if (leaf_b) {
      pair(tree.left(a), b);
      pair(tree.right(a), b);
    } else {
      pair(tree.left(a), tree.left(b));
      pair(tree.left(a), tree.right(b));
      pair(tree.right(a), tree.left(b));
      pair(tree.right(a), tree.right(b));
    }
  }

  // Visits all pairs of different leaves below one node.
  void self(NodeIndex node) {
    if (is_leaf(node) || skip(node, node)) return;
    self(tree.left(node));
    self(tree.right(node));
    pair(tree.left(node), tree.right(node));
  }
};

// Visits all pairs of one leaf below `a` and one leaf below `b`, which are known to overlap.
template <class Volume, class IsLeaf, class Skip, class Emit>
std::uint64_t pair_descent(const Tree& tree, const SweptVolumes<Volume>& bounds, NodeIndex a, NodeIndex b,
                           IsLeaf is_leaf, Skip skip, Emit emit) {
  Descent<Volume, IsLeaf, Skip, Emit> descent{tree, bounds, is_leaf, skip, emit};
  if (!skip(a, b)) descent.below(a, b);
  return descent.tests;
}

// Visits all pairs of different leaves below `node`.
template <class Volume, class IsLeaf, class Skip, class Emit>
std::uint64_t self_descent(const Tree& tree, const SweptVolumes<Volume>& bounds, NodeIndex node,
                           IsLeaf is_leaf, Skip skip, Emit emit) {
  Descent<Volume, IsLeaf, Skip, Emit> descent{tree, bounds, is_leaf, skip, emit};
  descent.self(node);
  return descent.tests;
}

}  // namespace cscd
