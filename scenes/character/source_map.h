#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace cscd::scenes {

// Tells for every triangle and vertex of an imported surface where it comes from in the model file, so that
// answers can speak in the numbers and names of the file. The map crosses from the import process as a file
// of its own beside the frames.
struct SourceMap {
  // The three corners of a triangle in the model file.
  struct Corners {
    std::int32_t part = -1;  // index into ImportReport::parts; -1 for a triangle that fills a hole
    std::array<std::int32_t, 3> vertex{-1, -1, -1};  // vertex numbers in the part, corner by corner
    bool operator==(const Corners&) const = default;
  };
  std::vector<Corners> triangle;   // [triangles of the surface]
  std::vector<std::int32_t> bone;  // [vertices]; the bone with the largest weight, -1 without bones

  bool operator==(const SourceMap&) const = default;
};

// Writes the map as a binary file. Throws InputError where the file cannot be written.
void write_source_map(const SourceMap& map, const std::filesystem::path& path);

// The sizes that a map has to fit.
struct SourceMapSizes {
  std::size_t triangles = 0, vertices = 0, parts = 0, bones = 0;
};

// Reads a map back. Throws InputError for a file that is not a source map of these sizes, and for a part or
// a bone outside them.
SourceMap read_source_map(const std::filesystem::path& path, const SourceMapSizes& sizes);

}  // namespace cscd::scenes
