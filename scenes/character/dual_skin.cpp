#include "scenes/character/dual_skin.h"

#include <algorithm>

#include "core/base/error.h"

namespace cscd::scenes {
namespace {

// Two axes count as perpendicular if the cosine of their angle is at most this. Files round matrices to
// single precision.
constexpr double kPerpendicular = 1e-5;

const char* fault_of(const Transform& map) {
  const auto& c = map.column;
  const double length[3] = {c[0].norm(), c[1].norm(), c[2].norm()};
  if (!(std::min({length[0], length[1], length[2]}) > 0) || !map.finite()) return "is scaled to nothing";
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!(std::abs(c[i].dot(c[j])) <= kPerpendicular * length[i] * length[j])) return "is sheared";
  return nullptr;
}

}  // namespace

DualSkin::DualSkin(const Character& character, const Part& part, std::span<const Transform> joints)
    : character_(character), part_(part) {
  for (const Transform& map : joints) {
    const Trs parts = trs_of(map);
    const Quaternion& q = parts.rotation;
    motion_.push_back({rigid_motion(q.w, {q.x, q.y, q.z}, parts.move),
                       {parts.rest[0].x(), parts.rest[1].y(), parts.rest[2].z()},
                       fault_of(map)});
  }
}

Vec3 DualSkin::moved(std::size_t vertex, const Vec3& point) const {
  const std::span<const Influence> influences(part_.influences.data() + part_.first[vertex],
                                              part_.first[vertex + 1] - part_.first[vertex]);
  const Influence& heaviest =
      *std::max_element(influences.begin(), influences.end(),
                        [](const Influence& a, const Influence& b) { return a.weight < b.weight; });
  const auto motion_of = [this](const Influence& i) -> const Motion& {
    return motion_[static_cast<std::size_t>(i.joint)];
  };
  const Motion& pivot = motion_of(heaviest);
  DualQuaternion sum;
  Vec3 scale = Vec3::Zero();
  for (const Influence& influence : influences) {
    const Motion& motion = motion_of(influence);
    if (motion.fault != nullptr) refuse(influence.joint, motion.fault);
    // Only the last axis of a map that mirrors has a negative scale (parts_of).
    if ((motion.scale.z() < 0) != (pivot.scale.z() < 0))
      refuse(influence.joint, "mirrors unlike another bone");
    add_motion(sum, influence.weight, motion.rigid, pivot.rigid);
    scale += influence.weight * motion.scale;
  }
  return carried(sum, scale.cwiseProduct(point));
}

void DualSkin::refuse(int joint, const char* fault) const {
  const int node = part_.joints[static_cast<std::size_t>(joint)].node;
  throw InputError("mesh '" + part_.name + "', bone '" +
                   character_.nodes[static_cast<std::size_t>(node)].name + "': " + fault +
                   " in some pose, where dual quaternions have no meaning; choose linear " +
                   "skinning on export");
}

}  // namespace cscd::scenes
