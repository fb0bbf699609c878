#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace cscd::scenes {

// What to make of a model file.
struct ImportOptions {
  std::string clip;                        // a name, else a number; empty: the first that moves the surface
  std::optional<std::size_t> clip_number;  // instead of `clip`, where a name might be a number
  double fps = 30;                         // frames a second
  bool from_bind_pose = false;             // a lead-in of half a second from the bind pose
  std::string component = "all";           // see choose_pieces
  std::size_t fill_holes = 0;              // fill holes of up to so many edges
  bool flip_inward = false;                // turn closed components that face inward
  std::optional<double> weld;              // tolerance as a share of the diagonal
  // Instead of a clip: all components in the bind pose and at the start of every clip.
  bool survey = false;

  bool operator==(const ImportOptions&) const = default;
};

inline constexpr double kDefaultWeld = 1e-6;
inline constexpr double kLeadInSeconds = 0.5;

// As words for a command line, and back. parse_arguments throws InputError for what it does not know.
std::vector<std::string> to_arguments(const ImportOptions& options);
ImportOptions parse_arguments(std::span<const std::string> arguments);

}  // namespace cscd::scenes
