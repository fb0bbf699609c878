#include "scenes/effects/effect.h"
#include "scenes/effects/rotation.h"

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

}  // namespace cscd::scenes
