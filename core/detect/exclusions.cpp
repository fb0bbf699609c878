#include "core/detect/exclusions.h"

#include <algorithm>
#include <string>

#include "core/base/error.h"

namespace cscd {
namespace {

template <class Id>
std::uint64_t key(Id a, Id b) {
  const auto i = static_cast<std::uint64_t>(a), j = static_cast<std::uint64_t>(b);
  return i < j ? i << 32 | j : j << 32 | i;
}

void sort(std::vector<std::uint64_t>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

bool has(const std::vector<std::uint64_t>& keys, std::uint64_t wanted) {
  return std::binary_search(keys.begin(), keys.end(), wanted);
}

void require_one_a_vertex(const TriangleMesh& mesh, std::size_t size, const std::string& what) {
  if (size != mesh.vertex_count())
    throw InputError(what + ": " + std::to_string(size) + " entries for " +
                     std::to_string(mesh.vertex_count()) + " vertices; give one a vertex");
}

template <class Id>
void append(std::span<const std::pair<Id, Id>> pairs, std::size_t count, const std::string& what,
            std::vector<std::uint64_t>& keys) {
  for (const auto& [a, b] : pairs) {
    for (const Id id : {a, b})
      if (static_cast<std::int64_t>(id) < 0 || static_cast<std::size_t>(id) >= count)
        throw InputError("excluded pairs: " + what + " " + std::to_string(static_cast<std::int64_t>(id)) +
                         " is outside 0 to " + std::to_string(count - 1));
    keys.push_back(key(a, b));
  }
  sort(keys);
}

// Returns whether every vertex of one side is excluded from every vertex of the other.
template <class First, class Second>
bool excludes_all(const Exclusions& exclusions, const First& first, const Second& second) {
  return std::ranges::all_of(first, [&](VertexId u) {
    return std::ranges::all_of(second, [&](VertexId v) { return exclusions.excludes(u, v); });
  });
}

}  // namespace

bool Exclusions::empty() const {
  return obstacle_.empty() && group_.empty() && vertex_pairs_.empty() && triangle_pairs_.empty() &&
         !(near_ > 0);
}

void Exclusions::set_obstacles(const TriangleMesh& mesh, std::vector<bool> obstacle) {
  require_one_a_vertex(mesh, obstacle.size(), "obstacles");
  obstacle_ = std::move(obstacle);
  if (std::ranges::find(obstacle_, true) == obstacle_.end()) obstacle_.clear();
}

void Exclusions::set_groups(const TriangleMesh& mesh, std::vector<std::int32_t> group,
                            std::span<const std::pair<std::int32_t, std::int32_t>> ignoring) {
  require_one_a_vertex(mesh, group.size(), "groups");
  if (const auto least = std::ranges::min_element(group); least != group.end() && *least < 0)
    throw InputError("groups: vertex " + std::to_string(least - group.begin()) + " has group " +
                     std::to_string(*least) + "; number groups from 0");
  groups_ = group.empty() ? 0 : 1 + *std::ranges::max_element(group);
  const auto count = static_cast<std::size_t>(groups_);
  if (groups_ > 4096) throw InputError("groups: " + std::to_string(groups_) + " of them; give at most 4096");
  ignores_.assign(count * count, false);
  for (const auto& [a, b] : ignoring) {
    for (const std::int32_t g : {a, b})
      if (g < 0 || g >= groups_)
        throw InputError("groups: no vertex has group " + std::to_string(g) + ", which a pair names");
    ignores_[static_cast<std::size_t>(a) * count + static_cast<std::size_t>(b)] = true;
    ignores_[static_cast<std::size_t>(b) * count + static_cast<std::size_t>(a)] = true;
  }
  group_ = std::move(group);
  if (ignoring.empty()) group_.clear();
}

void Exclusions::exclude(const TriangleMesh& mesh, std::span<const std::pair<VertexId, VertexId>> pairs) {
  append(pairs, mesh.vertex_count(), "vertex", vertex_pairs_);
}

void Exclusions::exclude(const TriangleMesh& mesh, std::span<const std::pair<TriangleId, TriangleId>> pairs) {
  append(pairs, mesh.triangle_count(), "triangle", triangle_pairs_);
}

void Exclusions::exclude_rings(const TriangleMesh& mesh, int rings) {
  std::vector<VertexId> reached;
  for (std::size_t v = 0; v < mesh.vertex_count() && rings > 0; ++v) {
    reached.assign(1, VertexId{static_cast<std::int32_t>(v)});
    for (int ring = 0; ring < rings; ++ring)
      for (std::size_t i = 0, before = reached.size(); i < before; ++i) {
        for (const TriangleId t : mesh.triangles_at(reached[i]))
          for (const VertexId corner : mesh.corners(t))
            if (std::ranges::find(reached, corner) == reached.end()) reached.push_back(corner);
      }
    for (const VertexId u : reached)
      if (+u > v) vertex_pairs_.push_back(key(VertexId{static_cast<std::int32_t>(v)}, u));
  }
  sort(vertex_pairs_);
}

void Exclusions::exclude_near(std::span<const Vec3> reference, double distance) {
  if (!(distance >= 0)) throw InputError("exclusion by distance: give a length of at least 0");
  reference_.assign(reference.begin(), reference.end());
  near_ = distance;
}

bool Exclusions::excludes(VertexId u, VertexId v) const {
  if (!obstacle_.empty() && obstacle_[+u] && obstacle_[+v]) return true;
  if (!group_.empty() && ignores_[static_cast<std::size_t>(group_[+u]) * static_cast<std::size_t>(groups_) +
                                  static_cast<std::size_t>(group_[+v])])
    return true;
  if (near_ > 0 && (reference_[+u] - reference_[+v]).squaredNorm() < near_ * near_) return true;
  return !vertex_pairs_.empty() && has(vertex_pairs_, key(u, v));
}

bool Exclusions::excludes(const TriangleMesh& mesh, const TrianglePair& pair) const {
  if (!triangle_pairs_.empty() && has(triangle_pairs_, key(pair.a, pair.b))) return true;
  return excludes_all(*this, mesh.corners(pair.a), mesh.corners(pair.b));
}

bool Exclusions::excludes(const TriangleMesh& mesh, const FeaturePair& pair) const {
  if (pair.kind == FeaturePair::Kind::vertex_face)
    return excludes_all(*this, std::array{VertexId{pair.a}}, mesh.corners(TriangleId{pair.b}));
  return excludes_all(*this, mesh.ends(EdgeId{pair.a}), mesh.ends(EdgeId{pair.b}));
}

}  // namespace cscd
