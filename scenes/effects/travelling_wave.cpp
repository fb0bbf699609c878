#include <limits>

#include "core/base/error.h"
#include "scenes/effects/keys.h"
#include "scenes/effects/rotation.h"
#include "scenes/effects/tree_pose.h"

namespace cscd::scenes {
namespace {

// A wave that runs along chains of bones, as through tentacles and tails. With angles in turns and times in
// frames, the bone at place s of chain c, which has n + 1 places, turns by
//   envelope(time) (a + (b - a) s / n) sin(time / period - s / wave_length + phase + c chain_phase).
// The amplitude goes from a at the first bone to b at the last bone. Without a period and a wave length, at
// phase 1/4, the wave is a bend.
class TravellingWave final : public Effect {
 public:
  TravellingWave(const Parameters& p, const Shape& shape)
      : envelope_(Envelope::from(p)),
        frequency_(p.has("period") ? 1 / p.number("period") : 0),
        turn_(shape.rig.parent.size(), Turn{Vec3::Zero(), 0, 0}) {
    require_tree(shape, p.where());
    if (p.has("axis") == p.has("towards"))
      throw InputError(p.where() + ": give one of the parameters axis and towards");
    const double wave_length = p.number("wave_length", std::numeric_limits<double>::infinity());
    if (wave_length == 0) throw InputError(p.where() + ": parameter wave_length must not be 0");
    const Vec3 given = p.vector(p.has("axis") ? "axis" : "towards");
    const double first = p.number("first_amplitude"), last = p.number("amplitude");
    for (const ChainBone& at : select_chains(shape, p.text("bones"), p.where())) {
      const Bone& bone = shape.rig.reference[at.bone];
      const Vec3 axis = p.has("axis") ? given : (bone.tail - bone.head).cross(given);
      if (!(axis.norm() > 0))
        throw InputError(p.where() + ": bone " + shape.bone_names[at.bone] +
                         " lies along the direction to turn towards, or that is zero; choose another");
      const auto place = static_cast<double>(at.place), chain = static_cast<double>(at.chain);
      const double share = at.length > 0 ? place / static_cast<double>(at.length) : 1;
      turn_[at.bone] = {axis.normalized(), first + (last - first) * share,
                        p.number("phase") + chain * p.number("chain_phase") - place / wave_length};
    }
  }

  void step(SceneState& state) override {
    pose_from_rest(state);
    const double weight = envelope_.at(state.time);
    if (weight == 0) return;
    turn_bones(state, [&](std::size_t bone) -> Eigen::Matrix3d {
      const Turn& turn = turn_[bone];
      if (turn.amplitude == 0) return Eigen::Matrix3d::Identity();
      const double sine = circle_point(state.time * frequency_ + turn.phase).sine;
      return rotation_about(turn.axis, weight * turn.amplitude * sine);
    });
  }

 private:
  struct Turn {
    Vec3 axis;
    double amplitude, phase;
  };
  Envelope envelope_;
  double frequency_;
  std::vector<Turn> turn_;  // [bones]
};

}  // namespace

EffectRow travelling_wave_row() {
  static const ParameterRow rows[] = {
      {.name = "bones",
       .kind = ParameterKind::text,
       .meaning = "names of the chains' bones, with blanks between and * for any text"},
      {.name = "axis",
       .kind = ParameterKind::vector,
       .meaning = "axis about which all bones turn, in the axes of the rest pose; give this or towards",
       .required = false},
      {.name = "towards",
       .kind = ParameterKind::vector,
       .meaning = "where each bone leans first, in the axes of the rest pose; give this or axis",
       .required = false},
      {.name = "amplitude",
       .kind = ParameterKind::number,
       .unit = "turn",
       .meaning = "amplitude of a chain's last bone",
       .least = -1,
       .most = 1},
      {.name = "first_amplitude",
       .kind = ParameterKind::number,
       .unit = "turn",
       .meaning = "amplitude of a chain's first bone",
       .required = false,
       .least = -1,
       .most = 1,
       .otherwise = {0}},
      {.name = "wave_length",
       .kind = ParameterKind::number,
       .unit = "bone",
       .meaning = "length of the wave, below 0 for one that runs towards the first bone; without it all "
                  "bones swing as one",
       .required = false,
       .least = -1e9,
       .most = 1e9},
      {.name = "period",
       .kind = ParameterKind::number,
       .unit = "frame",
       .meaning = "period of a bone's swing; without it the wave stands still",
       .required = false,
       .least = 1e-3,
       .most = 1e9},
      {.name = "phase",
       .kind = ParameterKind::number,
       .unit = "turn",
       .meaning = "phase of the first bone at frame 0",
       .required = false,
       .otherwise = {0}},
      {.name = "chain_phase",
       .kind = ParameterKind::number,
       .unit = "turn",
       .meaning = "phase from each chain to the next",
       .required = false,
       .otherwise = {0}},
      {.name = "start",
       .kind = ParameterKind::number,
       .unit = "frame",
       .meaning = "frame before which the effect does nothing",
       .required = false,
       .otherwise = {0}},
      {.name = "end",
       .kind = ParameterKind::number,
       .unit = "frame",
       .meaning = "frame after which the effect does nothing; without it the effect goes on",
       .required = false},
      {.name = "fade",
       .kind = ParameterKind::number,
       .unit = "frame",
       .meaning = "frames in which the effect comes, and in which it goes",
       .required = false,
       .least = 0,
       .most = 1e9,
       .otherwise = {0}},
      {.name = "weight",
       .kind = ParameterKind::number,
       .meaning = "factor on the whole effect",
       .required = false,
       .otherwise = {1}},
  };
  return {"travelling_wave", "runs waves along chains of bones", Pace::substep, rows,
          [](const Parameters& parameters, const Shape& shape) -> std::unique_ptr<Effect> {
            return std::make_unique<TravellingWave>(parameters, shape);
          }};
}

}  // namespace cscd::scenes
