#include "core/fast/prepare/saved_cut.h"

#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "core/base/digest.h"
#include "core/fast/prepare/carried_cut.h"

namespace cscd::fast {
namespace {

constexpr std::array<char, 16> kMagic = {'c', 's', 'c', 'd', ' ', 'p', 'r', 'e',
                                         'p', 'a', 'r', 'a', 't', 'i', 'o', 'n'};
constexpr std::uint64_t kVersion = 2;

struct Head {
  std::array<char, 16> magic = kMagic;
  std::uint64_t version = kVersion;
  std::uint64_t surface = 0;   // digest of triangles and reference pose
  std::uint64_t contents = 0;  // digest of that and of what follows
};

std::uint64_t digest_of_surface(const TriangleMesh& mesh, std::span<const Vec3> reference) {
  return digest_of_words(std::as_bytes(reference),
                         digest_of_words(std::as_bytes(std::span(mesh.triangles()))));
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
    if (count > bytes_.size() / sizeof(Number)) refuse_preparation("ends too early");
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

void put(Writer& writer, const Cover& cover, std::span<const Vec3> reference) {
  writer.put(std::span(cover.cluster_of));
  writer.put(static_cast<std::uint64_t>(cover.observers.size()));
  for (const FollowingPoint& observer : cover.observers) {
    writer.put(static_cast<std::uint32_t>(observer.vertices().size()));
    writer.put(observer.height());
    writer.put(observer.vertices());
    writer.put(observer.weights());
    for (const VertexId v : observer.vertices()) writer.put(std::span<const double>(reference[+v].data(), 3));
  }
}

struct PlacedObserver {
  FollowingPoint observer;
  std::vector<Vec3> places;  // of the vertices that it follows
};
PlacedObserver take_observer(Reader& reader) {
  FollowingPoint observer;
  const auto count = reader.take<std::uint32_t>();
  const auto height = reader.take<float>();
  // The height is bounded as the weights are, so that no triple product overflows.
  if (count == 0 || count > FollowingPoint::kMost || !(std::abs(height) <= FollowingPoint::kMostWeight))
    refuse_preparation("has a wrong observer");
  const auto vertices = reader.take<VertexId>(count);
  const auto weights = reader.take<float>(count);
  float sizes = 0;
  for (std::size_t i = 0; i < count; ++i) {
    sizes += std::abs(weights[i]);
    observer.add(vertices[i], weights[i]);
  }
  if (!(sizes <= FollowingPoint::kMostWeight)) refuse_preparation("has an observer of too large weights");
  observer.stand_off(height);
  const auto coordinates = reader.take<double>(3 * std::size_t{count});
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < count; ++i) places.emplace_back(Vec3::Map(&coordinates[3 * i]));
  return {observer, std::move(places)};
}

Cover take_cover(Reader& reader, std::size_t triangles, std::vector<std::vector<Vec3>>& places) {
  Cover cover{reader.take<std::int32_t>(triangles), {}};
  const auto observers = reader.take<std::uint64_t>();
  if (observers > triangles) refuse_preparation("has more clusters than triangles");
  for (const std::int32_t cluster : cover.cluster_of)
    if (cluster != kNone && (cluster < 0 || static_cast<std::uint64_t>(cluster) >= observers))
      refuse_preparation("has a wrong cluster");
  for (std::uint64_t i = 0; i < observers; ++i) {
    PlacedObserver placed = take_observer(reader);
    cover.observers.push_back(placed.observer);
    places.push_back(std::move(placed.places));
  }
  return cover;
}

PatchList take_patches(Reader& reader, std::size_t triangles) {
  PatchList patches;
  const auto count = reader.take<std::uint64_t>();
  if (count > triangles) refuse_preparation("has more patches than triangles");
  patches.cell = reader.take<std::int32_t>(count);
  for (const std::uint8_t size : reader.take<std::uint8_t>(count)) {
    if (size == 0 || size > kLanes16) refuse_preparation("has a patch of a wrong size");
    patches.triangles.push_back(reader.take<TriangleId>(size));
    for (const TriangleId t : patches.triangles.back())
      if (static_cast<std::int32_t>(t) < 0 || +t >= triangles)
        refuse_preparation("has a patch of a triangle that the mesh lacks");
  }
  return patches;
}

EarlierCut take_cut(Reader& reader) {
  EarlierCut earlier;
  DecidedCut& decided = earlier.decided;
  decided.covers_used = reader.take<std::uint64_t>();
  if (decided.covers_used < 1 || decided.covers_used > kCovers)
    refuse_preparation("has a wrong number of covers");
  earlier.digests = reader.take<std::uint64_t>(reader.take<std::uint64_t>());
  const std::size_t triangles = earlier.digests.size();
  for (std::size_t c = 0; c < kCovers; ++c)
    decided.covers[c] = take_cover(reader, triangles, earlier.places[c]);
  decided.patches = take_patches(reader, triangles);
  if (!reader.at_end()) refuse_preparation("goes on behind its end");
  return earlier;
}

}  // namespace

std::vector<std::byte> saved_cut(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                 const CutSurface& cut, std::size_t covers) {
  Writer writer;
  writer.put(static_cast<std::uint64_t>(covers));
  writer.put(static_cast<std::uint64_t>(mesh.triangle_count()));
  writer.put(std::span<const std::uint64_t>(triangle_digests(mesh, reference)));
  for (const Cover& cover : cut.covers) put(writer, cover, reference);
  const std::size_t patches = cut.tree.patches.size();
  writer.put(static_cast<std::uint64_t>(patches));
  writer.put(std::span(cut.tree.cell));
  for (std::size_t p = 0; p < patches; ++p)
    writer.put(static_cast<std::uint8_t>(cut.tree.triangles_of(p).size()));
  for (std::size_t p = 0; p < patches; ++p) writer.put(cut.tree.triangles_of(p));

  Head head;
  head.surface = digest_of_surface(mesh, reference);
  head.contents = digest_of_words(writer.bytes(), head.surface);
  Writer whole;
  whole.put(head);
  whole.put(std::span<const std::byte>(writer.bytes()));
  return std::move(whole.bytes());
}

RestoredCut restored_cut(const TriangleMesh& mesh, std::span<const Vec3> reference,
                         std::span<const std::byte> bytes) {
  Reader reader(bytes);
  const Head head = reader.take<Head>();
  if (head.magic != kMagic) refuse_preparation("is no saved preparation");
  if (head.version != kVersion) refuse_preparation("was made by another version of the program");
  if (head.contents != digest_of_words(bytes.subspan(sizeof head), head.surface))
    refuse_preparation("is damaged");
  EarlierCut earlier = take_cut(reader);
  CarriedCut carried{{}, 0};
  if (head.surface != digest_of_surface(mesh, reference))
    carried = carried_over(mesh, reference, earlier);
  else if (earlier.digests.size() == mesh.triangle_count())
    carried.decided = std::move(earlier.decided);
  else
    refuse_preparation("has another number of triangles than its mesh");
  check(mesh, carried.decided);
  const std::size_t covers = carried.decided.covers_used;
  return {finished(mesh, reference, std::move(carried.decided)), covers, carried.new_triangles};
}

}  // namespace cscd::fast
