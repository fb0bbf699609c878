#include "core/hierarchy/tree.h"

#include <algorithm>
#include <numeric>

namespace cscd {

// Writes nodes in depth-first order.
struct TreeBuilder {
  const TriangleMesh& mesh;
  std::vector<Vec3> centroid;  // [triangles]
  Tree tree;

  TreeBuilder(const TriangleMesh& mesh_in, std::span<const Vec3> positions)
      : mesh(mesh_in), centroid(mesh.triangle_count()) {
    for (std::size_t t = 0; t < centroid.size(); ++t) {
      const Triangle& corner = mesh.triangles()[t];
      // Each position is divided before the sum, so that hardly any coordinates overflow. If some do, only
      // the shape of the tree suffers; no pair is lost.
      centroid[t] = positions[+corner[0]] / 3 + positions[+corner[1]] / 3 + positions[+corner[2]] / 3;
    }
    tree.link_.reserve(2 * centroid.size());
  }

  // Builds a subtree. It splits the items in half at the median of their centres, along the
  // longest axis of the centres' box.
  template <class Item, class Centre, class Leaf>
  void build(std::span<Item> items, const Centre& centre, const Leaf& leaf) {
    if (items.size() == 1) return leaf(items[0]);
    Vec3 low = centre(items[0]), high = low;
    for (const Item& item : items) {
      low = low.cwiseMin(centre(item));
      high = high.cwiseMax(centre(item));
    }
    int axis = 0;
    (high / 2 - low / 2).maxCoeff(&axis);
    const std::size_t half = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                     [&](const Item& a, const Item& b) {
                       const double ca = centre(a)[axis], cb = centre(b)[axis];
                       return ca != cb ? ca < cb : a < b;  // a total order: the same tree with every library
                     });
    const std::size_t node = tree.link_.size();
    tree.link_.push_back(0);
    build(items.first(half), centre, leaf);
    tree.link_[node] = static_cast<std::int32_t>(tree.link_.size());
    build(items.subspan(half), centre, leaf);
  }

  void build_local(std::span<std::int32_t> triangles) {
    build(
        triangles, [&](std::int32_t t) -> const Vec3& { return centroid[static_cast<std::size_t>(t)]; },
        [&](std::int32_t t) { tree.link_.push_back(~t); });
  }
};

Tree build_tree(const TriangleMesh& mesh, std::span<const Vec3> positions) {
  TreeBuilder builder(mesh, positions);
  std::vector<std::int32_t> triangles(mesh.triangle_count());
  std::iota(triangles.begin(), triangles.end(), 0);
  builder.build_local(triangles);
  return std::move(builder.tree);
}

Tree build_tree(const TriangleMesh& mesh, std::span<const Vec3> positions,
                std::span<const std::int32_t> cluster, int cluster_count) {
  TreeBuilder builder(mesh, positions);
  const auto count = static_cast<std::size_t>(cluster_count);
  std::vector<std::vector<std::int32_t>> members(count);
  for (std::size_t t = 0; t < cluster.size(); ++t)
    members[static_cast<std::size_t>(cluster[t])].push_back(static_cast<std::int32_t>(t));

  std::vector<Vec3> centre(count, Vec3::Zero());
  for (std::size_t c = 0; c < count; ++c)
    for (const std::int32_t t : members[c])
      centre[c] += builder.centroid[static_cast<std::size_t>(t)] / static_cast<double>(members[c].size());

  std::vector<std::int32_t> clusters(count);
  std::iota(clusters.begin(), clusters.end(), 0);
  builder.tree.cluster_roots_.resize(count);
  builder.build(
      std::span(clusters), [&](std::int32_t c) -> const Vec3& { return centre[static_cast<std::size_t>(c)]; },
      [&](std::int32_t c) {
        builder.tree.cluster_roots_[static_cast<std::size_t>(c)] =
            static_cast<NodeIndex>(builder.tree.link_.size());
        builder.build_local(members[static_cast<std::size_t>(c)]);
      });
  return std::move(builder.tree);
}

}  // namespace cscd
