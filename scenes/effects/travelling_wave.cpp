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
  static const std::vector<ParameterRow> rows = with_envelope({
      text_row("bones", "names of the chains' bones, with blanks between and * for any text"),
      vector_row("axis", "",
                 "axis about which all bones turn, in the axes of the rest pose; give this or towards")
          .optional(),
      vector_row("towards", "",
                 "where each bone leans first, in the axes of the rest pose; give this or axis")
          .optional(),
      number_row("amplitude", "turn", "amplitude of a chain's last bone", {-1, 1}),
      number_row("first_amplitude", "turn", "amplitude of a chain's first bone", {-1, 1}).or_else({0}),
      number_row("wave_length", "bone",
                 "length of the wave, below 0 for one that runs towards the first bone; without it all bones "
                 "swing as one",
                 {-1e9, 1e9})
          .optional(),
      number_row("period", "frame", "period of a bone's swing; without it the wave stands still", {1e-3, 1e9})
          .optional(),
      number_row("phase", "turn", "phase of the first bone at frame 0").or_else({0}),
      number_row("chain_phase", "turn", "phase from each chain to the next").or_else({0}),
  });
  return {"travelling_wave", "runs waves along chains of bones", Pace::substep, rows,
          make_effect<TravellingWave>};
}

}  // namespace cscd::scenes
