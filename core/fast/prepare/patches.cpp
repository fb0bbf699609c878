#include "core/fast/prepare/patches.h"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <optional>

#include "core/fast/prepare/patch_cutter.h"

namespace cscd::fast {
namespace {

// Divides the triangles into cells, so that certificates treat all triangles of a cell alike. A cell lies in
// one cluster of the first clusters. Where that leaves enough triangles, it also lies in one of the second
// clusters, and either all its triangles are inside that cluster or none is.
std::vector<std::vector<TriangleId>> cells_of(const TriangleMesh& mesh, const CuttingClusters& clusters,
                                              std::size_t least) {
  const std::vector<bool> all = inside(mesh, clusters.second);
  std::map<std::int32_t, std::map<std::pair<std::int32_t, bool>, std::vector<TriangleId>>> members;
  for (std::size_t t = 0; t < all.size(); ++t)
    members[clusters.first[t]][{clusters.second[t], all[t]}].push_back(
        TriangleId{static_cast<std::int32_t>(t)});

  std::vector<std::vector<TriangleId>> cells;
  for (auto& [first, parts] : members) {
    std::vector<TriangleId> rest;
    for (auto& [second, triangles] : parts)
      if (triangles.size() >= least)
        cells.push_back(std::move(triangles));
      else
        rest.insert(rest.end(), triangles.begin(), triangles.end());
    if (!rest.empty()) cells.push_back(std::move(rest));
  }
  return cells;
}

using Triangles = std::array<TriangleId, kLanes16>;

Triangles padded(std::span<const TriangleId> triangles) {
  Triangles out;
  for (std::size_t l = 0; l < kLanes16; ++l) out[l] = triangles[std::min(l, triangles.size() - 1)];
  return out;
}

Patch make_patch(const TriangleMesh& mesh, const Triangles& triangles, std::size_t count) {
  Patch patch{};
  std::vector<VertexId> vertices;
  for (std::size_t l = 0; l < kLanes16; ++l) {
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId v = mesh.corners(triangles[l])[k];
      auto place = std::find(vertices.begin(), vertices.end(), v);
      if (place == vertices.end()) place = vertices.insert(vertices.end(), v);
      patch.corner[k][l] = static_cast<std::uint8_t>(place - vertices.begin());
    }
  }
  for (std::size_t l = 0; l < kLanes16; ++l)
    patch.vertex[l] = static_cast<std::int32_t>(vertices[std::min(l, vertices.size() - 1)]);
  patch.lanes = static_cast<Mask16>((1U << count) - 1);
  patch.cluster.fill(kNone);
  return patch;
}

// The patches of one or several cells, with their centre.
struct Item {
  std::vector<std::size_t> patches;
  Vec3 centre = Vec3::Zero();
};

class TreeBuilder {
 public:
  TreeBuilder(const std::vector<Patch>& patches, const std::vector<Triangles>& triangles,
              const std::vector<Vec3>& centre, const std::vector<std::int32_t>& cell, PatchTree& tree)
      : patches_(patches), triangles_(triangles), centre_(centre), cell_(cell), tree_(tree) {}

  // Builds the tree over the first clusters, below them over the cells of each, and below those over patches.
  void build(const std::vector<std::int32_t>& cluster) {
    std::vector<std::size_t> all(patches_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    tree_.nodes.push_back({0});
    split(grouped(all, cluster), 0, [&](const Item& in_cluster, std::size_t cluster_node) {
      split(grouped(in_cluster.patches, cell_), cluster_node,
            [&](const Item& in_cell, std::size_t cell_node) {
              std::vector<Item> single;
              for (const std::size_t p : in_cell.patches) single.push_back({{p}, centre_[p]});
              split(single, cell_node, [&](const Item& patch, std::size_t leaf) {
                tree_.nodes[leaf].child = ~static_cast<std::int32_t>(tree_.patches.size());
                tree_.leaf.push_back(static_cast<std::int32_t>(leaf));
                tree_.patches.push_back(patches_[patch.patches[0]]);
                tree_.triangles.push_back(triangles_[patch.patches[0]]);
                tree_.cell.push_back(cell_[patch.patches[0]]);
              });
            });
    });
    for (std::size_t n = 0; n < tree_.nodes.size(); ++n)
      if (!tree_.nodes[n].is_leaf()) tree_.inner.push_back(static_cast<std::int32_t>(n));
    find_inner_ends();
  }

 private:
  // What lies below a node ends where what lies below its last inner child ends.
  void find_inner_ends() {
    std::vector<std::int32_t> place(tree_.nodes.size(), kNone);
    for (std::size_t i = 0; i < tree_.inner.size(); ++i)
      place[static_cast<std::size_t>(tree_.inner[i])] = static_cast<std::int32_t>(i);
    tree_.inner_end.resize(tree_.inner.size());
    for (std::size_t i = tree_.inner.size(); i-- > 0;) {
      const PatchTree::Node& node = tree_.nodes[static_cast<std::size_t>(tree_.inner[i])];
      std::int32_t end = static_cast<std::int32_t>(i) + 1;
      for (const std::size_t child : {node.left(), node.right()})
        if (place[child] != kNone)
          end = std::max(end, tree_.inner_end[static_cast<std::size_t>(place[child])]);
      tree_.inner_end[i] = end;
    }
  }
  std::vector<Item> grouped(const std::vector<std::size_t>& patches,
                            const std::vector<std::int32_t>& key) const {
    std::map<std::int32_t, Item> groups;
    for (const std::size_t p : patches) groups[key[p]].patches.push_back(p);
    std::vector<Item> items;
    for (auto& [k, item] : groups) {
      for (const std::size_t p : item.patches)
        item.centre += centre_[p] / static_cast<double>(item.patches.size());
      items.push_back(std::move(item));
    }
    return items;
  }

  // Halves the items at the median along the longest axis of the box of their centres, down to single items.
  using Leaf = std::function<void(const Item&, std::size_t node)>;
  void split(std::span<Item> items, std::size_t node, const Leaf& leaf) {
    if (items.size() == 1) return leaf(items[0], node);
    Eigen::AlignedBox3d box;
    for (const Item& item : items) box.extend(item.centre);
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    std::stable_sort(items.begin(), items.end(),
                     [&](const Item& a, const Item& b) { return a.centre[axis] < b.centre[axis]; });
    const std::size_t left = tree_.nodes.size(), half = items.size() / 2;
    tree_.nodes[node].child = static_cast<std::int32_t>(left);
    tree_.nodes.resize(left + 2);
    split(items.first(half), left, leaf);
    split(items.subspan(half), left + 1, leaf);
  }
  void split(std::vector<Item> items, std::size_t node, const Leaf& leaf) {
    split(std::span(items), node, leaf);
  }

  const std::vector<Patch>& patches_;
  const std::vector<Triangles>& triangles_;
  const std::vector<Vec3>& centre_;
  const std::vector<std::int32_t>& cell_;
  PatchTree& tree_;
};

void find_adjacent(const TriangleMesh& mesh, PatchTree& tree) {
  struct Place {
    std::int32_t patch, lane;
  };
  std::vector<Place> place_of(mesh.triangle_count());
  for (std::size_t p = 0; p < tree.patches.size(); ++p)
    for (std::size_t l = 0; tree.patches[p].lanes >> l != 0; ++l)
      place_of[+tree.triangles[p][l]] = {static_cast<std::int32_t>(p), static_cast<std::int32_t>(l)};
  tree.adjacent_offset.push_back(0);
  std::vector<std::pair<std::int32_t, SharedVertices>> touching;  // few, and in no order at first
  for (const Patch& patch : tree.patches) {
    touching.clear();
    for_each_lane(patch.corners_of(patch.lanes), [&](std::size_t v) {
      for (const TriangleId t : mesh.triangles_at(VertexId{patch.vertex[v]})) {
        auto at =
            std::ranges::find(touching, place_of[+t].patch, &std::pair<std::int32_t, SharedVertices>::first);
        if (at == touching.end()) at = touching.insert(at, {place_of[+t].patch, SharedVertices{}});
        at->second.at[v] |= static_cast<Mask16>(1U << place_of[+t].lane);
      }
    });
    std::ranges::sort(touching, {}, &std::pair<std::int32_t, SharedVertices>::first);
    for (const auto& [other, common] : touching) {
      tree.adjacent.push_back(other);
      tree.common.push_back(common);
    }
    tree.adjacent_offset.push_back(static_cast<std::int32_t>(tree.adjacent.size()));
  }
  tree.adjacent.shrink_to_fit();
  tree.common.shrink_to_fit();
}

}  // namespace

std::vector<Vec3> centroids(const TriangleMesh& mesh, std::span<const Vec3> reference) {
  std::vector<Vec3> centroid;
  for (const Triangle& c : mesh.triangles())
    centroid.push_back(reference[+c[0]] / 3 + reference[+c[1]] / 3 + reference[+c[2]] / 3);
  return centroid;
}

PatchList cut_into_patches(const TriangleMesh& mesh, std::span<const Vec3> reference,
                           const CuttingClusters& clusters, std::size_t least_cell, const ThreadPool& pool) {
  const std::vector<Vec3> centroid = centroids(mesh, reference);
  const std::vector<std::vector<TriangleId>> cells = cells_of(mesh, clusters, least_cell);
  std::vector<std::optional<PatchCutter>> cutters(pool.threads());
  std::vector<PatchCutter::Patches> cut(cells.size());
  pool.parallel_for(cells.size(), [&](std::size_t cell, std::size_t thread) {
    if (!cutters[thread]) cutters[thread].emplace(mesh, centroid);
    cut[cell] = cutters[thread]->cut(cells[cell]);
  });
  PatchList patches;
  for (std::size_t cell = 0; cell < cells.size(); ++cell)
    for (std::vector<TriangleId>& patch : cut[cell]) {
      patches.triangles.push_back(std::move(patch));
      patches.cell.push_back(static_cast<std::int32_t>(cell));
    }
  return patches;
}

PatchTree make_tree(const TriangleMesh& mesh, std::span<const Vec3> reference, const PatchList& list,
                    std::span<const std::int32_t> cluster_of) {
  const std::vector<Vec3> centroid = centroids(mesh, reference);
  std::vector<Patch> patches;
  std::vector<Triangles> triangles;
  std::vector<Vec3> centre;
  std::vector<std::int32_t> cluster;
  for (const std::vector<TriangleId>& patch : list.triangles) {
    triangles.push_back(padded(patch));
    patches.push_back(make_patch(mesh, triangles.back(), patch.size()));
    Vec3 sum = Vec3::Zero();
    for (const TriangleId t : patch) sum += centroid[+t] / static_cast<double>(patch.size());
    centre.push_back(sum);
    cluster.push_back(cluster_of[+patch[0]]);
  }
  PatchTree tree;
  TreeBuilder(patches, triangles, centre, list.cell, tree).build(cluster);
  find_adjacent(mesh, tree);
  tree.inside.resize(tree.patches.size());
  return tree;
}

}  // namespace cscd::fast
