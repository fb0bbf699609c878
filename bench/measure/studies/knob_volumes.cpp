#include "bench/measure/studies/knob_volumes.h"

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "core/base/rounding.h"
#include "core/detect/compose.h"
#include "core/hierarchy/tree.h"

namespace cscd::bench {
namespace {

// Directions of the k-DOPs of Klosowski et al. 1998: axes, then diagonals of faces, then of the cube.
constexpr int kAxes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr int kFaces[6][3] = {{1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, -1, 0}, {1, 0, -1}, {0, 1, -1}};
constexpr int kCorners[4][3] = {{1, 1, 1}, {1, -1, 1}, {1, 1, -1}, {1, -1, -1}};

// The first K / 2 of them; a 14-DOP has no diagonals of faces, a 16-DOP five; a 24-DOP three
// of the cube.
template <std::size_t K>
constexpr auto directions() {
  std::array<std::array<int, 3>, K / 2> all{};
  constexpr std::size_t faces = K == 6 || K == 14 ? 0 : K == 16 ? 5 : 6;
  std::size_t k = 0;
  for (const auto& d : kAxes) all[k++] = {d[0], d[1], d[2]};
  for (std::size_t i = 0; i < faces; ++i) all[k++] = {kFaces[i][0], kFaces[i][1], kFaces[i][2]};
  for (std::size_t i = 0; k < K / 2; ++i) all[k++] = {kCorners[i][0], kCorners[i][1], kCorners[i][2]};
  return all;
}

inline void round_below(double x, float& out) {
  out = float_below(x);
}
inline void round_below(double x, double& out) {
  out = x;
}

// at_least[k] along direction k, and along its negative from K / 2 on.
template <class Scalar, std::size_t K>
struct Dop {
  std::array<Scalar, K> at_least;

  static Dop of(const Vec3& p) {
    constexpr auto all = directions<K>();
    Dop dop;
    for (std::size_t k = 0; k < K / 2; ++k) {
      const auto& d = all[k];
      const double sum = d[0] * p.x() + d[1] * p.y() + d[2] * p.z();
      // Two additions, each within half an ulp; nothing is rounded along an axis.
      const double slack = k < 3 ? 0 : 4 * kUnitRoundoff * p.cwiseAbs().sum();
      round_below(sum - slack, dop.at_least[k]);
      round_below(-sum - slack, dop.at_least[K / 2 + k]);
    }
    return dop;
  }
  void unite(const Dop& other) {
    for (std::size_t k = 0; k < K; ++k) at_least[k] = std::min(at_least[k], other.at_least[k]);
  }
  bool overlaps(const Dop& other) const {
    int apart = 0;
    for (std::size_t k = 0; k < K / 2; ++k) {
      apart |= at_least[k] > -other.at_least[K / 2 + k];
      apart |= other.at_least[k] > -at_least[K / 2 + k];
    }
    return apart == 0;
  }
};

template <class Scalar, std::size_t K>
class DopCuller : public Culler {
 public:
  explicit DopCuller(const StrategyInput& setup)
      : mesh_(setup.mesh),
        tree_(build_tree(mesh_, setup.reference)),
        vertex_(mesh_.vertex_count()),
        node_(tree_.node_count()) {}

  void refit(const Motion& motion) override {
    for (std::size_t i = 0; i < vertex_.size(); ++i) {
      vertex_[i] = Volume::of(motion.start()[i]);
      vertex_[i].unite(Volume::of(motion.end()[i]));
    }
    for (auto node = static_cast<NodeIndex>(node_.size()) - 1; node >= 0; --node) {
      if (tree_.is_leaf(node)) {
        const Triangle& corner = mesh_.corners(tree_.triangle(node));
        at(node) = vertex_[+corner[0]];
        at(node).unite(vertex_[+corner[1]]);
        at(node).unite(vertex_[+corner[2]]);
      } else {
        at(node) = at(tree_.left(node));
        at(node).unite(at(tree_.right(node)));
      }
    }
  }

  CullCounts cull(TrianglePairSink& sink) override {
    tests_ = 0;
    self(0, sink);
    CullCounts counts;
    counts.bvot = tests_;
    return counts;
  }

 private:
  using Volume = Dop<Scalar, K>;
  Volume& at(NodeIndex node) { return node_[static_cast<std::size_t>(node)]; }

  void self(NodeIndex node, TrianglePairSink& sink) {
    if (tree_.is_leaf(node)) return;
    self(tree_.left(node), sink);
    self(tree_.right(node), sink);
    pair(tree_.left(node), tree_.right(node), sink);
  }
  void pair(NodeIndex a, NodeIndex b, TrianglePairSink& sink) {
    ++tests_;
    if (!at(a).overlaps(at(b))) return;
    const bool leaf_a = tree_.is_leaf(a), leaf_b = tree_.is_leaf(b);
    if (leaf_a && leaf_b) {
      sink.add(tree_.triangle(a), tree_.triangle(b));
    } else if (leaf_a) {
      pair(a, tree_.left(b), sink);
      pair(a, tree_.right(b), sink);
    } else if (leaf_b) {
      pair(tree_.left(a), b, sink);
      pair(tree_.right(a), b, sink);
    } else {
      for (const NodeIndex x : {tree_.left(a), tree_.right(a)})
        for (const NodeIndex y : {tree_.left(b), tree_.right(b)}) pair(x, y, sink);
    }
  }

  const TriangleMesh& mesh_;
  Tree tree_;
  std::vector<Volume> vertex_, node_;
  std::uint64_t tests_ = 0;
};

template <class Scalar, std::size_t K>
Prepared make(const StrategyInput& setup) {
  return {compose(std::make_unique<DopCuller<Scalar, K>>(setup), setup), {}};
}

constexpr VolumeRow kRows[] = {
    {"AABB, float", make<float, 6>},      {"14-DOP, float", make<float, 14>},
    {"16-DOP, float", make<float, 16>},   {"18-DOP, float", make<float, 18>},
    {"24-DOP, float", make<float, 24>},   {"26-DOP, float", make<float, 26>},
    {"AABB, double", make<double, 6>},    {"14-DOP, double", make<double, 14>},
    {"16-DOP, double", make<double, 16>}, {"18-DOP, double", make<double, 18>},
    {"24-DOP, double", make<double, 24>}, {"26-DOP, double", make<double, 26>},
};

}  // namespace

std::span<const VolumeRow> volume_rows() {
  return kRows;
}

}  // namespace cscd::bench
