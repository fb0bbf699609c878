#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scenes/catalog/scene.h"
#include "scenes/clip/clip.h"
#include "scenes/effects/sequence.h"

namespace cscd::scenes {

// Frames done so far, and how many there will be.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

// What one effect of a scene took: how often it ran, and the time of all that together.
struct EffectCost {
  std::string name;
  std::uint64_t evaluations = 0;
  double ms = 0;
};

// What generating took, and the digest of the frames.
struct Generated {
  std::vector<EffectCost> effects;  // those of the scene, in its order
  std::string digest;
};

// Hands the scene's shape to `begin`, which returns the sink of the frames; then runs the effects and appends
// frame by frame. `see` is called with the state of every frame, which tells more than the frame does: the
// shape with its weights, and the rotations of its bones. Throws InputError when the shape's counts are not
// the expected ones. Does not judge the digest.
using BeginFrames = std::function<FrameSink&(ClipHeader header)>;
using SeeState = std::function<void(const SceneState& state)>;
Generated run_scene(const Scene& scene, const BeginFrames& begin, const Progress& progress = {},
                    const SeeState& see = {});

// Throws InputError when the frames are not those that the scene file promises. A file without a digest
// promises nothing.
void require_expected_digest(const Scene& scene, const std::string& digest);

// All frames in memory, verified.
Clip generate(const Scene& scene, const Progress& progress = {});

}  // namespace cscd::scenes
