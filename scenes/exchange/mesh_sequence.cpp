#include "scenes/exchange/mesh_sequence.h"

#include <fstream>
#include <map>

#include "core/base/error.h"
#include "core/base/number_text.h"
#include "scenes/exchange/mesh_cache.h"
#include "scenes/exchange/sequence_files.h"
#include "scenes/exchange/surface_file.h"
#include "scenes/polygon/cut_polygon.h"

namespace cscd::scenes {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostBytes = std::uintmax_t{8} << 30;  // of one file

std::string extension_of(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

std::string read_file(const fs::path& path) {
  std::error_code error;
  const std::uintmax_t size = fs::is_regular_file(path, error) ? fs::file_size(path, error) : 0;
  if (error || size == 0)
    throw InputError(path.filename().string() + ": is not there, or is empty; export it again");
  if (size > kMostBytes)
    throw InputError(path.filename().string() + ": has more than " + std::to_string(kMostBytes >> 30) +
                     " GiB; split it");
  std::string bytes(size, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw InputError(path.filename().string() + ": cannot be read");
  return bytes;
}

SurfaceFile read_surface(const fs::path& path) {
  const std::string bytes = read_file(path);
  try {
    return extension_of(path) == ".ply" ? read_ply(bytes) : read_obj(bytes);
  } catch (const InputError& error) {
    throw InputError(path.filename().string() + ": " + error.what());
  }
}

void require_finite_frame(const std::vector<Vec3>& positions, std::size_t frame) {
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (!positions[v].allFinite())
      throw InputError("frame " + std::to_string(frame) + ", vertex " + std::to_string(v) +
                       ": a coordinate is not finite; export it again");
}

// Finds the first later frame in which each face encloses area that encloses none in the first frame, where
// all ways to cut it look alike. Faces that never enclose any are left out.
LateFaces late_faces(const Polygons& faces, MeshSequence& sequence, std::vector<Vec3> positions) {
  std::vector<std::size_t> open;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (faces[f].size() > 3 && !has_area(faces[f], positions)) open.push_back(f);
  LateFaces late;
  for (std::size_t frame = 1; !open.empty() && frame < sequence.frame_count(); ++frame) {
    sequence.read_frame(frame, positions);
    std::erase_if(open, [&](std::size_t f) {
      if (!has_area(faces[f], positions)) return false;
      for (const std::int32_t v : faces[f]) late[f].push_back(positions[static_cast<std::size_t>(v)]);
      return true;
    });
  }
  return late;
}

// Cuts the faces of a sequence; `file` is the one that names them.
CutFaces faces_of(const fs::path& file, const SurfaceFile& surface, MeshSequence& sequence) {
  const std::string name = file.filename().string();
  std::vector<Vec3> positions;
  sequence.read_frame(0, positions);
  const LateFaces late = late_faces(surface.faces, sequence, positions);
  try {
    CutFaces faces = cut_faces(surface.faces, positions, late);
    if (!faces.triangles.empty()) return faces;
  } catch (const InputError& error) {
    throw InputError(name + ": " + error.what());
  }
  throw InputError(name + ": has no faces; export it with faces");
}

// What a user should know of a surface and of its frames.
std::vector<std::string> notes_of(const SurfaceFile& surface, const CutFaces& faces,
                                  const std::string& frames) {
  std::vector<std::string> notes = surface.notes;
  if (surface.points_and_lines > 0)
    notes.push_back(std::to_string(surface.points_and_lines) + " lines of points or lines (p, l) left out");
  if (!faces.note.empty()) notes.push_back(faces.note);
  if (!frames.empty()) notes.push_back(frames);
  return notes;
}

class FileSequence final : public MeshSequence {
 public:
  explicit FileSequence(const fs::path& path) : FileSequence(files_of_sequence(path)) {}
  std::string format() const override {
    const std::string format = extension_of(files_[0]) == ".ply" ? "PLY" : "OBJ";
    return format + (files_.size() > 1 ? " sequence" : "");
  }
  std::vector<std::string> notes() const override {
    std::vector<std::string> notes =
        notes_of(first_, faces_,
                 files_.size() < 2
                     ? alone_
                     : "the frames are " + std::to_string(files_.size()) + " files, " +
                           files_.front().filename().string() + " to " + files_.back().filename().string());
    if (later_.empty()) return notes;
    const auto& [frame, said] = *later_.begin();
    for (const std::string& note : said)
      notes.push_back(files_[frame].filename().string() + ": " + note +
                      (later_.size() > 1 ? "; likewise " + many(later_.size() - 1, "further file") : ""));
    return notes;
  }
  std::size_t frame_count() const override { return files_.size(); }
  double first_frame() const override { return first_frame_; }
  std::size_t vertex_count() const override { return first_.positions.size(); }
  std::span<const std::array<std::int32_t, 3>> triangles() const override { return faces_.triangles; }
  void read_frame(std::size_t frame, std::vector<Vec3>& positions) override {
    if (frame == 0) {
      positions = first_.positions;
      return;
    }
    SurfaceFile surface = read_surface(files_[frame]);
    const std::string name = files_[frame].filename().string();
    if (surface.positions.size() != first_.positions.size())
      throw InputError(name + ": has " + std::to_string(surface.positions.size()) +
                       " vertices, and the first file has " + std::to_string(first_.positions.size()) +
                       "; export a surface whose vertices stay the same, or move files of another "
                       "surface to a folder of their own");
    if (surface.faces != first_.faces)
      throw InputError(name +
                       ": has other faces than the first file; export a surface whose faces stay the same");
    if (surface.notes != first_.notes && !surface.notes.empty()) later_[frame] = std::move(surface.notes);
    positions = std::move(surface.positions);
  }

 private:
  explicit FileSequence(SequenceFiles sequence)
      : files_(std::move(sequence.files)),
        first_frame_(sequence.first_frame),
        alone_(std::move(sequence.note)),
        first_(read_surface(files_[0])) {
    faces_ = faces_of(files_[0], first_, *this);
  }

  std::vector<fs::path> files_;
  double first_frame_;
  std::string alone_;  // the note on a single file
  SurfaceFile first_;
  std::map<std::size_t, std::vector<std::string>> later_;  // notes on frames that the first one has not
  CutFaces faces_;
};

class CacheSequence final : public MeshSequence {
 public:
  explicit CacheSequence(const fs::path& path)
      : pc2_(extension_of(path) == ".pc2"),
        bytes_(read_file(path)),
        cache_(pc2_ ? MeshCacheFormat::pc2 : MeshCacheFormat::mdd, bytes_) {
    const fs::path faces = fs::path(path).replace_extension(".obj");
    std::error_code error;
    if (!fs::exists(faces, error))
      throw InputError("has no faces; put the OBJ file of the same surface beside it, as " +
                       faces.filename().string());
    surface_ = read_surface(faces);
    if (surface_.positions.size() != cache_.vertices())
      throw InputError("has " + std::to_string(cache_.vertices()) + " vertices, and " +
                       faces.filename().string() + " has " + std::to_string(surface_.positions.size()) +
                       "; export both from one surface");
    faces_ = faces_of(faces, surface_, *this);
  }
  std::string format() const override { return pc2_ ? "PC2 cache" : "MDD cache"; }
  std::vector<std::string> notes() const override {
    return notes_of(surface_, faces_,
                    pc2_ || cache_.fps()
                        ? ""
                        : "its frames are not evenly spaced in time; they are taken as evenly "
                          "spaced, 30 a second unless --fps says otherwise");
  }
  std::size_t frame_count() const override { return cache_.frames(); }
  std::size_t vertex_count() const override { return cache_.vertices(); }
  std::span<const std::array<std::int32_t, 3>> triangles() const override { return faces_.triangles; }
  void read_frame(std::size_t frame, std::vector<Vec3>& positions) override {
    cache_.read_frame(frame, positions);
    require_finite_frame(positions, frame);
  }
  double first_frame() const override { return cache_.first_frame(); }
  std::optional<double> fps() const override { return cache_.fps(); }

 private:
  bool pc2_;
  std::string bytes_;
  MeshCache cache_;
  SurfaceFile surface_;
  CutFaces faces_;
};

}  // namespace

bool is_mesh_sequence(const fs::path& path) {
  std::error_code error;
  return is_mesh_sequence_file(path) || fs::is_directory(path, error);
}

std::unique_ptr<MeshSequence> open_mesh_sequence(const fs::path& path) {
  const std::string extension = extension_of(path);
  if (extension == ".pc2" || extension == ".mdd") return std::make_unique<CacheSequence>(path);
  return std::make_unique<FileSequence>(path);
}

}  // namespace cscd::scenes
