#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cscd::scenes {

// What was found in a model file and what was made of it. Crosses from the import process as lines of text.
struct ImportReport {
  std::string format;
  double centimetres_per_unit = 0;  // 0 where the file does not say; positions are never scaled
  std::size_t nodes = 0, meshes = 0, joints = 0, vertices = 0, triangles = 0;  // of the file
  std::size_t most_influences = 0;                                             // of one vertex

  struct Clip {
    std::string name;
    double start = 0;                          // seconds on the file's own time line
    double seconds = 0, ticks_per_second = 0;  // 0 ticks: the file does not say
    std::size_t frames = 0;                    // at the chosen rate
    std::size_t driven = 0;                    // of the joints, how many it moves
    bool operator==(const Clip&) const = default;
  };
  std::vector<Clip> clips;

  // A primitive of a mesh as a node shows it.
  struct Part {
    std::string name, node;                  // of the mesh, of the node
    std::int32_t mesh = -1, primitive = -1;  // their numbers in the file; -1 where the format counts none
    bool operator==(const Part&) const = default;
  };
  std::vector<Part> parts;
  std::vector<std::string> bones;  // names of the bones of the frames, in their order
  long chosen_clip = -1;           // -1: none
  double fps = 0;
  std::size_t lead_in = 0;  // frames from the bind pose before the clip

  double weld_tolerance = 0;  // share of the diagonal that was used
  double weld_spread = 0;     // largest distance of welded vertices in any frame, as such a share
  std::size_t welded_vertices = 0, collapsed_triangles = 0, duplicate_triangles = 0;
  std::size_t filled_holes = 0, filled_triangles = 0, flipped_components = 0;
  std::size_t components = 0;
  std::vector<std::size_t> chosen_components;
  std::vector<std::size_t>
      component_bones;  // of each component, how many bones move it; in a survey of up to 1000
  std::size_t chosen_triangles = 0;
  std::vector<std::string> notes;

  bool operator==(const ImportReport&) const = default;
};

// Lines of a key and values with tabs between. Texts from files lose what is not printable.
std::string to_text(const ImportReport& report);

// Throws InputError for a text that is not of that form.
ImportReport parse_report(const std::string& text);

// Characters of valid UTF-8 stay, except those that control a terminal or the direction of writing; runs of
// anything else become one '?'. At most `longest` bytes, cut between characters.
std::string printable(const std::string& text, std::size_t longest = 200);

}  // namespace cscd::scenes
