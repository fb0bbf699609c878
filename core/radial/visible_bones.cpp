#include "core/radial/visible_bones.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "core/radial/nearest_point.h"

// A bone heats a vertex directly if the shortest straight line between them stays inside the body (bone heat;
// Baran and Popovic, "Automatic Rigging and Animation of 3D Characters", SIGGRAPH 2007, section 4). In that
// paper, a vertex whose nearest bone is hidden gets no heat of its own. Here the nearest bone in sight heats
// it, so that fewer vertices depend on diffusion alone.
//
// Cost: vertices x bones distances. A line is traced to the nearest bone first, and to farther bones only
// while all nearer bones are hidden.

namespace cscd::radial {
namespace {

// Bones whose distances agree to this factor are equally near, as in the authors' program (Pinocchio). So a
// vertex that is nearest to a joint belongs to both bones of the joint, although rounding makes their
// distances differ.
constexpr double kEquallyNear = 1.0001;

using Candidate = std::pair<double, std::int32_t>;  // distance, bone

// Finds the nearest bones of vertices.
class Finder {
 public:
  Finder(std::span<const Bone> bones, const DistanceField& field) : bones_(bones), field_(field) {}

  // Appends the nearest bones of a vertex to `out`, ascending, and returns their distance. With `seen_only`,
  // only bones count that a line inside the body reaches.

  double append(const Vec3& vertex, bool seen_only, std::vector<BoneId>& out) {
    heap_.clear();
    for (std::size_t b = 0; b < bones_.size(); ++b)
      heap_.emplace_back(distance_to(bones_[b], vertex), static_cast<std::int32_t>(b));
    std::make_heap(heap_.begin(), heap_.end(), std::greater<>());

    const std::size_t first = out.size();
    double nearest = std::numeric_limits<double>::max();
    while (!heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
      const auto [distance, bone] = heap_.back();
      heap_.pop_back();
      const bool found = out.size() > first;
      if (found && !(distance <= kEquallyNear * nearest)) break;
      const Bone& b = bones_[static_cast<std::size_t>(bone)];
      if (seen_only && !runs_inside(field_, vertex, nearest_on_segment(vertex, b.head, b.tail))) continue;
      if (!found) nearest = distance;
      out.push_back(BoneId{bone});
    }
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end());
    return nearest;
  }

 private:
  std::span<const Bone> bones_;
  const DistanceField& field_;
  std::vector<Candidate> heap_;
};

}  // namespace

double distance_to(const Bone& bone, const Vec3& point) {
  const double distance = (point - nearest_on_segment(point, bone.head, bone.tail)).norm();
  return std::isfinite(distance) ? distance : std::numeric_limits<double>::max();
}

VisibleBones find_visible_bones(const TriangleMesh& mesh, std::span<const Vec3> positions,
                                std::span<const Bone> bones, const DistanceField& field) {
  const auto component_of = [&](VertexId v) {
    const std::span<const TriangleId> around = mesh.triangles_at(v);
    return around.empty() ? -1 : mesh.component(around.front());
  };
  Finder finder(bones, field);
  std::vector<bool> sees_any(static_cast<std::size_t>(mesh.component_count()), false);

  VisibleBones seen;
  const auto collect = [&](const VisibleBones* before) {
    VisibleBones out;
    out.offset.assign(1, 0);
    out.distance.assign(positions.size(), 0);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const std::int32_t component = component_of(VertexId{static_cast<std::int32_t>(i)});
      if (component >= 0) {
        const auto c = static_cast<std::size_t>(component);
        if (before == nullptr || !sees_any[c]) {
          out.distance[i] = finder.append(positions[i], before == nullptr, out.bones);
        } else {
          out.distance[i] = before->distance[i];
          out.bones.insert(out.bones.end(), before->of(i).begin(), before->of(i).end());
        }
      }
      out.offset.push_back(static_cast<std::int32_t>(out.bones.size()));
    }
    return out;
  };

  seen = collect(nullptr);
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (!seen.of(i).empty())
      sees_any[static_cast<std::size_t>(component_of(VertexId{static_cast<std::int32_t>(i)}))] = true;
  if (std::find(sees_any.begin(), sees_any.end(), false) == sees_any.end()) return seen;
  return collect(&seen);
}

}  // namespace cscd::radial
