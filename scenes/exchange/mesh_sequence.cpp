#include "scenes/exchange/mesh_sequence.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>

#include "core/base/error.h"
#include "scenes/exchange/mesh_cache.h"
#include "scenes/exchange/surface_file.h"

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

// A name cut at its last number: "walk.", "0001", ".obj".
struct CutName {
  std::string before, number, after;
};

CutName cut(const fs::path& path) {
  const std::string stem = path.stem().string();
  const std::size_t last = stem.find_last_of("0123456789");
  if (last == std::string::npos) return {stem, "", path.extension().string()};
  const std::size_t before = stem.find_last_not_of("0123456789", last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  return {stem.substr(0, first), stem.substr(first, last + 1 - first),
          stem.substr(last + 1) + path.extension().string()};
}

class FileSequence final : public MeshSequence {
 public:
  explicit FileSequence(const fs::path& path)
      : files_(files_of_sequence(path)), first_(read_surface(files_[0])) {
    if (first_.triangles.empty())
      throw InputError(files_[0].filename().string() + ": has no faces; export it with faces");
  }
  std::string format() const override {
    return extension_of(files_[0]) == ".ply" ? "PLY sequence" : "OBJ sequence";
  }
  std::string note() const override {
    return "the frames are " + std::to_string(files_.size()) + " files, " +
           files_.front().filename().string() + " to " + files_.back().filename().string();
  }
  std::size_t frame_count() const override { return files_.size(); }
  double first_frame() const override { return std::stod(cut(files_[0]).number); }
  std::size_t vertex_count() const override { return first_.positions.size(); }
  std::span<const std::array<std::int32_t, 3>> triangles() const override { return first_.triangles; }
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
                       "; export a surface whose vertices stay the same");
    if (surface.triangles != first_.triangles)
      throw InputError(name +
                       ": has other faces than the first file; export a surface whose faces stay the same");
    positions = std::move(surface.positions);
  }

 private:
  std::vector<fs::path> files_;
  SurfaceFile first_;
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
    if (surface_.triangles.empty())
      throw InputError(faces.filename().string() + ": has no faces; export it with faces");
  }
  std::string format() const override { return pc2_ ? "PC2 cache" : "MDD cache"; }
  std::string note() const override {
    if (pc2_ || cache_.fps()) return {};
    return "its frames are not evenly spaced in time; they are taken as evenly spaced, 30 a second unless "
           "--fps says otherwise";
  }
  std::size_t frame_count() const override { return cache_.frames(); }
  std::size_t vertex_count() const override { return cache_.vertices(); }
  std::span<const std::array<std::int32_t, 3>> triangles() const override { return surface_.triangles; }
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
};

}  // namespace

bool is_mesh_sequence(const fs::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".obj" || extension == ".ply" || extension == ".pc2" || extension == ".mdd";
}

std::vector<fs::path> files_of_sequence(const fs::path& path) {
  const CutName wanted = cut(path);
  if (wanted.number.empty())
    throw InputError(
        "is one pose, and nothing moves: its name has no number; name one file of a sequence, as in "
        "walk.0001.obj");
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::map<std::uint64_t, fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const CutName name = cut(entry.path());
    if (name.before != wanted.before || name.after != wanted.after || name.number.empty()) continue;
    std::uint64_t number = 0;
    const auto [end, wrong] =
        std::from_chars(name.number.data(), name.number.data() + name.number.size(), number);
    if (wrong != std::errc{} || end != name.number.data() + name.number.size()) continue;
    if (!files.try_emplace(number, entry.path()).second)
      throw InputError("frame " + std::to_string(number) + " is there twice, as " +
                       files[number].filename().string() + " and " + entry.path().filename().string() +
                       "; remove one");
  }
  if (error) throw InputError("its folder cannot be read; check the permissions");
  if (files.size() < 2)
    throw InputError(
        "is the only file of its sequence, and nothing moves; put the other frames beside it, as in "
        "walk.0001.obj, walk.0002.obj");
  std::vector<fs::path> out;
  for (const auto& [number, file] : files) {
    const std::uint64_t expected = files.begin()->first + out.size();
    if (number != expected)
      throw InputError("frame " + std::to_string(expected) + " of its sequence is missing before " +
                       file.filename().string() + "; export it again");
    out.push_back(file);
  }
  return out;
}

std::unique_ptr<MeshSequence> open_mesh_sequence(const fs::path& path) {
  const std::string extension = extension_of(path);
  if (extension == ".pc2" || extension == ".mdd") return std::make_unique<CacheSequence>(path);
  return std::make_unique<FileSequence>(path);
}

}  // namespace cscd::scenes
