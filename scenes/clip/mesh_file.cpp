#include "scenes/clip/mesh_file.h"

#include <span>

#include "core/base/error.h"
#include "scenes/clip/hdf5_file.h"

namespace cscd::scenes {
namespace {

constexpr std::string_view kMeshFormat = "format of mesh files (scenes/clip/mesh_file.h)";
constexpr std::size_t kMostElements = std::size_t{1} << 28;  // vertices or triangles, as in TriangleMesh

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Bone) == 6 * sizeof(double));

using Shape = std::vector<hsize_t>;
using Member = PosedMesh::Pose PosedMesh::Interval::*;

// Calls visit(dataset, member) for both ends of all intervals.
template <class Visit>
void each_end(const std::string& folder, const Visit& visit) {
  visit(folder + "/start", &PosedMesh::Interval::start);
  visit(folder + "/end", &PosedMesh::Interval::end);
}

}  // namespace

struct MeshFileWriter::File : NewHdf5File {
  using NewHdf5File::NewHdf5File;

  void add(const std::string& name, const PosedMesh& mesh) {
    const std::string root = "/" + name;
    const hsize_t intervals = mesh.intervals.size(), vertices = mesh.reference.positions.size(),
                  bones = mesh.bone_parent.size();
    add_group(root);
    std::vector<std::int32_t> corners, parents;
    for (const Triangle& triangle : mesh.triangles)
      for (const VertexId corner : triangle) corners.push_back(static_cast<std::int32_t>(corner));
    add_integers(root + "/triangles", {mesh.triangles.size(), 3}, corners);
    add_numbers(root + "/reference", {vertices, 3}, mesh.reference.positions.data());
    each_end(root, [&](const std::string& dataset, Member member) {
      std::vector<Vec3> all;
      for (const PosedMesh::Interval& interval : mesh.intervals) {
        const std::vector<Vec3>& own = (interval.*member).positions;
        all.insert(all.end(), own.begin(), own.end());
      }
      add_numbers(dataset, {intervals, vertices, 3}, all.data());
    });
    if (bones == 0) return;
    add_group(root + "/bones");
    for (const BoneId parent : mesh.bone_parent) parents.push_back(static_cast<std::int32_t>(parent));
    add_integers(root + "/bones/parent", {bones}, parents);
    add_numbers(root + "/bones/reference", {bones, 2, 3}, mesh.reference.bones.data());
    each_end(root + "/bones", [&](const std::string& dataset, Member member) {
      std::vector<Bone> all;
      for (const PosedMesh::Interval& interval : mesh.intervals) {
        const std::vector<Bone>& own = (interval.*member).bones;
        all.insert(all.end(), own.begin(), own.end());
      }
      add_numbers(dataset, {intervals, bones, 2, 3}, all.data());
    });
  }
};

MeshFileWriter::MeshFileWriter(std::filesystem::path path, bool force)
    : file_(std::make_unique<File>(std::move(path), force)) {}
MeshFileWriter::~MeshFileWriter() = default;
MeshFileWriter::MeshFileWriter(MeshFileWriter&&) noexcept = default;
MeshFileWriter& MeshFileWriter::operator=(MeshFileWriter&&) noexcept = default;

void MeshFileWriter::add(const std::string& name, const PosedMesh& mesh) {
  file_->add(name, mesh);
}

void MeshFileWriter::finish() {
  file_->finish();
}

struct MeshFileReader::File {
  std::string path;
  Hdf5Handle file;

  explicit File(const std::filesystem::path& name) : path(name.string()) {
    silence_hdf5();
    file = Hdf5Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!file.valid())
      throw InputError(path +
                       ": is not a readable HDF5 file (missing, cut short, or damaged); make it again");
  }

  Dataset open(const std::string& name, H5T_class_t type, std::size_t rank) const {
    Dataset dataset = open_dataset(file.get(), path, kMeshFormat, name, type, rank);
    hsize_t elements = 1;
    for (const hsize_t extent : dataset.shape) {
      if (extent > kMostElements || elements > (hsize_t{1} << 40))
        throw InputError(dataset.where + ": has shape " + shown(dataset.shape) + ", which is too large");
      elements *= extent;
    }
    require_stored(dataset, elements);
    return dataset;
  }

  std::vector<Vec3> points(const std::string& name, const Shape& shape, const std::string& why) const {
    const Dataset dataset = open(name, H5T_FLOAT, shape.size());
    require_shape(dataset, shape, why);
    std::size_t count = 1;
    for (std::size_t i = 0; i + 1 < shape.size(); ++i) count *= shape[i];
    std::vector<Vec3> out(count);
    if (count > 0 &&
        H5Dread(dataset.id.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()) < 0)
      throw InputError(dataset.where + ": cannot be read; the file may be damaged, make it again");
    require_finite(out, dataset.where);
    return out;
  }

  std::int32_t index(const Dataset& dataset, std::int64_t value, std::int64_t least, hsize_t end) const {
    if (value < least || value >= static_cast<std::int64_t>(end))
      throw InputError(dataset.where + ": holds " + std::to_string(value) + ", which is outside [" +
                       std::to_string(least) + ", " + std::to_string(end) + "); make the file again");
    return static_cast<std::int32_t>(value);
  }

  PosedMesh read(const std::string& name) const {
    const std::string root = "/" + name;
    if (!has_object(file.get(), root))
      throw InputError(path + ": has no mesh " + name + "; make the file again");
    PosedMesh mesh;
    const Dataset starts = open(root + "/start", H5T_FLOAT, 3);
    const hsize_t intervals = starts.shape[0], vertices = starts.shape[1];
    const Dataset triangles = open(root + "/triangles", H5T_INTEGER, 2);
    const std::vector<std::int64_t> corners = read_integers(triangles);
    mesh.triangles.resize(triangles.shape[0]);
    for (std::size_t i = 0; i < corners.size(); ++i)
      mesh.triangles[i / 3][i % 3] = VertexId{index(triangles, corners[i], 0, vertices)};
    mesh.reference.positions = points(root + "/reference", {vertices, 3}, "/start");
    mesh.intervals.resize(intervals);
    each_end(root, [&](const std::string& dataset, Member member) {
      const std::vector<Vec3> all = points(dataset, {intervals, vertices, 3}, "/start");
      for (std::size_t i = 0; i < intervals; ++i) {
        const std::span<const Vec3> own = std::span(all).subspan(i * vertices, vertices);
        (mesh.intervals[i].*member).positions.assign(own.begin(), own.end());
      }
    });
    if (has_object(file.get(), root + "/bones/parent")) read_bones(root, intervals, mesh);
    return mesh;
  }

  void read_bones(const std::string& root, hsize_t intervals, PosedMesh& mesh) const {
    const Dataset parents = open(root + "/bones/parent", H5T_INTEGER, 1);
    const hsize_t bones = parents.shape[0];
    for (const std::int64_t parent : read_integers(parents))
      mesh.bone_parent.push_back(BoneId{index(parents, parent, -1, bones)});
    const auto pairs = [&](std::span<const Vec3> joints, std::vector<Bone>& out) {
      for (std::size_t i = 0; i < bones; ++i) out.push_back({joints[2 * i], joints[2 * i + 1]});
    };
    pairs(points(root + "/bones/reference", {bones, 2, 3}, "/bones/parent"), mesh.reference.bones);
    each_end(root + "/bones", [&](const std::string& dataset, Member member) {
      const std::vector<Vec3> all = points(dataset, {intervals, bones, 2, 3}, "/bones/parent");
      for (std::size_t i = 0; i < intervals; ++i)
        pairs(std::span(all).subspan(i * bones * 2, bones * 2), (mesh.intervals[i].*member).bones);
    });
    try {
      validate(Rig{mesh.bone_parent, mesh.reference.bones});
    } catch (const InputError& error) {
      throw InputError(path + ", " + root + "/bones: " + error.what());
    }
  }
};

MeshFileReader::MeshFileReader(const std::filesystem::path& path) : file_(std::make_unique<File>(path)) {}
MeshFileReader::~MeshFileReader() = default;
MeshFileReader::MeshFileReader(MeshFileReader&&) noexcept = default;
MeshFileReader& MeshFileReader::operator=(MeshFileReader&&) noexcept = default;

PosedMesh MeshFileReader::read(const std::string& name) const {
  return file_->read(name);
}

}  // namespace cscd::scenes
