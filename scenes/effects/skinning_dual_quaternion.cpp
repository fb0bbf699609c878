#include <algorithm>
#include <cmath>

#include "scenes/effects/effect.h"
#include "scenes/effects/rotation.h"

namespace cscd::scenes {
namespace {

// Dual quaternion skinning (Kavan, Collins, Zara, O'Sullivan, "Geometric skinning with approximate dual
// quaternion blending", ACM TOG 27(4), 2008), without scale.
//
// Each vertex is carried by a rigid motion between the rigid motions of its bones. So a twisted limb keeps
// its thickness, while linear blending lets it collapse. Every quaternion stands for the same motion as its
// negative. The quaternion of a bone is taken with the sign that brings it nearer to the bone of the
// largest weight, so that blended quaternions never cancel out.
struct Quaternion {
  double w;
  Vec3 v;
};

Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - a.v.dot(b.v), a.w * b.v + b.w * a.v + a.v.cross(b.v)};
}
double dot(const Quaternion& a, const Quaternion& b) {
  return a.w * b.w + a.v.dot(b.v);
}
void add(Quaternion& sum, double weight, const Quaternion& q) {
  sum.w += weight * q.w;
  sum.v += weight * q.v;
}

struct DualQuaternion {
  Quaternion real, dual;
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
      const Quaternion real = quaternion(state.rotations[bone]);
      motion_[bone] = {real, Quaternion{0, moved / 2} * real};
    }
    for (std::size_t vertex = 0; vertex < state.positions.size(); ++vertex) {
      const JointWeights& weights = state.shape.weights[vertex];
      if (!weights.has_bones()) continue;  // cloth that moves by itself
      state.positions[vertex] = carried(weights, state.shape.positions[vertex]);
    }
  }

 private:
  Vec3 carried(const JointWeights& weights, const Vec3& at) const {
    const auto heaviest = std::ranges::max_element(weights.weight) - weights.weight.begin();
    const Quaternion& pivot = motion_[+weights.bone[heaviest]].real;
    DualQuaternion sum{{0, Vec3::Zero()}, {0, Vec3::Zero()}};
    for (std::size_t k = 0; k < JointWeights::most && weights.bone[k] != BoneId{-1}; ++k) {
      const DualQuaternion& motion = motion_[+weights.bone[k]];
      const double weight = dot(pivot, motion.real) < 0 ? -weights.weight[k] : weights.weight[k];
      add(sum.real, weight, motion.real);
      add(sum.dual, weight, motion.dual);
    }
    const double length = std::sqrt(dot(sum.real, sum.real));
    const double w = sum.real.w / length, dual_w = sum.dual.w / length;
    const Vec3 v = sum.real.v / length, dual_v = sum.dual.v / length;
    return at + 2 * v.cross(v.cross(at) + w * at) + 2 * (w * dual_v - dual_w * v + v.cross(dual_v));
  }

  std::vector<DualQuaternion> motion_;  // [bones]: motion from the reference pose
};

}  // namespace

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
