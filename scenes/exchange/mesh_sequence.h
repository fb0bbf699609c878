#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

// Moving surfaces without bones, as programs exchange them: an OBJ or PLY file a frame, or a PC2 or MDD cache
// beside an OBJ file.
namespace cscd::scenes {

// Whether a path is a folder, or a file whose extension is one of a moving surface without bones.
bool is_mesh_sequence(const std::filesystem::path& path);

class MeshSequence {
 public:
  virtual ~MeshSequence() = default;
  virtual std::string format() const = 0;
  // What a user should know: which files the frames are, that a cache's times give no rate, and what the file
  // of the faces holds that is left out or overlaps itself.
  virtual std::vector<std::string> notes() const = 0;
  virtual std::size_t frame_count() const = 0;
  // The number of the first frame: that in the name of the first file, or what a cache says.
  virtual double first_frame() const = 0;
  // Frames a second, where the file says so.
  virtual std::optional<double> fps() const { return std::nullopt; }
  virtual std::size_t vertex_count() const = 0;
  // Corners of all triangles, in the order of the file of the first frame; those that repeat a corner too.
  // Faces of more corners are cut as they lie in the first frame in which they enclose area.
  virtual std::span<const std::array<std::int32_t, 3>> triangles() const = 0;
  // Throws InputError for a frame that cannot be read or is not of the same surface as frame 0.
  virtual void read_frame(std::size_t frame, std::vector<Vec3>& positions) = 0;
};

// Opens the sequence that a file belongs to: one file of an OBJ or PLY sequence, or a PC2 or MDD cache, whose
// faces are in the OBJ file of the same name beside it. Throws InputError.
std::unique_ptr<MeshSequence> open_mesh_sequence(const std::filesystem::path& path);

}  // namespace cscd::scenes
