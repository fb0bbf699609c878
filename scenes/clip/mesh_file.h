#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::scenes {

// A mesh and some intervals of its motion that need not follow each other.
struct PosedMesh {
  struct Pose {
    std::vector<Vec3> positions;  // [vertices]
    std::vector<Bone> bones;      // [bones]
  };
  struct Interval {
    Pose start, end;
  };
  std::vector<Triangle> triangles;
  std::vector<BoneId> bone_parent;  // [bones]; empty without bones
  Pose reference;                   // the pose for which a program may prepare
  std::vector<Interval> intervals;
};

// A mesh file is an HDF5 file that holds any number of meshes, each in a group of its own:
//   /MESH/triangles        int32   [triangles, 3], counter-clockwise seen from outside
//   /MESH/reference        float64 [vertices, 3]: the pose for which a program may prepare
//   /MESH/start, end       float64 [intervals, vertices, 3]: both ends of each interval
//   /MESH/bones/parent     int32   [bones], -1 for a root                                  (optional)
//   /MESH/bones/reference  float64 [bones, 2, 3]: head and tail of each bone          (with parent)
//   /MESH/bones/start, end float64 [intervals, bones, 2, 3]                           (with parent)
// Data are neither compressed nor divided into chunks, and all errors are InputError.

// Writes a mesh file under a temporary name in the same folder; `finish` gives the file its name. Equal
// meshes give equal bytes.
class MeshFileWriter {
 public:
  // Throws InputError if the path exists and `force` is false.
  MeshFileWriter(std::filesystem::path path, bool force);
  ~MeshFileWriter();  // removes the temporary file if `finish` was not called
  MeshFileWriter(MeshFileWriter&&) noexcept;
  MeshFileWriter& operator=(MeshFileWriter&&) noexcept;

  // `name` becomes the group. It has to be new in this file, and has no slash.
  void add(const std::string& name, const PosedMesh& mesh);
  void finish();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

class MeshFileReader {
 public:
  explicit MeshFileReader(const std::filesystem::path& path);
  ~MeshFileReader();
  MeshFileReader(MeshFileReader&&) noexcept;
  MeshFileReader& operator=(MeshFileReader&&) noexcept;

  // Throws InputError if there is no such mesh, or if its arrays do not fit together or hold numbers that
  // cannot be used.
  PosedMesh read(const std::string& name) const;

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace cscd::scenes
