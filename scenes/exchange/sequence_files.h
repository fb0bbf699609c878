#pragma once

#include <filesystem>
#include <string>
#include <vector>

// Which files of a folder are the frames of one sequence.
namespace cscd::scenes {

// Whether a file's extension is one of a moving surface without bones: .obj, .ply, .pc2, .mdd.
bool is_mesh_sequence_file(const std::filesystem::path& path);

// The frames of one sequence, in the order of their numbers.
struct SequenceFiles {
  std::vector<std::filesystem::path> files;
  double first_frame = 0;  // the number in the name of the first file
  std::string note{};      // on files beside a single one that may be meant as its frames; may be empty
};

// Returns the sequence of a file. The names of its files differ in the last number before the extension
// alone, as walk.0001.obj and walk.0002.obj do. A number has a sign where a blank or a mark stands before it,
// as in cloth.-10.obj; the dash of walk-1.obj joins two words. A file without a number is alone. Throws
// InputError if a number is missing in between, and where dashes may be meant either way.
SequenceFiles files_of_sequence(const std::filesystem::path& path);

// Returns the file itself, or the first file of the one sequence, or the one cache, that a folder holds.
// Throws InputError for a folder that holds none or several.
std::filesystem::path sequence_file(const std::filesystem::path& path);

}  // namespace cscd::scenes
