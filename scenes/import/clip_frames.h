#pragma once

#include <functional>
#include <span>

#include "scenes/character/character.h"
#include "scenes/character/options.h"
#include "scenes/character/pose.h"
#include "scenes/character/report.h"

// Which clip of a character is shown, and by which poses.
namespace cscd::scenes {

// A pose of the nodes with the weights of the morph targets.
struct Moment {
  Pose pose;
  MorphWeights weights;
};

// The frames of a clip: every 1 / fps seconds from its start, and its end. The last frame is the clip's end,
// so the last interval is shorter where the length is no whole number of frames.
std::size_t frames_of(double seconds, double fps);
// When a frame is shown, in seconds after the clip's start.
double second_of_frame(std::size_t frame, double seconds, double fps);

// The moments to be written, one after the other.
struct Frames {
  std::size_t count = 0;
  std::function<Moment(std::size_t)> moment;
};

// Chooses the clip that the options name, and tells the report of it: by its name, else by its number, else
// by its name without regard to case. Without a name, the first clip that moves one of the `used` raw
// vertices. For a survey: the bind pose, and the start of every clip. Throws InputError for a clip that there
// is not, or that is not one only, and where nothing moves.
Frames plan_frames(const Character& character, const Pose& bound, const std::vector<bool>& used,
                   double diagonal, const ImportOptions& options, ImportReport& report);

}  // namespace cscd::scenes
