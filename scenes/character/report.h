#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cscd::scenes {

// Whence a frame rate is: the user gave it; the file says it; the keys of the file's clips are spaced by it;
// or none of these, and it is assumed.
inline constexpr char kAsked[] = "asked", kStated[] = "file", kSpaced[] = "keys", kAssumed[] = "assumed";

// Describes a model file and the surface that the import made from it. The report crosses from the import
// process as lines of text.
struct ImportReport {
  std::string format;
  std::string up;                   // the axis that points up in positions (up_axis.h); empty if nothing says
  double centimetres_per_unit = 0;  // 0 where file and format do not say; positions are never scaled
  std::size_t nodes = 0, meshes = 0, joints = 0, vertices = 0, triangles = 0;  // counts of the file
  std::size_t most_influences = 0;  // largest number of influences of one vertex

  // An animation that the file holds.
  struct Clip {
    std::string name;
    double start = 0;                          // seconds on the file's own time line
    double seconds = 0, ticks_per_second = 0;  // ticks: 0 where the file does not say
    std::size_t frames = 0;                    // at the chosen frame rate
    std::size_t driven = 0;                    // number of joints that the clip moves
    double first_frame = 0;                    // number of its first frame on the file's own time line
    bool operator==(const Clip&) const = default;
  };
  std::vector<Clip> clips;

  // A primitive of a mesh as a node shows it. Two nodes can show one mesh.
  struct Part {
    std::string name, node;                  // names of the mesh and of the node
    std::int32_t mesh = -1, primitive = -1;  // their numbers in the file; -1 where the format counts none
    bool operator==(const Part&) const = default;
  };
  std::vector<Part> parts;
  std::vector<std::string> bones;  // names of the bones in the imported frames, in their order
  long chosen_clip = -1;           // -1: none
  double fps = 0;
  std::string fps_from;     // whence `fps` is: one of the words above
  std::size_t lead_in = 0;  // frames from the bind pose before the clip

  double weld_tolerance = 0;  // the tolerance that was used, as a share of the diagonal
  double weld_spread = 0;     // largest distance of welded vertices in any frame, as such a share
  std::size_t welded_vertices = 0, collapsed_triangles = 0, duplicate_triangles = 0;
  std::size_t filled_holes = 0, filled_triangles = 0, flipped_components = 0;
  std::size_t components = 0;
  std::vector<std::size_t> chosen_components;
  std::vector<std::size_t> component_bones;  // [components]; bones that move it, in surveys of up to 1000
  std::size_t chosen_triangles = 0;
  std::vector<std::string> notes;

  bool operator==(const ImportReport&) const = default;
};

// Writes a report as lines, each of a key and its values with tabs between them. Characters that are not
// printable are replaced in texts that come from files (see printable).
std::string to_text(const ImportReport& report);

// Reads a report back. Throws InputError for a text that is not complete and in the form of to_text.
ImportReport parse_report(const std::string& text);

// Returns `text` as safe UTF-8 of at most `longest` bytes, cut between characters. Valid
// characters stay, except those that control a terminal or the direction of writing; every run of
// anything else becomes one '?'.
std::string printable(const std::string& text, std::size_t longest = 200);

}  // namespace cscd::scenes
