#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "scenes/clip/hdf5_file.h"
#include "scenes/clip/point_cache.h"

namespace cscd::scenes {
namespace {

// The most vertices in a chunk, which keeps HDF5 chunks under 4 GiB. A frame of more vertices is cut into
// several chunks.
constexpr hsize_t kMostVerticesInChunk = hsize_t{1} << 24;

// A growing dataset [frames, points, 3].
struct Growing {
  Hdf5Handle id;
  hsize_t points = 0, frames = 0;
};

}  // namespace

struct PointCacheWriter::File : NewHdf5File {
  ClipHeader header;
  Growing positions, head, tail, predicted, predicted_head, predicted_tail;
  std::vector<Vec3> scratch;

  File(std::filesystem::path name, ClipHeader shared, bool overwrite)
      : NewHdf5File(std::move(name), overwrite), header(std::move(shared)) {
    create();
  }

  void close_datasets() {
    for (Growing* dataset : {&positions, &head, &tail, &predicted, &predicted_head, &predicted_tail})
      dataset->id = Hdf5Handle();
  }

  void create() {
    std::vector<std::int32_t> corners;
    corners.reserve(header.triangles.size() * 3);
    for (const Triangle& triangle : header.triangles)
      for (const VertexId corner : triangle) corners.push_back(static_cast<std::int32_t>(corner));
    add_integers("/triangles", {header.triangles.size(), 3}, corners);
    positions = create_growing("/positions", header.vertex_count);
    if (!header.rest.empty()) write_rest();
    if (!header.up.empty()) write_up();
    if (header.predicted) predicted = create_growing("/predicted", header.vertex_count);
    if (header.bone_parent.empty()) return;
    add_group("/bones");
    std::vector<std::int32_t> parents;
    for (const BoneId parent : header.bone_parent) parents.push_back(static_cast<std::int32_t>(parent));
    add_integers("/bones/parent", {parents.size()}, parents);
    head = create_growing("/bones/head", parents.size());
    tail = create_growing("/bones/tail", parents.size());
    if (!header.predicted) return;
    predicted_head = create_growing("/bones/predicted_head", parents.size());
    predicted_tail = create_growing("/bones/predicted_tail", parents.size());
  }

  void write_rest() {
    if (header.rest.size() != header.vertex_count)
      throw InputError(path.string() + ", pose at rest: has " + std::to_string(header.rest.size()) +
                       " vertices; the frames have " + std::to_string(header.vertex_count));
    require_finite(header.rest, path.string() + ", pose at rest");
    add_numbers("/rest", {header.vertex_count, 3}, header.rest.data());
  }

  void write_up() {
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
    H5Tset_size(type.get(), header.up.size() + 1);
    const Hdf5Handle attribute(
        H5Acreate2(file.get(), "up", type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (H5Awrite(attribute.get(), type.get(), header.up.c_str()) < 0) refuse("the attribute up");
  }

  Growing create_growing(const char* name, std::size_t points) {
    const hsize_t now[3] = {0, points, 3}, most[3] = {H5S_UNLIMITED, points, 3};
    const hsize_t chunk[3] = {1, std::clamp<hsize_t>(points, 1, kMostVerticesInChunk), 3};
    const Hdf5Handle creation = timeless(H5P_DATASET_CREATE);
    H5Pset_chunk(creation.get(), 3, chunk);
    const Hdf5Handle space(H5Screate_simple(3, now, most), H5Sclose);
    Growing dataset;
    dataset.points = points;
    dataset.id = Hdf5Handle(
        H5Dcreate2(file.get(), name, H5T_IEEE_F64LE, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
        H5Dclose);
    if (!dataset.id.valid()) refuse(name);
    return dataset;
  }

  void grow(Growing& dataset, std::span<const Vec3> points) {
    const hsize_t start[3] = {dataset.frames, 0, 0}, count[3] = {1, dataset.points, 3};
    const hsize_t now[3] = {++dataset.frames, dataset.points, 3};
    bool good = H5Dset_extent(dataset.id.get(), now) >= 0;
    const Hdf5Handle all(H5Dget_space(dataset.id.get()), H5Sclose);
    const Hdf5Handle memory(H5Screate_simple(3, count, nullptr), H5Sclose);
    good = good && H5Sselect_hyperslab(all.get(), H5S_SELECT_SET, start, nullptr, count, nullptr) >= 0 &&
           H5Dwrite(dataset.id.get(), H5T_NATIVE_DOUBLE, memory.get(), all.get(), H5P_DEFAULT,
                    points.data()) >= 0;
    if (!good) refuse("frame " + std::to_string(dataset.frames - 1));
  }

  void grow_bones(Growing& heads, Growing& tails, std::span<const Bone> bones) {
    scratch.clear();
    for (const Bone& bone : bones) scratch.push_back(bone.head);
    grow(heads, scratch);
    scratch.clear();
    for (const Bone& bone : bones) scratch.push_back(bone.tail);
    grow(tails, scratch);
  }
};

PointCacheWriter::PointCacheWriter(std::filesystem::path path, ClipHeader header, bool force)
    : file_(std::make_unique<File>(std::move(path), std::move(header), force)) {}
PointCacheWriter::~PointCacheWriter() = default;
PointCacheWriter::PointCacheWriter(PointCacheWriter&&) noexcept = default;
PointCacheWriter& PointCacheWriter::operator=(PointCacheWriter&&) noexcept = default;

void PointCacheWriter::append(const FrameView& frame, const FrameView* predicted) {
  File& file = *file_;
  try {
    check_frame(file.header, file.positions.frames, frame, predicted);
  } catch (const InputError& error) {
    throw InputError(file.path.string() + ", " + error.what());
  }
  file.grow(file.positions, frame.positions);
  const bool bones = !file.header.bone_parent.empty();
  if (bones) file.grow_bones(file.head, file.tail, frame.bones);
  if (!predicted) return;
  file.grow(file.predicted, predicted->positions);
  if (bones) file.grow_bones(file.predicted_head, file.predicted_tail, predicted->bones);
}

void PointCacheWriter::finish() {
  File& file = *file_;
  if (file.positions.frames < 2)
    throw InputError(file.path.string() + ": " + std::to_string(file.positions.frames) +
                     " frames; a point cache needs at least 2");
  file.close_datasets();
  file.finish();
}

}  // namespace cscd::scenes
