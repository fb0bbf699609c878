#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "bench/answer/clip_answer.h"

// What lies in what, as text.
namespace cscd::bench {

// "14.25": the number of a frame, to its hundredths.
std::string frame_text(const Input& input, const ClipMoment& moment);
// "frame 14.25 (0.475 s)".
std::string moment_text(const Input& input, const ClipMoment& moment);

// "hand_l in thigh_l: 1.2 cm deep (at most 1.9 cm), 38 vertices, frames 12 to 31, deepest at 20".
std::string event_text(const Input& input, const OverlapEvent& event);

// Returns the number of the event of which a verdict speaks first: the deepest one that is no fold at a
// joint, where what crosses at rest counts by how much deeper than there it lies. There is none where no
// depth is known, where the verdict says that nothing touches apart from what it leaves out, and where
// --new-contacts leaves events out.
std::optional<std::size_t> worst_event(const ClipAnswer& answer);
// "index_02_r is 12 cm deep in thigh_r, deepest at frame 38 (frames 13 to 64)".
std::string worst_text(const Input& input, const OverlapEvent& event);

}  // namespace cscd::bench
