#include "core/detect/start/rest_crossings.h"

#include <algorithm>
#include <tuple>

#include "core/base/disjoint_sets.h"
#include "core/base/sort_unique.h"

namespace cscd {

std::vector<TriangleId> within_rings(const TriangleMesh& mesh, TriangleId center, int rings) {
  std::vector<TriangleId> inside{center};
  for (int ring = 0; ring < rings; ++ring) {
    const std::size_t end = inside.size();
    for (std::size_t i = 0; i < end; ++i)
      for (const VertexId vertex : mesh.corners(inside[i]))
        for (const TriangleId next : mesh.triangles_at(vertex)) inside.push_back(next);
    sort_unique(inside);
  }
  return inside;
}

RestCrossings::RestCrossings(const TriangleMesh& mesh, const Crossings& at_rest)
    : mesh_(&mesh), pairs_(at_rest) {
  find_places();
  std::vector<std::pair<TriangleId, std::uint32_t>> entries;
  for (std::size_t i = 0; i < pairs_.pairs.size(); ++i) {
    const auto [first, second] = pairs_.pairs[i];
    if (mesh.component(first) == mesh.component(second)) continue;
    const auto number = static_cast<std::uint32_t>(2 * i);
    for (const TriangleId t : within_rings(mesh, first, kRings)) entries.emplace_back(t, number);
    for (const TriangleId t : within_rings(mesh, second, kRings)) entries.emplace_back(t, number + 1);
  }
  std::sort(entries.begin(), entries.end());
  offset_.assign(mesh.triangle_count() + 1, 0);
  for (const auto& [triangle, number] : entries) {
    ++offset_[+triangle + 1];
    near_.push_back(number);
  }
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) offset_[t + 1] += offset_[t];
}

std::span<const std::uint32_t> RestCrossings::near(TriangleId triangle) const {
  return std::span(near_).subspan(offset_[+triangle], offset_[+triangle + 1] - offset_[+triangle]);
}

std::size_t RestCrossings::number_of(const CrossingPair& pair) const {
  const auto found = std::ranges::lower_bound(pairs_.pairs, pair);
  return found != pairs_.pairs.end() && *found == pair
             ? static_cast<std::size_t>(found - pairs_.pairs.begin())
             : kNone;
}

void RestCrossings::find_places() {
  // Pairs are neighbours if they have a corner on either side in common.
  std::vector<std::tuple<VertexId, VertexId, std::int32_t>> corners;
  for (std::size_t i = 0; i < pairs_.pairs.size(); ++i)
    for (const VertexId v : mesh_->corners(pairs_.pairs[i].first))
      for (const VertexId w : mesh_->corners(pairs_.pairs[i].second))
        corners.emplace_back(std::min(v, w), std::max(v, w), static_cast<std::int32_t>(i));
  std::sort(corners.begin(), corners.end());
  std::vector<std::int32_t> sets(pairs_.pairs.size(), -1);
  for (std::size_t k = 1; k < corners.size(); ++k) {
    const auto& [v, w, one] = corners[k - 1];
    const auto& [x, y, other] = corners[k];
    if (v == x && w == y) unite(sets, one, other);
  }
  std::vector<std::size_t> number(pairs_.pairs.size(), kNone);  // of the place, by its root
  for (std::size_t i = 0; i < pairs_.pairs.size(); ++i) {
    std::size_t& place = number[static_cast<std::size_t>(root_of(sets, static_cast<std::int32_t>(i)))];
    if (place == kNone) {
      place = witness_.size();
      witness_.push_back(pairs_.pairs[i]);
    }
    place_.push_back(place);
  }
  parted_.assign(witness_.size(), false);
}

// Most places keep the witness of the pose before. One pass over the crossings of this pose looks for others.
void RestCrossings::follow(const Crossings& pose) {
  if (!pose.all_kept()) return;
  std::vector<bool> is_sought(witness_.size(), false);
  std::size_t sought = 0;
  for (std::size_t place = 0; place < witness_.size(); ++place)
    if (!parted_[place] && !pose.contains(witness_[place])) is_sought[place] = true, ++sought;
  const auto find = [&](std::size_t place, const CrossingPair& pair) {
    if (!is_sought[place]) return;
    witness_[place] = pair;
    is_sought[place] = false;
    --sought;
  };
  for (std::size_t k = 0; k < pose.pairs.size() && sought > 0; ++k) {
    const CrossingPair& pair = pose.pairs[k];
    if (const std::size_t i = number_of(pair); i != kNone) find(place_[i], pair);
    const std::span<const std::uint32_t> others = near(pair.second);
    for (const std::uint32_t number : near(pair.first))
      if (is_sought[place_[number / 2]] && std::ranges::binary_search(others, number ^ 1))
        find(place_[number / 2], pair);
  }
  for (std::size_t place = 0; place < is_sought.size(); ++place)
    if (is_sought[place]) parted_[place] = true;
}

bool RestCrossings::explains(const CrossingPair& pair) const {
  if (empty()) return false;
  if (const std::size_t i = number_of(pair); i != kNone && !parted_[place_[i]]) return true;
  // The pair is explained if one triangle is near the first triangle of a crossing and the other is near its
  // second. The numbers of these two entries differ in the last bit.
  const std::span<const std::uint32_t> others = near(pair.second);
  return std::ranges::any_of(near(pair.first), [&](std::uint32_t number) {
    return !parted_[place_[number / 2]] && std::ranges::binary_search(others, number ^ 1);
  });
}

bool RestCrossings::explains(const FeaturePair& pair) const {
  if (empty()) return false;
  return std::ranges::any_of(carriers(*mesh_, pair), [&](const CrossingPair& p) { return explains(p); });
}

}  // namespace cscd
