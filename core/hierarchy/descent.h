#pragma once

#include <cstdint>

#include "core/hierarchy/bounds.h"
#include "core/hierarchy/tree.h"

// The one pair-descent and the one self-descent, over bounds of any volume. Strategies differ in the
// callables:
//   is_leaf(node)     where the descent stops: tree leaves, or the roots of cluster trees
//   skip(a, b)        true if no pair below these two nodes has to be looked at; a == b: none below this one
//   emit(a, b)        takes two leaves whose bounds overlap
// Both return the number of bounding volume overlap tests.
namespace cscd {

template <class Volume, class IsLeaf, class Skip, class Emit>
struct Descent {
  const Tree& tree;
  const SweptVolumes<Volume>& bounds;
  IsLeaf is_leaf;
  Skip skip;
  Emit emit;
  std::uint64_t tests = 0;

  // All pairs with one leaf below each of two disjoint nodes.
  void pair(NodeIndex a, NodeIndex b) {
    if (skip(a, b)) return;
    ++tests;
    if (overlap(bounds[a], bounds[b])) below(a, b);
  }

  // The same for two nodes that are known to overlap.
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

  // All pairs of different leaves below one node.
  void self(NodeIndex node) {
    if (is_leaf(node) || skip(node, node)) return;
    self(tree.left(node));
    self(tree.right(node));
    pair(tree.left(node), tree.right(node));
  }
};

// Starts below two nodes that are known to overlap.
template <class Volume, class IsLeaf, class Skip, class Emit>
std::uint64_t pair_descent(const Tree& tree, const SweptVolumes<Volume>& bounds, NodeIndex a, NodeIndex b,
                           IsLeaf is_leaf, Skip skip, Emit emit) {
  Descent<Volume, IsLeaf, Skip, Emit> descent{tree, bounds, is_leaf, skip, emit};
  if (!skip(a, b)) descent.below(a, b);
  return descent.tests;
}

template <class Volume, class IsLeaf, class Skip, class Emit>
std::uint64_t self_descent(const Tree& tree, const SweptVolumes<Volume>& bounds, NodeIndex node,
                           IsLeaf is_leaf, Skip skip, Emit emit) {
  Descent<Volume, IsLeaf, Skip, Emit> descent{tree, bounds, is_leaf, skip, emit};
  descent.self(node);
  return descent.tests;
}

}  // namespace cscd
