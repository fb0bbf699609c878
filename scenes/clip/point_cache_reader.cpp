#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <string>

#include "core/base/error.h"
#include "scenes/clip/hdf5_file.h"
#include "scenes/clip/point_cache.h"
#include "scenes/clip/up_axis.h"

namespace cscd::scenes {
namespace {

constexpr std::string_view kCacheFormat = "point cache format";
constexpr std::size_t kMostShown = std::size_t{1} << 28;  // vertices or triangles, as in TriangleMesh
constexpr std::size_t kMostBones = std::size_t{1} << 20;
constexpr std::size_t kMostFrames = std::size_t{1} << 40;

void read_frame(const Dataset& dataset, std::size_t frame, Vec3* out) {
  const Hdf5Handle all(H5Dget_space(dataset.id.get()), H5Sclose);
  const hsize_t start[3] = {frame, 0, 0}, count[3] = {1, dataset.shape[1], 3};
  const Hdf5Handle memory(H5Screate_simple(3, count, nullptr), H5Sclose);
  if (H5Sselect_hyperslab(all.get(), H5S_SELECT_SET, start, nullptr, count, nullptr) < 0 ||
      H5Dread(dataset.id.get(), H5T_NATIVE_DOUBLE, memory.get(), all.get(), H5P_DEFAULT, out) < 0)
    throw InputError(dataset.where + ", frame " + std::to_string(frame) +
                     ": cannot be read; the file may be damaged, write it again");
}

// Throws InputError for the first point that is not finite. `what` is the word for a point, such as "vertex".
void require_finite_points(const Dataset& dataset, std::size_t frame, std::span<const Vec3> points,
                           std::string_view what) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite())
      throw InputError(dataset.where + ", frame " + std::to_string(frame) + ", " + std::string(what) + " " +
                       std::to_string(i) + ": position is not finite; repair the animation");
}

// One sequence of frames in the file: the frames themselves, or the predictions.
struct Sequence {
  Dataset positions;
  std::optional<Dataset> head, tail;
};

// One frame in memory.
struct Slot {
  static constexpr std::size_t nothing = std::numeric_limits<std::size_t>::max();
  std::size_t frame = nothing;
  std::vector<Vec3> positions;
  std::vector<Bone> bones;
  FrameView view() const { return {positions, bones}; }
};

}  // namespace

struct PointCacheReader::File {
  std::string path;
  Hdf5Handle file;
  ClipHeader header;
  std::size_t frames = 0;
  Sequence shown_frames;
  std::optional<Sequence> predictions;
  std::array<Slot, 2> slots;  // frames of shown_frames
  Slot prediction;
  std::vector<Vec3> scratch;

  explicit File(const std::filesystem::path& name) : path(name.string()) {
    open();
    shown_frames.positions = open_dataset(file.get(), path, kCacheFormat, "/positions", H5T_FLOAT, 3);
    read_sizes();
    read_triangles();
    if (has_object(file.get(), "/bones")) open_bones();
    if (has_object(file.get(), "/predicted")) open_predictions();
    if (has_object(file.get(), "/rest")) read_rest();
    if (H5Aexists(file.get(), "up") > 0) read_up();
    if (!header.bone_parent.empty()) check_rig();
  }

  void open() {
    silence_hdf5();
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) throw InputError(path + ": no such file; check the name");
    if (!std::filesystem::is_regular_file(status))
      throw InputError(path + ": is not a file; give a point cache");
    if (!std::ifstream(path)) throw InputError(path + ": cannot be read; check the permissions");
    file = Hdf5Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!file.valid())
      throw InputError(
          path + ": is not a readable HDF5 file (cut short, damaged, or of another kind); write it again");
  }

  void read_sizes() {
    const Dataset& positions = shown_frames.positions;
    frames = positions.shape[0];
    header.vertex_count = positions.shape[1];
    if (frames < 2)
      throw InputError(positions.where + ": has " + std::to_string(frames) +
                       " frames; an interval needs at least 2");
    if (frames > kMostFrames || header.vertex_count > kMostShown || header.vertex_count < 3)
      throw InputError(positions.where + ": has shape " + shown(positions.shape) +
                       "; from 3 to 2^28 vertices and at most 2^40 frames are supported");
    require_stored(positions, header.vertex_count * 3);
  }

  void read_triangles() {
    const Dataset triangles = open_dataset(file.get(), path, kCacheFormat, "/triangles", H5T_INTEGER, 2);
    if (triangles.shape[0] == 0 || triangles.shape[0] > kMostShown)
      throw InputError(triangles.where + ": has shape " + shown(triangles.shape) +
                       "; from 1 to 2^28 triangles are supported");
    require_stored(triangles, triangles.shape[0] * 3);
    const std::vector<std::int64_t> corners = read_integers(triangles);
    header.triangles.resize(triangles.shape[0]);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (corners[i] < 0 || static_cast<std::uint64_t>(corners[i]) >= header.vertex_count)
        throw InputError(triangles.where + ", triangle " + std::to_string(i / 3) + ": corner " +
                         std::to_string(corners[i]) + " is outside [0, " +
                         std::to_string(header.vertex_count) + "); /positions has that many vertices");
      header.triangles[i / 3][i % 3] = VertexId{static_cast<std::int32_t>(corners[i])};
    }
  }

  Dataset open_frames(const std::string& name, hsize_t count, hsize_t points, const std::string& why) {
    Dataset dataset = open_dataset(file.get(), path, kCacheFormat, name, H5T_FLOAT, 3);
    require_shape(dataset, {count, points, 3}, why);
    return dataset;
  }

  void open_bones() {
    const Dataset parent = open_dataset(file.get(), path, kCacheFormat, "/bones/parent", H5T_INTEGER, 1);
    if (parent.shape[0] == 0 || parent.shape[0] > kMostBones)
      throw InputError(parent.where + ": has " + std::to_string(parent.shape[0]) +
                       " bones; from 1 to 2^20 are supported; leave /bones out for none");
    require_stored(parent, parent.shape[0]);
    for (const std::int64_t value : read_integers(parent)) {
      if (value < -1 || value >= static_cast<std::int64_t>(parent.shape[0]))
        throw InputError(parent.where + ", bone " + std::to_string(header.bone_parent.size()) + ": parent " +
                         std::to_string(value) + " is outside [-1, " + std::to_string(parent.shape[0]) +
                         "); -1 marks a root");
      header.bone_parent.push_back(BoneId{static_cast<std::int32_t>(value)});
    }
    shown_frames.head =
        open_frames("/bones/head", frames, header.bone_parent.size(), "/positions and /bones/parent");
    shown_frames.tail =
        open_frames("/bones/tail", frames, header.bone_parent.size(), "/positions and /bones/parent");
  }

  void open_predictions() {
    header.predicted = true;
    predictions.emplace();
    predictions->positions = open_frames("/predicted", frames - 1, header.vertex_count, "/positions");
    if (header.bone_parent.empty()) return;
    const std::string why = "/predicted and /bones/parent";
    predictions->head = open_frames("/bones/predicted_head", frames - 1, header.bone_parent.size(), why);
    predictions->tail = open_frames("/bones/predicted_tail", frames - 1, header.bone_parent.size(), why);
  }

  void read_rest() {
    const Dataset rest = open_dataset(file.get(), path, kCacheFormat, "/rest", H5T_FLOAT, 2);
    require_shape(rest, {header.vertex_count, 3}, "/positions");
    require_stored(rest, header.vertex_count * 3);
    header.rest.resize(header.vertex_count);
    if (H5Dread(rest.id.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, header.rest.data()) < 0)
      throw InputError(rest.where + ": cannot be read; the file may be damaged, write it again");
    require_finite(header.rest, rest.where);
  }

  void read_up() {
    const std::optional<std::string> text = read_text_attribute(file.get(), "up");
    if (!text || !is_up_axis(*text))
      throw InputError(path + ", attribute up: is no axis; write one of the texts x, y, z, -x, -y, -z");
    header.up = *text;
  }

  void check_rig() {
    fill(slots[0], shown_frames, 0);
    try {
      validate(Rig{header.bone_parent, slots[0].bones});
    } catch (const InputError& error) {
      throw InputError(path + ", /bones: " + error.what());
    }
  }

  // Loads a frame into a slot, unless the slot holds it already.
  void fill(Slot& slot, const Sequence& sequence, std::size_t frame) {
    if (slot.frame == frame) return;
    slot.frame = Slot::nothing;
    try {
      slot.positions.resize(header.vertex_count);
    } catch (const std::bad_alloc&) {
      throw InputError(sequence.positions.where + ": one frame does not fit into memory; use fewer vertices");
    }
    read_frame(sequence.positions, frame, slot.positions.data());
    require_finite_points(sequence.positions, frame, slot.positions, "vertex");
    if (sequence.head) {
      slot.bones.resize(header.bone_parent.size());
      scratch.resize(header.bone_parent.size());
      read_frame(*sequence.head, frame, scratch.data());
      require_finite_points(*sequence.head, frame, scratch, "bone");
      for (std::size_t i = 0; i < scratch.size(); ++i) slot.bones[i].head = scratch[i];
      read_frame(*sequence.tail, frame, scratch.data());
      require_finite_points(*sequence.tail, frame, scratch, "bone");
      for (std::size_t i = 0; i < scratch.size(); ++i) slot.bones[i].tail = scratch[i];
    }
    slot.frame = frame;
  }

  void require_frame(std::size_t frame, std::size_t count, const std::string& what) const {
    if (frame >= count)
      throw InputError(path + ": has no " + what + " " + std::to_string(frame) + "; the last is " +
                       std::to_string(count - 1));
  }
};

PointCacheReader::PointCacheReader(const std::filesystem::path& path) : file_(std::make_unique<File>(path)) {}
PointCacheReader::~PointCacheReader() = default;
PointCacheReader::PointCacheReader(PointCacheReader&&) noexcept = default;
PointCacheReader& PointCacheReader::operator=(PointCacheReader&&) noexcept = default;

const ClipHeader& PointCacheReader::header() const {
  return file_->header;
}
std::size_t PointCacheReader::frame_count() const {
  return file_->frames;
}

FrameView PointCacheReader::load_frame(std::size_t frame) {
  file_->require_frame(frame, file_->frames, "frame");
  file_->fill(file_->slots[0], file_->shown_frames, frame);
  return file_->slots[0].view();
}

ClipInterval PointCacheReader::load(std::size_t interval) {
  File& file = *file_;
  file.require_frame(interval, file.frames - 1, "interval");
  // If intervals are loaded in ascending order, the end of one interval is the start of the next.
  if (file.slots[0].frame != interval && file.slots[1].frame == interval)
    std::swap(file.slots[0], file.slots[1]);
  file.fill(file.slots[0], file.shown_frames, interval);
  Slot& end = file.predictions ? file.prediction : file.slots[1];
  if (file.predictions)
    file.fill(end, *file.predictions, interval);
  else
    file.fill(end, file.shown_frames, interval + 1);
  ClipInterval result{Motion(file.slots[0].positions, end.positions), std::nullopt};
  if (!file.header.bone_parent.empty()) result.bones = Rig::Interval{file.slots[0].bones, end.bones};
  return result;
}

Clip read_clip(const std::filesystem::path& path) {
  PointCacheReader reader(path);
  Clip clip(reader.header());
  try {
    copy_frames(reader, clip);
  } catch (const std::bad_alloc&) {
    throw InputError(path.string() + ": does not fit into memory; stream it");
  }
  return clip;
}

}  // namespace cscd::scenes
