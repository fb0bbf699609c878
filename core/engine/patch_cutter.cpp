#include "core/engine/patch_cutter.h"

#include <algorithm>
#include <limits>
#include <random>

#include "core/base/random.h"

// Patches grow one beside the other; what is left over between them is joined; then small ones are cut anew
// together with what is about them, in random order, where that makes fewer.
namespace cscd::fast {
namespace {

constexpr std::size_t kSmall = 12;  // triangles up to which a patch is repaired,
constexpr std::size_t kGroup = 8;   // together with so many at most, itself among them,
constexpr int kAttempts = 8;        // so often at most,
constexpr int kRounds = 2;          // in so many rounds

std::size_t index(std::int32_t patch) {
  return static_cast<std::size_t>(patch);
}

}  // namespace

PatchCutter::PatchCutter(const TriangleMesh& mesh, std::span<const Vec3> centroid, std::size_t most)
    : mesh_(mesh),
      centroid_(centroid),
      most_(most),
      free_(mesh.triangle_count(), false),
      patch_of_(mesh.triangle_count(), -1),
      corners_taken_(mesh.triangle_count(), 0),
      taken_(mesh.vertex_count(), false) {}

PatchCutter::Patches PatchCutter::cut(std::span<const TriangleId> cell) {
  Patches patches = pieces(cell);
  join(patches);
  repair(patches);
  return patches;
}

std::vector<VertexId> PatchCutter::vertices_of(std::span<const TriangleId> patch) const {
  std::vector<VertexId> vertices;
  for (const TriangleId t : patch)
    vertices.insert(vertices.end(), mesh_.corners(t).begin(), mesh_.corners(t).end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

int PatchCutter::free_beside(TriangleId triangle) const {
  int count = 0;
  for (const EdgeId e : mesh_.edges_of(triangle))
    for (const TriangleId other : mesh_.triangles_at(e)) count += free_[+other] && other != triangle;
  return count;
}

// Each begins beside those before it, at the triangle with the fewest free neighbours.
PatchCutter::Patches PatchCutter::pieces(std::span<const TriangleId> cell) {
  for (const TriangleId t : cell) free_[+t] = true;
  Patches patches;
  std::vector<TriangleId> beside;
  std::size_t next = 0;
  while (true) {
    std::erase_if(beside, [&](TriangleId t) { return !free_[+t]; });
    TriangleId seed{-1};
    if (!beside.empty()) {
      int fewest = std::numeric_limits<int>::max();
      for (const TriangleId t : beside) {
        const int free = free_beside(t);
        if (free >= fewest) continue;
        fewest = free;
        seed = t;
        if (free == 0) break;
      }
    } else {
      while (next < cell.size() && !free_[+cell[next]]) ++next;
      if (next == cell.size()) return patches;
      seed = cell[next];
    }
    patches.push_back(grow(seed));
    std::sort(vertices_.begin(), vertices_.end());
    for (const VertexId v : vertices_)
      for (const TriangleId other : mesh_.triangles_at(v))
        if (free_[+other]) beside.push_back(other);
  }
}

// Next the triangle that needs the fewest new vertices and lies nearest to the others. One vertex in common
// is enough: what hangs at a zigzag seam by its corners would else be patches of one triangle.
std::vector<TriangleId> PatchCutter::grow(TriangleId seed) {
  std::vector<TriangleId> patch;
  Vec3 sum = Vec3::Zero();
  const auto take = [&](TriangleId triangle) {
    patch.push_back(triangle);
    sum += centroid_[+triangle];
    free_[+triangle] = false;
    for (const VertexId v : mesh_.corners(triangle)) {
      if (taken_[+v]) continue;
      taken_[+v] = true;
      vertices_.push_back(v);
      for (const TriangleId t : mesh_.triangles_at(v))
        if (free_[+t] && corners_taken_[+t]++ == 0) touched_.push_back(t);
    }
  };
  touched_.clear();
  vertices_.clear();
  take(seed);
  while (patch.size() < most_) {
    const Vec3 middle = sum / static_cast<double>(patch.size());
    TriangleId best{-1};
    std::pair<int, double> least{3, 0};  // all need fewer
    for (const TriangleId t : touched_) {
      const int needed = 3 - corners_taken_[+t];
      if (needed > least.first || !free_[+t] || static_cast<std::size_t>(needed) + vertices_.size() > most_)
        continue;
      const std::pair cost{needed, (centroid_[+t] - middle).squaredNorm()};
      if (cost < least) {
        best = t;
        least = cost;
      }
    }
    if (best == TriangleId{-1}) break;
    take(best);
  }
  for (const TriangleId t : touched_) corners_taken_[+t] = 0;
  for (const VertexId v : vertices_) taken_[+v] = false;
  return patch;
}

// The smallest with the largest that it touches and fits.
void PatchCutter::join(Patches& patches) const {
  std::stable_sort(patches.begin(), patches.end(),
                   [](const auto& a, const auto& b) { return a.size() < b.size(); });
  std::vector<std::vector<VertexId>> vertices;
  for (const auto& patch : patches) vertices.push_back(vertices_of(patch));
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const std::vector<VertexId>& own = vertices[i];
    for (std::size_t j = patches.size(); j-- > i + 1;) {
      if (patches[i].size() + patches[j].size() > most_) continue;
      const std::vector<VertexId>& other = vertices[j];
      std::vector<VertexId> both;
      std::set_union(own.begin(), own.end(), other.begin(), other.end(), std::back_inserter(both));
      if (both.size() > most_ || both.size() == own.size() + other.size()) continue;
      patches[j].insert(patches[j].end(), patches[i].begin(), patches[i].end());
      patches[i].clear();
      vertices[j] = std::move(both);
      break;
    }
  }
  std::erase_if(patches, [](const auto& patch) { return patch.empty(); });
}

// A patch, those of the cell that touch it, and those that touch them, as far as they are wanted.
std::vector<std::int32_t> PatchCutter::around(std::int32_t patch, const Patches& patches) const {
  std::vector<std::int32_t> group = {patch};
  for (std::size_t next = 0; next < group.size(); ++next)
    for (const VertexId v : vertices_of(patches[index(group[next])]))
      for (const TriangleId t : mesh_.triangles_at(v)) {
        const std::int32_t other = patch_of_[+t];
        if (other < 0 || std::find(group.begin(), group.end(), other) != group.end()) continue;
        group.push_back(other);
        if (group.size() == kGroup) return group;
      }
  return group;
}

void PatchCutter::repair(Patches& patches) {
  const auto enter = [&](std::int32_t p) {
    for (const TriangleId t : patches[index(p)]) patch_of_[+t] = p;
  };
  const auto count = static_cast<std::int32_t>(patches.size());
  for (std::int32_t p = 0; p < count; ++p) enter(p);
  std::mt19937 random(kPreparationSeed);
  std::vector<TriangleId> all;
  for (int round = 0; round < kRounds; ++round)
    for (std::int32_t p = 0; p < count; ++p) {
      if (patches[index(p)].empty() || patches[index(p)].size() > kSmall) continue;
      const std::vector<std::int32_t> group = around(p, patches);
      all.clear();
      for (const std::int32_t q : group)
        all.insert(all.end(), patches[index(q)].begin(), patches[index(q)].end());
      if (all.size() > (group.size() - 1) * most_) continue;
      for (int attempt = 0; attempt < kAttempts; ++attempt) {
        shuffle(all, random);
        Patches anew = pieces(all);
        if (anew.size() >= group.size()) join(anew);
        if (anew.size() >= group.size()) continue;
        anew.resize(group.size());
        for (std::size_t i = 0; i < group.size(); ++i) {
          patches[index(group[i])] = std::move(anew[i]);
          enter(group[i]);
        }
        break;
      }
    }
  for (const auto& patch : patches)
    for (const TriangleId t : patch) patch_of_[+t] = -1;
  std::erase_if(patches, [](const auto& patch) { return patch.empty(); });
}

}  // namespace cscd::fast
