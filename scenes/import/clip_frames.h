#pragma once

#include <functional>
#include <span>

#include "scenes/character/character.h"
#include "scenes/character/options.h"
#include "scenes/character/pose.h"
#include "scenes/character/report.h"

// Chooses the clip of a character that is imported, and the poses that its frames show.
namespace cscd::scenes {

// A pose of the nodes together with the weights of the morph targets.
struct Moment {
  Pose pose;
  MorphWeights weights;
};

// Returns the number of frames of a clip that lasts `seconds`: one frame every 1 / fps seconds
// from the clip's start, and one at the clip's end. The last interval is shorter where the length
// is no whole number of frames.
std::size_t frames_of(double seconds, double fps);
// Returns when a frame of such a clip is shown, in seconds after the clip's start.
double second_of_frame(std::size_t frame, double seconds, double fps);
// Returns the number of the frame at a moment of the file's time line, whose frame 0 is at 0 seconds.
double frame_number(double seconds, double fps);

// Moves the keys that lie a hair beside a frame onto it, because times in files are rounded. A jump whose key
// lies behind its frame would leave the frame the value before the jump, and a pulse of one frame could lie
// between two frames.
void put_keys_on_frames(Character& character, double fps);

// The moments that the import writes, one after the other.
struct Frames {
  std::size_t count = 0;
  std::function<Moment(std::size_t)> moment;
};

// Chooses the clip that the options name and plans its frames at the report's rate; records the choice in the
// report. A name is looked for exactly first, then as the number of a clip, then without regard to case.
// Without a name, the first clip is chosen that moves one of the vertices in use (`used`, [raw vertices]) by
// more than rounding, measured by `diagonal`. A survey gets the bind pose `bound` and the start of every clip
// instead. Where the options take one pose, a clip that is
// one pose gives two equal frames, and so does a file without clips. Throws InputError if no clip or several
// clips fit the name, and if no clip moves the surface.
Frames plan_frames(const Character& character, const Pose& bound, const std::vector<bool>& used,
                   double diagonal, const ImportOptions& options, ImportReport& report);

}  // namespace cscd::scenes
