#include "core/session/candidates.h"

#include <algorithm>
#include <limits>

#include "core/detect/carried_pairs.h"
#include "core/hierarchy/descent.h"

namespace cscd {
namespace {

struct Box {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;

  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

template <class Vertices>
Box box_of(const Motion& motion, const Vertices& vertices) {
  Box box;
  for (const VertexId v : vertices) {
    box.add(motion.start()[+v]);
    box.add(motion.end()[+v]);
  }
  return box;
}

// The difference of two bounds rounds by half a unit in its last place, and the radius gives way by more.
bool within(const Box& a, const Box& b, double radius) {
  constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();
  for (int k = 0; k < 3; ++k) {
    const double gap = std::max(a.low[k] - b.high[k], b.low[k] - a.high[k]);
    if (gap > radius + kRounding * (radius + std::abs(gap))) return false;
  }
  return true;
}

bool within(const TriangleMesh& mesh, const Motion& motion, const FeaturePair& pair, double radius) {
  if (pair.kind == FeaturePair::Kind::vertex_face)
    return within(box_of(motion, std::array{VertexId{pair.a}}),
                  box_of(motion, mesh.corners(TriangleId{pair.b})), radius);
  return within(box_of(motion, mesh.ends(EdgeId{pair.a})), box_of(motion, mesh.ends(EdgeId{pair.b})), radius);
}

}  // namespace

void CandidateSearch::find(const Motion& motion, double radius, std::vector<FeaturePair>& out) {
  out.clear();
  met_.start_interval();
  bounds_.refit(motion, radius / 2);
  const auto is_leaf = [&](NodeIndex node) { return tree_.is_leaf(node); };
  const auto skip_none = [](NodeIndex, NodeIndex) { return false; };
  const auto take = [&](NodeIndex a, NodeIndex b) {
    const TrianglePair triangles{tree_.triangle(a), tree_.triangle(b)};
    if (exclusions_ != nullptr && exclusions_->excludes(mesh_, triangles)) return;
    for_each_carried(mesh_, triangles, [&](const FeaturePair& pair) {
      if (!within(mesh_, motion, pair, radius) || !met_.insert(pair)) return;
      if (exclusions_ == nullptr || !exclusions_->excludes(mesh_, pair)) out.push_back(pair);
    });
  };
  self_descent(tree_, bounds_, 0, is_leaf, skip_none, take);
}

}  // namespace cscd
