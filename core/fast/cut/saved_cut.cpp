#include "core/fast/cut/saved_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "core/base/digest.h"
#include "core/base/error.h"

namespace cscd::fast {
namespace {

constexpr std::array<char, 16> kMagic = {'c', 's', 'c', 'd', ' ', 'p', 'r', 'e',
                                         'p', 'a', 'r', 'a', 't', 'i', 'o', 'n'};
constexpr std::uint64_t kVersion = 1;

struct Head {
  std::array<char, 16> magic = kMagic;
  std::uint64_t version = kVersion;
  std::uint64_t surface = 0;   // digest of triangles and reference pose
  std::uint64_t contents = 0;  // digest of what follows
};

[[noreturn]] void refuse(const std::string& what) {
  throw InputError("preparation: " + what + "; prepare anew without it");
}

std::uint64_t digest_of_surface(const TriangleMesh& mesh, std::span<const Vec3> reference) {
  return digest_of(std::as_bytes(reference), digest_of(std::as_bytes(std::span(mesh.triangles()))));
}

class Writer {
 public:
  template <class Number>
  void put(std::span<const Number> numbers) {
    const std::span<const std::byte> bytes = std::as_bytes(numbers);
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  template <class Number>
  void put(const Number& number) {
    put(std::span(&number, 1));
  }
  std::vector<std::byte>& bytes() { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class Number>
  std::vector<Number> take(std::size_t count) {
    if (count > bytes_.size() / sizeof(Number)) refuse("ends too early");
    std::vector<Number> numbers(count);
    std::memcpy(numbers.data(), bytes_.data(), count * sizeof(Number));
    bytes_ = bytes_.subspan(count * sizeof(Number));
    return numbers;
  }
  template <class Number>
  Number take() {
    return take<Number>(1)[0];
  }
  bool at_end() const { return bytes_.empty(); }

 private:
  std::span<const std::byte> bytes_;
};

void put(Writer& writer, const Cover& cover) {
  writer.put(std::span(cover.cluster_of));
  writer.put(static_cast<std::uint64_t>(cover.observers.size()));
  for (const FollowingPoint& observer : cover.observers) {
    writer.put(static_cast<std::uint32_t>(observer.vertices().size()));
    writer.put(observer.height());
    writer.put(observer.vertices());
    writer.put(observer.weights());
  }
}

FollowingPoint take_observer(Reader& reader, std::size_t vertex_count) {
  FollowingPoint observer;
  const auto count = reader.take<std::uint32_t>();
  const auto height = reader.take<float>();
  // The height is bounded as the weights are, so that no triple product overflows.
  if (count == 0 || count > FollowingPoint::kMost || !(std::abs(height) <= FollowingPoint::kMostWeight))
    refuse("has a wrong observer");
  const auto vertices = reader.take<VertexId>(count);
  const auto weights = reader.take<float>(count);
  float sizes = 0;
  for (std::size_t i = 0; i < count; ++i) {
    sizes += std::abs(weights[i]);
    if (static_cast<std::int32_t>(vertices[i]) < 0 || +vertices[i] >= vertex_count)
      refuse("has an observer at a vertex that the mesh lacks");
    observer.add(vertices[i], weights[i]);
  }
  if (!(sizes <= FollowingPoint::kMostWeight)) refuse("has an observer of too large weights");
  observer.stand_off(height);
  return observer;
}

// Every cluster has triangles, all of one component.
Cover take_cover(Reader& reader, const TriangleMesh& mesh) {
  Cover cover{reader.take<std::int32_t>(mesh.triangle_count()), {}};
  const auto observers = reader.take<std::uint64_t>();
  if (observers > mesh.triangle_count()) refuse("has more clusters than triangles");
  for (std::uint64_t i = 0; i < observers; ++i)
    cover.observers.push_back(take_observer(reader, mesh.vertex_count()));
  std::vector<std::int32_t> component(observers, kNone);
  for (std::size_t t = 0; t < cover.cluster_of.size(); ++t) {
    const std::int32_t cluster = cover.cluster_of[t];
    if (cluster == kNone) continue;
    if (cluster < 0 || static_cast<std::uint64_t>(cluster) >= observers) refuse("has a wrong cluster");
    std::int32_t& own = component[static_cast<std::size_t>(cluster)];
    const std::int32_t here = mesh.component(TriangleId{static_cast<std::int32_t>(t)});
    if (own != kNone && own != here) refuse("has a cluster in two components");
    own = here;
  }
  if (std::ranges::find(component, kNone) != component.end()) refuse("has an empty cluster");
  return cover;
}

// Each triangle is in one patch, and the triangles of a patch are of one cluster in each cover.
PatchList take_patches(Reader& reader, const TriangleMesh& mesh, const Covers& covers) {
  PatchList patches;
  const auto count = reader.take<std::uint64_t>();
  if (count > mesh.triangle_count()) refuse("has more patches than triangles");
  patches.cell = reader.take<std::int32_t>(count);
  const auto sizes = reader.take<std::uint8_t>(count);
  std::vector<bool> met(mesh.triangle_count(), false);
  std::size_t triangles = 0;
  for (const std::uint8_t size : sizes) {
    if (size == 0 || size > kLanes16) refuse("has a patch of a wrong size");
    patches.triangles.push_back(reader.take<TriangleId>(size));
    std::vector<VertexId> vertices;
    const TriangleId first = patches.triangles.back().front();
    for (const TriangleId t : patches.triangles.back()) {
      if (static_cast<std::int32_t>(t) < 0 || +t >= met.size() || met[+t])
        refuse("has a triangle in two patches");
      met[+t] = true;
      ++triangles;
      vertices.insert(vertices.end(), mesh.corners(t).begin(), mesh.corners(t).end());
      for (const Cover& cover : covers)
        if (cover.cluster_of[+t] != cover.cluster_of[+first]) refuse("has a patch in two clusters");
    }
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    if (vertices.size() > kLanes16) refuse("has a patch of too many vertices");
  }
  if (triangles != met.size()) refuse("has a triangle in no patch");
  return patches;
}

}  // namespace

std::vector<std::byte> saved_cut(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                 const CutSurface& cut, std::size_t covers) {
  Writer writer;
  writer.put(static_cast<std::uint64_t>(covers));
  for (const Cover& cover : cut.covers) put(writer, cover);
  const std::size_t patches = cut.tree.patches.size();
  writer.put(static_cast<std::uint64_t>(patches));
  writer.put(std::span(cut.tree.cell));
  for (std::size_t p = 0; p < patches; ++p)
    writer.put(static_cast<std::uint8_t>(cut.tree.triangles_of(p).size()));
  for (std::size_t p = 0; p < patches; ++p) writer.put(cut.tree.triangles_of(p));

  Head head;
  head.surface = digest_of_surface(mesh, reference);
  head.contents = digest_of(writer.bytes());
  Writer whole;
  whole.put(head);
  whole.put(std::span<const std::byte>(writer.bytes()));
  return std::move(whole.bytes());
}

RestoredCut restored_cut(const TriangleMesh& mesh, std::span<const Vec3> reference,
                         std::span<const std::byte> bytes) {
  Reader reader(bytes);
  const Head head = reader.take<Head>();
  if (head.magic != kMagic) refuse("is no saved preparation");
  if (head.version != kVersion) refuse("was made by another version of the program");
  if (head.contents != digest_of(bytes.subspan(sizeof head))) refuse("is damaged");
  if (head.surface != digest_of_surface(mesh, reference)) refuse("was made for another surface");
  RestoredCut restored;
  restored.covers = reader.take<std::uint64_t>();
  if (restored.covers < 1 || restored.covers > kCovers) refuse("has a wrong number of covers");
  Covers& covers = restored.cut.covers;
  for (Cover& cover : covers) cover = take_cover(reader, mesh);
  if (std::ranges::find(covers[0].cluster_of, kNone) != covers[0].cluster_of.end())
    refuse("has a triangle without a cluster");
  const PatchList patches = take_patches(reader, mesh, covers);
  if (!reader.at_end()) refuse("goes on behind its end");
  restored.cut.tree = make_tree(mesh, reference, patches, covers[0].cluster_of);
  for (std::size_t c = 0; c < kCovers; ++c) enter_cover(mesh, covers[c], c, restored.cut.tree);
  return restored;
}

}  // namespace cscd::fast
