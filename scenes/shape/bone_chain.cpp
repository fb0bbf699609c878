#include "scenes/shape/bone_chain.h"

#include <algorithm>
#include <cmath>

namespace cscd::scenes {

JointWeights spline_weights(double place, int bones) {
  const int centre = std::clamp(static_cast<int>(std::floor(place)), 0, bones - 1);
  const double t = std::clamp(place - centre, 0.0, 1.0);
  const double share[3] = {(1 - t) * (1 - t) / 2, 0.75 - (t - 0.5) * (t - 0.5), t * t / 2};
  JointWeights weights;
  std::size_t used = 0;
  for (int k = -1; k <= 1; ++k) {
    const BoneId bone{std::clamp(centre + k, 0, bones - 1)};
    const double amount = share[k + 1];
    if (amount == 0) continue;
    if (used > 0 && weights.bone[used - 1] == bone) {
      weights.weight[used - 1] += amount;
    } else {
      weights.bone[used] = bone;
      weights.weight[used++] = amount;
    }
  }
  return weights;
}

void append_chain(std::span<const Vec3> joints, Shape& shape) {
  for (std::size_t bone = 0; bone + 1 < joints.size(); ++bone) {
    shape.rig.parent.push_back(BoneId{static_cast<int>(bone) - 1});
    shape.rig.reference.push_back({joints[bone], joints[bone + 1]});
    shape.bone_names.push_back("bone_" + std::to_string(bone));
  }
}

}  // namespace cscd::scenes
