#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "scenes/effects/keys.h"
#include "scenes/effects/rotation.h"
#include "scenes/effects/tree_pose.h"

namespace cscd::scenes {
namespace {

// Poses bones by keys, as an animator does. Every parameter other than those of keyframe_rows() names bones.
// If several parameters name a bone, their rotation vectors add up.
class Keyframes final : public Effect {
 public:
  Keyframes(const Parameters& p, const Shape& shape, std::span<const ParameterRow> rows)
      : envelope_(Envelope::from(p)), of_bone_(shape.rig.parent.size()) {
    require_tree(shape, p.where());
    const auto curve = [&](const std::string& name) {
      const std::string who = p.where() + ": parameter " + name;
      return p.has("period") ? KeyCurve::periodic(p.table(name), p.number("period"), who)
                             : KeyCurve(p.table(name), who);
    };
    for (const auto& [name, value] : p.values()) {
      bool own = false;
      for (const ParameterRow& row : rows) own = own || row.name == name;
      if (own && std::ranges::find(shape.bone_names, name) != shape.bone_names.end())
        throw InputError(p.where() + ": parameter " + name + " is the name of a bone too; rename the bone");
      if (own) continue;
      for (const std::size_t bone : select_bones(shape, name, p.where() + ": parameter " + name))
        of_bone_[bone].push_back(curves_.size());
      curves_.push_back(curve(name));
    }
    if (p.has("root")) root_ = curves_.size(), curves_.push_back(curve("root"));
  }

  void step(SceneState& state) override {
    pose_from_rest(state);
    const double weight = envelope_.at(state.time);
    if (weight == 0) return;
    std::vector<Vec3> values;
    for (const KeyCurve& curve : curves_)
      values.push_back(weight *
                       Vec3(curve.at(state.time, 1), curve.at(state.time, 2), curve.at(state.time, 3)));
    turn_bones(state, [&](std::size_t bone) {
      Vec3 turns = Vec3::Zero();
      for (const std::size_t curve : of_bone_[bone]) turns += values[curve];
      return rotation_by(turns);
    });
    if (root_ == SIZE_MAX) return;
    for (Bone& bone : state.bones) bone = {bone.head + values[root_], bone.tail + values[root_]};
  }

 private:
  Envelope envelope_;
  std::vector<KeyCurve> curves_;
  std::vector<std::vector<std::size_t>> of_bone_;  // [bones]: curves that turn the bone
  std::size_t root_ = SIZE_MAX;                    // the curve of the translation
};

std::vector<ParameterRow> keyframe_rows() {
  std::vector<ParameterRow> rows = with_envelope(
      {table_row("root", "frame, length", 4, "keys of frame, x, y, z: the translation of the whole skeleton")
           .optional(),
       number_row("period", "frame", "after so many frames the keys repeat; without it they do not",
                  {1e-9, 1e9})
           .optional()});
  rows.push_back(
      table_row("*", "frame, turn", 4,
                "names of bones, with blanks between and * for any text: keys of frame, x, y, z, the bones' "
                "rotation vector relative to their parents in the axes of the rest pose")
          .optional());
  return rows;
}

}  // namespace

EffectRow keyframes_row() {
  static const std::vector<ParameterRow> rows = keyframe_rows();
  return {"keyframes", "poses bones by keys of rotation, interpolated smoothly", Pace::substep, rows,
          [](const Parameters& parameters, const Shape& shape) -> std::unique_ptr<Effect> {
            return std::make_unique<Keyframes>(parameters, shape, std::span(rows).first(rows.size() - 1));
          }};
}

}  // namespace cscd::scenes
