#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scenes/catalog/scene.h"
#include "scenes/clip/clip.h"
#include "scenes/effects/sequence.h"

namespace cscd::scenes {

// Called with the number of frames done so far and the number of all frames.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

// The cost of one effect of a scene: how often the effect ran, and the time of all its runs together.
struct EffectCost {
  std::string name;
  std::uint64_t evaluations = 0;
  // milliseconds
  double ms = 0;
};

// The cost of generating a scene, and the digest of its frames.
struct Generated {
  std::vector<EffectCost> effects;  // effects of the scene, in its order
  std::vector<std::string> bone_names;
  std::string digest;
};

// Runs a scene. Hands the header of the scene's shape to `begin`, which returns the sink of the frames;
// then runs the effects and appends frame by frame. `see` is called with the state of every frame, which
// holds more than the frame does: the shape with its weights, and the rotations of its bones. Throws
// InputError if the shape's counts differ from the expected counts. The caller compares the digest
// (require_expected_digest).
using BeginFrames = std::function<FrameSink&(ClipHeader header)>;
using SeeState = std::function<void(const SceneState& state)>;
Generated run_scene(const Scene& scene, const BeginFrames& begin, const Progress& progress = {},
                    const SeeState& see = {});

// Throws InputError if the digest differs from the digest in the scene file. A file without a digest
// accepts all frames.
void require_expected_digest(const Scene& scene, const std::string& digest);

// Generates all frames in memory and verifies their digest.
Clip generate(const Scene& scene, const Progress& progress = {});

}  // namespace cscd::scenes
