#include "core/radial/cluster_hierarchy.h"

#include "core/hierarchy/overlap_descent.h"

namespace cscd::radial {

ClusterHierarchy::ClusterHierarchy(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                   const AtomicClusters& clusters, Pipeline pipeline)
    : mesh_(mesh),
      tree_(build_tree(mesh, reference, clusters.of_triangle, static_cast<int>(clusters.clusters.size()))),
      bounds_(mesh, tree_, pipeline),
      cluster_at_(tree_.node_count(), -1),
      groups_(clusters.clusters.size()),
      first_leaf_(clusters.clusters.size()),
      class_of_leaf_(mesh.triangle_count(), Orientation::uncertain),
      mask_(tree_.node_count()) {
  for (std::size_t c = 0; c < groups_.size(); ++c)
    cluster_at_[static_cast<std::size_t>(tree_.cluster_roots()[c])] = static_cast<std::int32_t>(c);
  std::size_t leaf = 0, cluster = 0;
  for (std::size_t n = 0; n < tree_.node_count(); ++n) {
    if (cluster_at_[n] >= 0) {
      cluster = static_cast<std::size_t>(cluster_at_[n]);
      first_leaf_[cluster] = leaf;
    }
    if (!tree_.is_leaf(static_cast<NodeIndex>(n))) continue;
    groups_[cluster].push_back(tree_.triangle(static_cast<NodeIndex>(n)));
    ++leaf;
  }
}

void ClusterHierarchy::keep_distant(const Motion& motion, std::span<const std::int32_t> merged,
                                    std::span<const Observer> observers) {
  if (!near_) {
    near_.emplace(mesh_);
    leaf_of_.resize(mesh_.triangle_count());
    for (std::size_t n = 0; n < tree_.node_count(); ++n)
      if (const auto node = static_cast<NodeIndex>(n); tree_.is_leaf(node))
        leaf_of_[+tree_.triangle(node)] = node;
  }
  for (std::size_t c = 0; c < groups_.size(); ++c) {
    const Observer& observer = observers[static_cast<std::size_t>(merged[c])];
    const std::span<Orientation> classes = this->classes(c);
    for (std::size_t i = 0; i < classes.size(); ++i) {
      const Triangle& t = mesh_.corners(groups_[c][i]);
      if (observer.is_segment ||
          !plane_is_distant({motion[t[0]], motion[t[1]], motion[t[2]]}, observer.head, thickness_ / 2))
        classes[i] = Orientation::uncertain;
    }
  }
}

RadialCounts ClusterHierarchy::finish_classes() {
  std::size_t leaf = class_of_leaf_.size();
  for (auto node = static_cast<NodeIndex>(tree_.node_count()) - 1; node >= 0; --node) {
    const auto n = static_cast<std::size_t>(node);
    if (tree_.is_leaf(node))
      mask_[n] = static_cast<std::uint8_t>(class_of_leaf_[--leaf]);
    else
      mask_[n] = mask_[static_cast<std::size_t>(tree_.left(node))] |
                 mask_[static_cast<std::size_t>(tree_.right(node))];
  }
  RadialCounts counts;
  for (const Orientation orientation : class_of_leaf_) {
    counts.positive += orientation == Orientation::positive;
    counts.negative += orientation == Orientation::negative;
    counts.uncertain += orientation == Orientation::uncertain;
  }
  return counts;
}

CullCounts ClusterHierarchy::cull(std::span<const std::int32_t> merged, TrianglePairSink& sink) const {
  constexpr auto positive = static_cast<std::uint8_t>(Orientation::positive);
  constexpr auto negative = static_cast<std::uint8_t>(Orientation::negative);
  const auto is_leaf = [&](NodeIndex node) { return tree_.is_leaf(node); };
  const auto emit = [&](NodeIndex a, NodeIndex b) { sink.add(tree_.triangle(a), tree_.triangle(b)); };
  const auto same_sign = [&](NodeIndex a, NodeIndex b) {
    const std::uint8_t mask = mask_[static_cast<std::size_t>(a)] | mask_[static_cast<std::size_t>(b)];
    return mask == positive || mask == negative;
  };
  const auto never = [](NodeIndex, NodeIndex) { return false; };

  std::uint64_t tests = 0;
  for (const NodeIndex root : tree_.cluster_roots())
    tests += self_descent(tree_, bounds_, root, is_leaf, same_sign, emit);

  const auto is_cluster = [&](NodeIndex node) { return cluster_at_[static_cast<std::size_t>(node)] >= 0; };
  const auto cluster_pair = [&](NodeIndex a, NodeIndex b) {
    const auto label = [&](NodeIndex root) {
      return merged[static_cast<std::size_t>(cluster_at_[static_cast<std::size_t>(root)])];
    };
    tests += label(a) == label(b) ? pair_descent(tree_, bounds_, a, b, is_leaf, same_sign, emit)
                                  : pair_descent(tree_, bounds_, a, b, is_leaf, never, emit);
  };
  if (thickness_ > 0) tests += pass_on_near(sink);
  const std::uint64_t global_tests = self_descent(tree_, bounds_, 0, is_cluster, never, cluster_pair);
  CullCounts counts;
  counts.bvot = tests + global_tests;
  return counts;
}

std::uint64_t ClusterHierarchy::pass_on_near(TrianglePairSink& sink) const {
  std::uint64_t tests = 0;
  for (std::size_t t = 0; t < leaf_of_.size(); ++t)
    for (const TriangleId b : near_->of(TriangleId{static_cast<std::int32_t>(t)})) {
      if (+b < t) continue;
      ++tests;
      if (overlap(bounds_[leaf_of_[t]], bounds_[leaf_of_[+b]]))
        sink.add(TriangleId{static_cast<std::int32_t>(t)}, b);
    }
  return tests;
}

RadialView ClusterHierarchy::view(std::span<const std::int32_t> merged,
                                  std::span<const Observer> observers) const {
  RadialView view{std::vector<std::int32_t>(mesh_.triangle_count()),
                  std::vector<bool>(mesh_.triangle_count())};
  for (std::size_t c = 0; c < groups_.size(); ++c)
    for (std::size_t i = 0; i < groups_[c].size(); ++i) {
      const auto triangle = static_cast<std::size_t>(groups_[c][i]);
      view.cluster[triangle] = merged[c];
      view.positive[triangle] = class_of_leaf_[first_leaf_[c] + i] == Orientation::positive;
    }
  for (const Observer& observer : observers)
    view.observers.push_back(
        {static_cast<std::int32_t>(view.observers.size()), observer.head, observer.tail});
  return view;
}

}  // namespace cscd::radial
