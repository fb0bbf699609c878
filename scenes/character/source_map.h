#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace cscd::scenes {

// Where the surface made of a model file comes from, so that answers speak in the numbers and names of the
// file. Crosses from the import process as a file of its own beside the frames.
struct SourceMap {
  struct Corners {
    std::int32_t part = -1;                          // of ImportReport::parts; -1 for a filled hole
    std::array<std::int32_t, 3> vertex{-1, -1, -1};  // of the part, corner by corner
    bool operator==(const Corners&) const = default;
  };
  std::vector<Corners> triangle;   // of each triangle of the surface
  std::vector<std::int32_t> bone;  // of each vertex, the bone with the largest weight; -1 without bones

  bool operator==(const SourceMap&) const = default;
};

// Throws InputError where the file cannot be written.
void write_source_map(const SourceMap& map, const std::filesystem::path& path);

// What a map has to fit.
struct SourceMapSizes {
  std::size_t triangles = 0, vertices = 0, parts = 0, bones = 0;
};

// Throws InputError for a file that is not a source map of these sizes, or points outside of them.
SourceMap read_source_map(const std::filesystem::path& path, const SourceMapSizes& sizes);

}  // namespace cscd::scenes
