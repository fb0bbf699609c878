#include <algorithm>
#include <cmath>

#include "scenes/effects/effect.h"
#include "scenes/effects/rotation.h"
#include "scenes/shape/dual_quaternion.h"

namespace cscd::scenes {

namespace {

// Linear blend skinning (Magnenat-Thalmann, Laperriere, Thalmann, "Joint-dependent local deformations for
// hand animation and object grasping", Graphics Interface 1988). Each vertex is the weighted mean of the
// places to which its bones would carry the vertex. Bones turn about their heads and do not stretch.
class SkinningLinear final : public Effect {
 public:
  void step(SceneState& state) override {
    const std::vector<Bone>& reference = state.shape.rig.reference;
    offset_.resize(reference.size());
    for (std::size_t bone = 0; bone < reference.size(); ++bone)
      offset_[bone] = state.bones[bone].head - rotated(state.rotations[bone], reference[bone].head);
    for (std::size_t vertex = 0; vertex < state.positions.size(); ++vertex) {
      const JointWeights& weights = state.shape.weights[vertex];
      if (!weights.has_bones()) continue;  // cloth that moves by itself
      Vec3 blended = Vec3::Zero();
      for (std::size_t k = 0; k < JointWeights::most && weights.bone[k] != BoneId{-1}; ++k) {
        const std::size_t bone = +weights.bone[k];
        blended += weights.weight[k] *
                   (rotated(state.rotations[bone], state.shape.positions[vertex]) + offset_[bone]);
      }
      state.positions[vertex] = blended;
    }
  }

 private:
  std::vector<Vec3> offset_;
};

struct Quaternion {
  double w;
  Vec3 v;
};

// The quaternion of a rotation matrix, computed from its largest component (Shepperd, "Quaternion from
// rotation matrix", J. Guidance and Control 1978).
Quaternion quaternion(const Eigen::Matrix3d& r) {
  const double trace = r(0, 0) + r(1, 1) + r(2, 2);
  int largest = 0;
  for (const int i : {1, 2})
    if (r(i, i) > r(largest, largest)) largest = i;
  const Vec3 skew(r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1));
  if (trace > r(largest, largest)) {
    const double twice = std::sqrt(1 + trace);
    return {twice / 2, skew / (2 * twice)};
  }
  const int i = largest, j = (i + 1) % 3, k = (i + 2) % 3;
  const double twice = std::sqrt(1 + r(i, i) - r(j, j) - r(k, k));
  Quaternion q{skew[i] / (2 * twice), Vec3::Zero()};
  q.v[i] = twice / 2;
  q.v[j] = (r(i, j) + r(j, i)) / (2 * twice);
  q.v[k] = (r(k, i) + r(i, k)) / (2 * twice);
  return q;
}

class SkinningDualQuaternion final : public Effect {
 public:
  void step(SceneState& state) override {
    const std::vector<Bone>& reference = state.shape.rig.reference;
    motion_.resize(reference.size());
    for (std::size_t bone = 0; bone < reference.size(); ++bone) {
      const Vec3 moved = state.bones[bone].head - rotated(state.rotations[bone], reference[bone].head);
      const Quaternion turn = quaternion(state.rotations[bone]);
      motion_[bone] = rigid_motion(turn.w, turn.v, moved);
    }
    for (std::size_t vertex = 0; vertex < state.positions.size(); ++vertex) {
      const JointWeights& weights = state.shape.weights[vertex];
      if (!weights.has_bones()) continue;  // cloth that moves by itself
      state.positions[vertex] = carried(blended(weights), state.shape.positions[vertex]);
    }
  }

 private:
  DualQuaternion blended(const JointWeights& weights) const {
    const auto heaviest = std::ranges::max_element(weights.weight) - weights.weight.begin();
    const DualQuaternion& pivot = motion_[+weights.bone[heaviest]];
    DualQuaternion sum;
    for (std::size_t k = 0; k < JointWeights::most && weights.bone[k] != BoneId{-1}; ++k)
      add_motion(sum, weights.weight[k], motion_[+weights.bone[k]], pivot);
    return sum;
  }

  std::vector<DualQuaternion> motion_;  // [bones]: motion from the reference pose
};

}  // namespace

EffectRow skinning_linear_row() {
  return {"skinning_linear",
          "linear blend skinning: the surface follows the weighted mean of its bones",
          Pace::frame,
          {},
          [](const Parameters&, const Shape&) -> std::unique_ptr<Effect> {
            return std::make_unique<SkinningLinear>();
          }};
}

EffectRow skinning_dual_quaternion_row() {
  return {"skinning_dual_quaternion",
          "dual quaternion skinning: the surface follows a rigid motion between those of its bones",
          Pace::frame,
          {},
          [](const Parameters&, const Shape&) -> std::unique_ptr<Effect> {
            return std::make_unique<SkinningDualQuaternion>();
          }};
}

}  // namespace cscd::scenes
