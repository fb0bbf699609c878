#include "scenes/catalog/generate.h"

#include <chrono>
#include <optional>

#include "core/base/error.h"
#include "scenes/catalog/shapes.h"
#include "scenes/clip/digest.h"

namespace cscd::scenes {
namespace {

void require_count(const Scene& scene, const std::string& what, std::size_t found,
                   const std::optional<std::size_t>& expected) {
  if (expected && found != *expected)
    throw InputError("scene " + scene.name + ": the shape has " + std::to_string(found) + " " + what +
                     ", the scene file expects " + std::to_string(*expected) + "; correct one of them");
}

// Measures the time of each effect: the time between two calls of enter() counts for the
// effect of the first call.
class EffectClock {
 public:
  explicit EffectClock(std::size_t effects) : ms_(effects + 1), running_(effects) {}
  void enter(std::size_t effect) {
    const auto now = std::chrono::steady_clock::now();
    ms_[running_] += std::chrono::duration<double, std::milli>(now - since_).count();
    running_ = effect, since_ = now;
  }
  double ms(std::size_t effect) const { return ms_[effect]; }

 private:
  std::vector<double> ms_;  // [effects + 1]; the last is the time between the effects of two frames
  std::size_t running_;
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
};

}  // namespace

Generated run_scene(const Scene& scene, const BeginFrames& begin, const Progress& progress,
                    const SeeState& see) {
  const Shape shape = make_shape(scene.shape, scene.shape_parameters);
  require_count(scene, "vertices", shape.positions.size(), scene.expected.vertices);
  require_count(scene, "triangles", shape.triangles.size(), scene.expected.triangles);
  require_count(scene, "bones", shape.rig.parent.size(), scene.expected.bones);
  EffectSequence effects(scene.effects, shape, scene.substeps);
  FrameSink& sink = begin({shape.triangles, shape.positions.size(), shape.rig.parent, effects.predicts()});

  EffectClock clock(effects.size());
  SceneState state(shape);
  FrameDigest digest;
  for (std::size_t frame = 0; frame < scene.frames; ++frame) {
    if (frame > 0) effects.advance(state, static_cast<int>(frame), [&](std::size_t i) { clock.enter(i); });
    const FrameView view{state.positions, state.bones};
    // The bones move as the animation has them, even where the surface is held back.
    const FrameView predicted{state.predicted, state.bones};
    const FrameView* prediction = effects.predicts() && frame > 0 ? &predicted : nullptr;
    sink.append(view, prediction);
    digest.add(view, prediction);
    if (see) see(state);
    if (progress) progress(frame + 1, scene.frames);
  }

  Generated generated;
  for (std::size_t i = 0; i < effects.size(); ++i)
    generated.effects.push_back({std::string(effects.name(i)), effects.evaluations(i), clock.ms(i)});
  generated.bone_names = shape.bone_names;
  generated.digest = digest.text();
  return generated;
}

void require_expected_digest(const Scene& scene, const std::string& digest) {
  if (scene.expected.digest && digest != *scene.expected.digest)
    throw InputError("scene " + scene.name + ": the frames have digest " + digest +
                     ", the scene file expects " + *scene.expected.digest +
                     "; after a wanted change look at the frames, then accept them with cscd scene accept");
}

Clip generate(const Scene& scene, const Progress& progress) {
  std::optional<Clip> clip;
  const Generated generated = run_scene(
      scene, [&](ClipHeader header) -> FrameSink& { return clip.emplace(std::move(header)); }, progress);
  require_expected_digest(scene, generated.digest);
  return std::move(*clip);
}

}  // namespace cscd::scenes
