#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

// Surfaces of one moment as Wavefront OBJ and Stanford PLY files, which programs exchange one file a frame.
namespace cscd::scenes {

struct SurfaceFile {
  std::vector<Vec3> positions;                         // [vertices], in the order of the file
  std::vector<std::array<std::int32_t, 3>> triangles;  // polygons are cut into fans; indices are in range
};

// Read a file's text. An OBJ file counts as one surface, whatever objects and groups it names; only its
// positions and faces are used. A PLY file may be ASCII or binary in either order of bytes. Throw InputError
// that names the line or the element that cannot be read.
SurfaceFile read_obj(std::string_view text);
SurfaceFile read_ply(std::string_view bytes);

// Write a surface so that every position can be read back bit for bit: an OBJ file with 17 digits, a PLY file
// in binary doubles, the lowest byte first. A PLY file may have a number and a colour for each vertex, as the
// properties `quality` and `red`, `green`, `blue`, by which MeshLab and Blender know them.
using Rgb = std::array<std::uint8_t, 3>;
std::string to_obj(std::span<const Vec3> positions, std::span<const Triangle> triangles);
std::string to_ply(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                   std::span<const float> quality = {}, std::span<const Rgb> colours = {});

// Writes curves as OBJ lines, each in an object called event_N after `events`. A curve whose last point is
// its first is closed, and its line ends at the vertex where it begins.
std::string curves_to_obj(std::span<const std::vector<Vec3>> curves, std::span<const std::size_t> events);

}  // namespace cscd::scenes
