#include "core/detect/exclusions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/number_text.h"
#include "core/base/sort_unique.h"
#include "core/geometry/unit_scale.h"

namespace cscd {
namespace {

constexpr std::size_t kMostGroups = 4096;                 // that pairs name; two mebibytes
constexpr std::size_t kMostPairs = std::size_t{1} << 27;  // a gibibyte

template <class Id>
std::uint64_t key(Id a, Id b) {
  const auto i = static_cast<std::uint64_t>(a), j = static_cast<std::uint64_t>(b);
  return i < j ? i << 32 | j : j << 32 | i;
}

bool has(const std::vector<std::uint64_t>& keys, std::uint64_t wanted) {
  return std::binary_search(keys.begin(), keys.end(), wanted);
}

void require_one_each(std::size_t count, std::size_t size, const std::string& what, const std::string& each) {
  if (size != count)
    throw InputError(what + ": " + std::to_string(size) + " entries for " + std::to_string(count) + " " +
                     each + "; give one for each");
}

template <class Id>
void append(std::span<const std::pair<Id, Id>> pairs, std::size_t count, const std::string& what,
            std::vector<std::uint64_t>& keys) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& [a, b] = pairs[i];
    for (const Id id : {a, b})
      if (static_cast<std::int64_t>(id) < 0 || static_cast<std::size_t>(id) >= count)
        throw InputError(what + "_pairs: entry " + std::to_string(i) + " names " + what + " " +
                         std::to_string(static_cast<std::int64_t>(id)) + "; give 0 to " +
                         std::to_string(count - 1));
    keys.push_back(key(a, b));
  }
  sort_unique(keys);
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
  return rigid_.empty() && vertex_groups_.of.empty() && triangle_groups_.of.empty() &&
         vertex_pairs_.empty() && triangle_pairs_.empty() && !(near_ > 0);
}

void Exclusions::set_rigid(const TriangleMesh& mesh, std::vector<bool> rigid) {
  require_one_each(mesh.vertex_count(), rigid.size(), "rigid", "vertices");
  rigid_ = std::move(rigid);
  if (std::ranges::find(rigid_, true) == rigid_.end()) rigid_.clear();
}

Exclusions::Groups Exclusions::groups_of(std::vector<std::int32_t> group, std::string_view what,
                                         std::span<const std::pair<std::int32_t, std::int32_t>> ignoring) {
  if (const auto least = std::ranges::min_element(group); least != group.end() && *least < 0)
    throw InputError("group: " + std::string(what) + " " + std::to_string(least - group.begin()) +
                     " has group " + std::to_string(*least) + "; number groups from 0");
  const std::int32_t last = group.empty() ? -1 : *std::ranges::max_element(group);
  std::vector<std::int32_t> named;  // by a pair, sorted
  for (std::size_t k = 0; k < ignoring.size(); ++k) {
    const auto& [a, b] = ignoring[k];
    for (const std::int32_t g : {a, b})
      if (g < 0 || g > last)
        throw InputError("groups_that_ignore_each_other: entry " + std::to_string(k) + " names group " +
                         std::to_string(g) + ", which no " + std::string(what) + " has");
    named.insert(named.end(), {a, b});
  }
  if (named.empty()) return {};
  sort_unique(named);
  if (named.size() > kMostGroups)
    throw InputError("groups_that_ignore_each_other: " + std::to_string(named.size()) +
                     " different groups; give at most " + std::to_string(kMostGroups));
  // The groups that no pair names become one, which ignores none.
  const auto place_of = [&](std::int32_t g) {
    const auto at = std::ranges::lower_bound(named, g);
    return static_cast<std::size_t>(at == named.end() || *at != g ? named.end() - named.begin()
                                                                  : at - named.begin());
  };
  Groups out;
  out.count = named.size() + 1;
  out.ignoring.assign(out.count * out.count, false);
  for (const auto& [a, b] : ignoring) {
    const std::size_t i = place_of(a), j = place_of(b);
    out.ignoring[i * out.count + j] = out.ignoring[j * out.count + i] = true;
  }
  for (std::int32_t& g : group) g = static_cast<std::int32_t>(place_of(g));
  out.of = std::move(group);
  return out;
}

void Exclusions::set_groups(const TriangleMesh& mesh, std::vector<std::int32_t> group,
                            std::span<const std::pair<std::int32_t, std::int32_t>> ignoring) {
  require_one_each(mesh.vertex_count(), group.size(), "group", "vertices");
  vertex_groups_ = groups_of(std::move(group), "vertex", ignoring);
}

void Exclusions::set_triangle_groups(const TriangleMesh& mesh, std::vector<std::int32_t> group,
                                     std::span<const std::pair<std::int32_t, std::int32_t>> ignoring,
                                     std::int32_t points) {
  require_one_each(mesh.triangle_count(), group.size(), "group", "triangles");
  points_ = points < 0 ? 0 : group.size();
  if (points_ > 0) group.push_back(points);
  triangle_groups_ = groups_of(std::move(group), "triangle", ignoring);
}

void Exclusions::exclude(const TriangleMesh& mesh, std::span<const std::pair<VertexId, VertexId>> pairs) {
  append(pairs, mesh.vertex_count(), "vertex", vertex_pairs_);
}

void Exclusions::exclude(const TriangleMesh& mesh, std::span<const std::pair<TriangleId, TriangleId>> pairs) {
  append(pairs, mesh.triangle_count(), "face", triangle_pairs_);
}

void Exclusions::exclude_rings(const TriangleMesh& mesh, int rings) {
  std::vector<VertexId> reached;
  std::vector<VertexId> reached_from(mesh.vertex_count(), VertexId{-1});  // the last start that reached each
  for (std::size_t v = 0; v < mesh.vertex_count() && rings > 0; ++v) {
    const VertexId start{static_cast<std::int32_t>(v)};
    reached.assign(1, start);
    reached_from[v] = start;
    std::size_t first = 0;  // of the outermost ring
    for (int ring = 0; ring < rings && first < reached.size(); ++ring)
      for (const std::size_t end = reached.size(); first < end; ++first)
        for (const TriangleId t : mesh.triangles_at(reached[first]))
          for (const VertexId corner : mesh.corners(t))
            if (std::exchange(reached_from[+corner], start) != start) reached.push_back(corner);
    for (const VertexId u : reached)
      if (u > start) vertex_pairs_.push_back(key(start, u));
    if (vertex_pairs_.size() > kMostPairs)
      throw InputError("rings: " + std::to_string(rings) + " rings hold more than " +
                       std::to_string(kMostPairs) + " pairs of vertices; give fewer rings");
  }
  sort_unique(vertex_pairs_);
}

void Exclusions::exclude_near(std::span<const Vec3> reference, double distance) {
  if (!(distance >= 0) || !std::isfinite(distance))
    throw InputError("rest_distance: " + exact_text(distance) + "; give a finite length of at least 0");
  reference_.assign(reference.begin(), reference.end());
  scale_ = unit_scale(distance);
  near_ = distance * scale_;
}

bool Exclusions::excludes(VertexId u, VertexId v) const {
  if (!rigid_.empty() && rigid_[+u] && rigid_[+v]) return true;
  if (vertex_groups_.ignore(+u, +v)) return true;
  if (near_ > 0 && ((reference_[+u] - reference_[+v]) * scale_).squaredNorm() < near_ * near_) return true;
  return !vertex_pairs_.empty() && has(vertex_pairs_, key(u, v));
}

bool Exclusions::excludes(const TriangleMesh& mesh, const TrianglePair& pair) const {
  if (triangle_groups_.ignore(+pair.a, +pair.b)) return true;
  if (!triangle_pairs_.empty() && has(triangle_pairs_, key(pair.a, pair.b))) return true;
  return excludes_all(*this, mesh.corners(pair.a), mesh.corners(pair.b));
}

bool Exclusions::excludes(const TriangleMesh& mesh, const FeaturePair& pair) const {
  const bool face = pair.kind == FeaturePair::Kind::vertex_face;
  if (face ? excludes_all(*this, std::array{VertexId{pair.a}}, mesh.corners(TriangleId{pair.b}))
           : excludes_all(*this, mesh.ends(EdgeId{pair.a}), mesh.ends(EdgeId{pair.b})))
    return true;
  if (triangle_groups_.of.empty() && triangle_pairs_.empty()) return false;
  const TriangleId itself{pair.b};
  const std::span<const TriangleId> first =
      face ? mesh.triangles_at(VertexId{pair.a}) : mesh.triangles_at(EdgeId{pair.a});
  const std::span<const TriangleId> second = face ? std::span(&itself, 1) : mesh.triangles_at(EdgeId{pair.b});
  if (first.empty())  // no pair of triangles carries what a loose vertex does
    return points_ > 0 && triangle_groups_.ignore(points_, +itself);
  return std::ranges::all_of(first, [&](TriangleId s) {
    return std::ranges::all_of(second, [&](TriangleId t) {
      return s == t || excludes(mesh, TrianglePair{s, t});
    });
  });
}

}  // namespace cscd
