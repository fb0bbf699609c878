#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace cscd::scenes {

// The options of an import: which clip, components and repairs to use.
struct ImportOptions {
  std::string clip;  // a name, else a number; empty: the first clip that moves the surface
  std::optional<std::size_t> clip_number;  // instead of `clip`, where a number might be a name
  std::optional<double> fps;               // frames a second; nothing: see frame_rate (frame_rate.h)
  bool from_bind_pose = false;             // put half a second from the bind pose before the clip
  std::string component = "all";           // see choose_pieces (pieces.h)
  std::optional<std::size_t> fill_holes;   // holes of up to so many edges are filled
  bool flip_inward = false;                // turn closed components that face inward
  std::optional<double> weld;              // tolerance as a share of the diagonal
  // Survey the file instead of importing one clip: take all components in the bind pose and at
  // the start of every clip.
  bool survey = false;
  // Take a file, or a clip, that is one pose: the import then holds this pose twice. Otherwise it is refused.
  bool one_pose = false;
  // A file for the motion of the clip (scenes/motion/motion_file.h); empty: it is not written. A survey has
  // none.
  std::string motion;

  bool operator==(const ImportOptions&) const = default;
};

// The rate of a file that does not say its own.
inline constexpr double kAssumedFps = 30;
// Default of `ImportOptions::weld`, and the length of the lead-in in seconds.
inline constexpr double kDefaultWeld = 1e-6;
inline constexpr double kLeadInSeconds = 0.5;

// Write the options as words for a command line, and read them back. parse_arguments throws InputError for
// an unknown option, a value that is missing or cannot be read, and a number out of range.
std::vector<std::string> to_arguments(const ImportOptions& options);
ImportOptions parse_arguments(std::span<const std::string> arguments);

}  // namespace cscd::scenes
