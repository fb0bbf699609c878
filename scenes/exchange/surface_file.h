#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

// Surfaces of one moment as Wavefront OBJ and Stanford PLY files, which programs exchange one file a frame.
namespace cscd::scenes {

// As many vertices, and as many triangles, as a mesh may have.
inline constexpr std::size_t kMostInSurfaceFile = std::size_t{1} << 28;

// Faces of three corners or more, in the order of the file.
struct Polygons {
  std::vector<std::int32_t> corners;  // vertices of all polygons, one polygon after another
  std::vector<std::size_t> ends;      // [polygons]: where the corners of each end
  std::size_t size() const { return ends.size(); }
  std::span<const std::int32_t> operator[](std::size_t polygon) const {
    const std::size_t first = polygon == 0 ? 0 : ends[polygon - 1];
    return std::span(corners).subspan(first, ends[polygon] - first);
  }
  bool operator==(const Polygons&) const = default;
};

struct SurfaceFile {
  std::vector<Vec3> positions;       // [vertices], in the order of the file
  Polygons faces;                    // indices are in range
  std::size_t points_and_lines = 0;  // that are left out
  std::vector<std::string> notes{};  // on what else is left out
};

// Read a file's text. An OBJ file counts as one surface, whatever objects and groups it names; only its
// positions and faces are used. A PLY file may be ASCII or binary in either order of bytes. Throw InputError
// that names the line or the element that cannot be read.
SurfaceFile read_obj(std::string_view text);
SurfaceFile read_ply(std::string_view bytes);
// Throws InputError for a surface that is empty, too large, or has a face of vertices that do not exist.
void require_sound(const SurfaceFile& surface);

struct CutFaces {
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::string note;  // on faces that overlap themselves; may be empty
};
// Where the corners of some faces lie at other moments than that of the rest.
using LateFaces = std::map<std::size_t, std::vector<Vec3>>;
// Cuts faces into triangles, as they lie at these positions, or where `late` has them. Throws InputError for
// a face that cannot be cut.
CutFaces cut_faces(const Polygons& faces, std::span<const Vec3> positions, const LateFaces& late = {});

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
