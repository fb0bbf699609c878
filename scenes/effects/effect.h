#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/rig.h"
#include "scenes/shape/parameters.h"
#include "scenes/shape/shape.h"

namespace cscd::scenes {

// What effects read and write: the pose and the surface at one moment. Time counts in frames; frame 0 is the
// shape at rest.
struct SceneState {
  explicit SceneState(const Shape& at_rest);

  const Shape& shape;
  double time = 0;  // of the moment that the current step leads to, in frames
  double step = 1;  // length of the current step, in frames
  std::vector<Bone> bones;
  std::vector<Eigen::Matrix3d> rotations;  // of each bone, from its reference pose
  std::vector<Vec3> positions;
  std::vector<Vec3> predicted;  // where the step was predicted to end; of an effect that predicts
  double posed = 0;             // the time for which kinematic effects have begun a pose from rest
  std::size_t steady_bone = 0;  // of a chain: the one that does not spin about its own axis
};

// One law of motion in one scene. Holds what it carries from step to step.
class Effect {
 public:
  virtual ~Effect() = default;
  // Brings the state from time - step to time, as far as this law goes.
  virtual void step(SceneState& state) = 0;
};

// How often an effect runs. Neighbours in a scene's list that run in substeps take turns within each substep.
enum class Pace { substep, frame };

// One row of the list of effects. `make` gets checked parameters and the shape, and throws InputError when
// the shape is not what the effect needs.
struct EffectRow {
  std::string_view name;
  std::string_view description;
  Pace pace;
  std::span<const ParameterRow> parameters;
  std::unique_ptr<Effect> (*make)(const Parameters& parameters, const Shape& shape);
  bool predicts = false;  // leaves a prediction in the state at every step, and corrected positions
};

// All effects there are.
std::span<const EffectRow> effects();

}  // namespace cscd::scenes
