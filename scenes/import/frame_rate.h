#pragma once

#include <optional>
#include <string>

#include "scenes/character/character.h"
#include "scenes/character/report.h"

// How many frames a second a model file has.
namespace cscd::scenes {

struct FrameRate {
  double fps;
  std::string from;  // as ImportReport::fps_from
};

// Returns the rate that was asked for, or else the file's own, or else kAssumedFps. A file has one rate,
// which all of its clips share: the number that it states (FBX's time mode; assimp's ticks a second where
// they are a rate of frames and no unit of time), or else what its keys say. Keys say a rate where those of a
// clip are evenly spaced, at least 20 a second, and where no other clip of the file says another. Keys
// farther apart are no frames: the motion between them has to be sampled more finely.
FrameRate frame_rate(const Character& character, std::optional<double> asked);

}  // namespace cscd::scenes
