#include "core/session/near_list.h"

#include <algorithm>
#include <limits>

#include "core/detect/carried_pairs.h"
#include "core/detect/contact_geometry.h"
#include "core/detect/filter_block.h"
#include "core/elementary/exact/static_contact.h"
#include "core/geometry/nearest_points.h"

namespace cscd {
namespace {

// The distance of what two triangles carry, in a pose, is at least this.
double least_distance(const TriangleMesh& mesh, std::span<const Vec3> pose, const CarriedPairs& carried) {
  double least = std::numeric_limits<double>::infinity();
  for_each_carried(mesh, carried, [&](const FeaturePair& pair) {
    const auto [p, q, r, s] = vertices_of(mesh, pair);
    const std::array<Vec3, 4> points{pose[+p], pose[+q], pose[+r], pose[+s]};
    const bool is_face = pair.kind == FeaturePair::Kind::vertex_face;
    const Nearest nearest = is_face ? nearest_of_vertex_face(points) : nearest_of_edges(points);
    least = std::min(least, distance_bounds(points, is_face ? 1 : 2, nearest.way).low);
  });
  return least;
}

}  // namespace

NearCollector::NearCollector(const TriangleMesh& mesh, std::span<const Vec3> pose, std::size_t most,
                             double reach, std::vector<NearPair>& out)
    : mesh_(mesh), pose_(pose), most_(most), reach_(reach), out_(out) {}

void NearCollector::take(const std::vector<TrianglePair>& block) {
  const Motion rest(pose_, pose_);
  for (std::size_t first = 0; first < block.size(); first += kLanes16) {
    const auto pairs = std::span(block).subspan(first, std::min(kLanes16, block.size() - first));
    const auto before = no_contact_before(mesh_, rest, pairs, reach_);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (before[i] > 1) continue;
      if (triangles_meet(mesh_, pose_, pairs[i].a, pairs[i].b)) {
        out_.push_back({0, pairs[i]});
        continue;
      }
      const Triangle &a = mesh_.corners(pairs[i].a), &b = mesh_.corners(pairs[i].b);
      const CarriedPlaces near = not_farther_than(reach_, rest, a, b, carried_by(a, b));
      if (near == 0) continue;
      const double low = least_distance(mesh_, pose_, {pairs[i], near});
      if (low <= reach_) out_.push_back({low, pairs[i]});
    }
    if (out_.size() > most_) reach_less_far();
    if (closed()) return;
  }
}

void NearCollector::reach_less_far() {
  const auto middle = out_.begin() + static_cast<std::ptrdiff_t>(most_ / 2);
  std::ranges::nth_element(out_, middle, {}, &NearPair::low);
  reach_ = middle->low;
  std::erase_if(out_, [&](const NearPair& near) { return near.low > reach_; });
  if (out_.size() > most_ || !(reach_ > 0)) close();
}

}  // namespace cscd
