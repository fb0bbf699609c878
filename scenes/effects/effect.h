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

// The pose and the surface at one moment, which effects read and write. Times are in frames. Frame 0 is the
// shape at rest.
struct SceneState {
  explicit SceneState(const Shape& at_rest);

  const Shape& shape;
  double time = 0;                         // the moment to which the current step leads, in frames
  double step = 1;                         // length of the current step, in frames
  std::vector<Bone> bones;                 // [bones]
  std::vector<Eigen::Matrix3d> rotations;  // [bones]: rotation of each bone from its reference pose
  std::vector<Vec3> positions;             // [vertices]
  std::vector<Vec3> predicted;             // [vertices]: predicted end of the step, if an effect predicts
  double posed = 0;                        // the time for which kinematic effects have begun a pose from rest
  std::size_t steady_bone = 0;             // the bone of a chain that does not spin about its own axis
};

// One law of motion in one scene. An effect holds the data that it carries from step to step.
class Effect {
 public:
  virtual ~Effect() = default;
  // Brings the state from time - step to time, as far as this law is concerned.
  virtual void step(SceneState& state) = 0;
};

// How often an effect runs. Neighbouring effects in a scene's list that run in substeps take turns within
// each substep.
enum class Pace { substep, frame };

// One row of the list of effects. `make` takes parameters as `checked` returns them and the shape, and throws
// InputError if the effect cannot work on that shape.
struct EffectRow {
  std::string_view name;
  std::string_view description;
  Pace pace;
  std::span<const ParameterRow> parameters;
  std::unique_ptr<Effect> (*make)(const Parameters& parameters, const Shape& shape);
  bool predicts = false;    // each step leaves a prediction in the state beside the corrected positions
  bool of_surface = false;  // moves the vertices by their own masses, so that no skeleton carries the motion
};

// The `make` of most rows: constructs an effect from both arguments.
template <class Each>
std::unique_ptr<Effect> make_effect(const Parameters& parameters, const Shape& shape) {
  return std::make_unique<Each>(parameters, shape);
}

// All effects that a scene file can name.
std::span<const EffectRow> effects();

}  // namespace cscd::scenes
