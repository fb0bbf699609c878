#include "core/fast/prepare/patch_cutter.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <limits>
#include <utility>

#include "core/base/sort_unique.h"
#include "core/fast/prepare/covers.h"

// Patches grow one beside the other. What is left over between them is joined. Then small patches are emptied
// into the patches beside them.
namespace cscd::fast {
namespace {

constexpr std::size_t kMostSeeking =
    300;  // so many triangles are asked to move for one; asking more finds little
constexpr std::size_t kMostBeside = 8;  // so many patches are asked for room

}  // namespace

std::vector<VertexId> vertices_of(const TriangleMesh& mesh, std::span<const TriangleId> triangles) {
  std::vector<VertexId> vertices;
  for (const TriangleId t : triangles)
    vertices.insert(vertices.end(), mesh.corners(t).begin(), mesh.corners(t).end());
  sort_unique(vertices);
  return vertices;
}

PatchCutter::PatchCutter(const TriangleMesh& mesh, std::span<const Vec3> centroid)
    : mesh_(mesh),
      centroid_(centroid),
      free_(mesh.triangle_count(), false),
      free_at_(mesh.edge_count(), 0),
      waits_in_(mesh.triangle_count(), kNowhere),
      corners_taken_(mesh.triangle_count(), 0),
      taken_(mesh.vertex_count(), false),
      patch_of_(mesh.triangle_count(), -1),
      seeks_(mesh.triangle_count(), false),
      place_(mesh.vertex_count(), kNoPlace) {}

PatchCutter::Patches PatchCutter::cut(std::span<const TriangleId> cell) {
  Patches patches = pieces(cell);
  join(patches);
  dissolve_small(patches);
  return patches;
}

void PatchCutter::set_free(TriangleId triangle, bool free) {
  free_[+triangle] = free;
  waits_in_[+triangle] = kNowhere;
  for (const EdgeId e : mesh_.edges_of(triangle)) free_at_[+e] += free ? 1 : -1;
}
int PatchCutter::free_beside(TriangleId triangle) const {
  int count = 0;
  for (const EdgeId e : mesh_.edges_of(triangle)) count += free_at_[+e] - 1;
  return count;
}

// Each patch begins beside the patches before it, at a triangle with the fewest free neighbours. There is one
// queue for each number of free neighbours, 0 to 3. A triangle is put into the next queue when it loses a
// neighbour, and its entry in the old queue is passed over.
PatchCutter::Patches PatchCutter::pieces(std::span<const TriangleId> cell) {
  for (const TriangleId t : cell) set_free(t, true);
  Patches patches;
  struct Queue {
    std::vector<TriangleId> waiting;
    std::size_t first = 0;
  };
  std::array<Queue, 4> queues;
  const auto queue_of = [&](TriangleId t) { return static_cast<std::uint8_t>(std::min(free_beside(t), 3)); };
  const auto next_beside = [&] {
    for (std::uint8_t q = 0; q < queues.size(); ++q)
      for (auto& [waiting, first] = queues[q]; first < waiting.size(); ++first)
        if (const TriangleId t = waiting[first]; free_[+t] && waits_in_[+t] == q) return t;
    return TriangleId{-1};
  };
  std::size_t next = 0;
  while (true) {
    TriangleId seed = next_beside();
    if (seed == TriangleId{-1}) {
      while (next < cell.size() && !free_[+cell[next]]) ++next;
      if (next == cell.size()) return patches;
      seed = cell[next];
    }
    patches.push_back(grow(seed));
    std::sort(vertices_.begin(), vertices_.end());
    for (const VertexId v : vertices_)
      for (const TriangleId other : mesh_.triangles_at(v)) {
        if (!free_[+other]) continue;
        const std::uint8_t queue = queue_of(other);
        if (waits_in_[+other] == queue) continue;
        waits_in_[+other] = queue;
        queues[queue].waiting.push_back(other);
      }
  }
}

// The next triangle is the one that needs the fewest new vertices and lies nearest to the others. One vertex
// in common is enough: triangles that hang at a zigzag seam by their corners would otherwise become patches
// of one triangle.
std::vector<TriangleId> PatchCutter::grow(TriangleId seed) {
  std::vector<TriangleId> patch;
  Vec3 sum = Vec3::Zero();
  const auto take = [&](TriangleId triangle) {
    patch.push_back(triangle);
    sum += centroid_[+triangle];
    set_free(triangle, false);
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
  while (patch.size() < kMost) {
    const Vec3 middle = sum / static_cast<double>(patch.size());
    TriangleId best{-1};
    std::pair<int, double> least{3, 0};  // every triangle needs fewer new vertices
    for (const TriangleId t : touched_) {
      const int needed = 3 - corners_taken_[+t];
      if (needed > least.first || !free_[+t] || static_cast<std::size_t>(needed) + vertices_.size() > kMost)
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

// Joins the smallest piece with the largest piece that it touches and that has room for it, as long as there
// is one.
void PatchCutter::join(Patches& patches) {
  std::stable_sort(patches.begin(), patches.end(),
                   [](const auto& a, const auto& b) { return a.size() < b.size(); });
  std::vector<std::vector<VertexId>> vertices;
  for (const auto& patch : patches) vertices.push_back(vertices_of(mesh_, patch));
  for (std::size_t i = 0; i < patches.size(); ++i) enter(i, patches[i]);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const std::vector<VertexId>& own = vertices[i];
    beside_.clear();
    for (const VertexId v : own)
      for (const TriangleId t : mesh_.triangles_at(v))
        if (patch_of_[+t] > static_cast<std::int32_t>(i)) beside_.push_back(patch_of_[+t]);
    std::ranges::sort(beside_, std::greater{});
    beside_.erase(std::unique(beside_.begin(), beside_.end()), beside_.end());
    for (const std::int32_t p : beside_) {
      const std::size_t j = index(p);
      if (patches[i].size() + patches[j].size() > kMost) continue;
      const std::vector<VertexId>& other = vertices[j];
      std::vector<VertexId> both;
      std::set_union(own.begin(), own.end(), other.begin(), other.end(), std::back_inserter(both));
      if (both.size() > kMost) continue;
      enter(j, patches[i]);
      patches[j].insert(patches[j].end(), patches[i].begin(), patches[i].end());
      patches[i].clear();
      vertices[j] = std::move(both);
      break;
    }
  }
  leave(patches);
}

// Enters that these triangles belong to a patch.
void PatchCutter::enter(std::size_t patch, std::span<const TriangleId> triangles) {
  for (const TriangleId t : triangles) patch_of_[+t] = static_cast<std::int32_t>(patch);
}

// Forgets who belongs to a patch, and drops patches without triangles.
void PatchCutter::leave(Patches& patches) {
  for (const auto& patch : patches)
    for (const TriangleId t : patch) patch_of_[+t] = -1;
  std::erase_if(patches, [](const auto& patch) { return patch.empty(); });
}

// Moves the triangles of small patches, the smallest first, into patches beside them, as long as they find
// room.
void PatchCutter::dissolve_small(Patches& patches) {
  members_.assign(patches.size(), {});
  no_room_near_.assign(patches.size(), false);
  for (std::size_t p = 0; p < patches.size(); ++p) enter(p, patches[p]);
  for (std::size_t size = 1; size < kMost; ++size)
    for (const std::vector<TriangleId>& patch : patches) {
      if (patch.size() != size) continue;
      const std::vector<TriangleId> triangles = patch;
      for (const TriangleId t : triangles)
        if (!move(t, patches)) break;
    }
  leave(patches);
}

// Moves a triangle into a patch that has room, or in place of a triangle that moves on in the same way, so
// that the fewest triangles have to move. Returns false if none of the triangles that were asked finds room.
bool PatchCutter::move(TriangleId triangle, Patches& patches) {
  const auto seek = [&](TriangleId t, std::size_t for_whom) {
    requests_.push_back({t, for_whom});
    seeks_[+t] = true;
  };
  seek(triangle, 0);
  bool found = false;
  for (std::size_t at = 0; at < std::min(requests_.size(), kMostSeeking) && !found; ++at) {
    find_patches_beside(requests_[at].triangle);
    for (const std::int32_t p : beside_) {
      if (no_room_near_[index(p)] || is_left(p, at)) continue;
      if (find_room(requests_[at].triangle, index(p), patches[index(p)])) {
        move_all(at, p, patches);
        found = true;
        break;
      }
      for (const TriangleId other : in_place_of_)
        if (!seeks_[+other]) seek(other, at);
    }
  }
  for (const MoveRequest& s : requests_) {
    if (!found && s.triangle != triangle) no_room_near_[index(patch_of_[+s.triangle])] = true;
    seeks_[+s.triangle] = false;
  }
  requests_.clear();
  return found;
}

// Finds the patches of the cell on the other side of the triangle's edges, at most kMostBeside.
void PatchCutter::find_patches_beside(TriangleId triangle) {
  beside_.clear();
  for (const EdgeId e : mesh_.edges_of(triangle))
    for (const TriangleId t : mesh_.triangles_at(e)) {
      const std::int32_t patch = patch_of_[+t];
      if (beside_.size() == kMostBeside) return;
      if (patch >= 0 && std::ranges::find(beside_, patch) == beside_.end()) beside_.push_back(patch);
    }
}

// Returns whether a triangle has room in a patch. If not, finds the triangles of the patch that would give it
// room by leaving.
bool PatchCutter::find_room(TriangleId triangle, std::size_t number, std::span<const TriangleId> patch) {
  Members& members = members_[number];
  if (!members.known) members = members_of(patch);
  std::size_t vertices = members.vertices;
  unsigned needed = 0;  // of the patch's vertices
  for (const VertexId v : mesh_.corners(triangle)) {
    const unsigned place = place_of(members, v);
    vertices += place == 0;
    needed |= place;
  }
  const bool is_free = patch.size() < kMost && vertices <= kMost;
  in_place_of_.clear();
  for (std::size_t i = 0; i < patch.size() && !is_free; ++i) {
    const auto left_over = static_cast<std::size_t>(std::popcount(members.only_its_own[i] & ~needed));
    if (vertices - left_over <= kMost) in_place_of_.push_back(patch[i]);
  }
  return is_free;
}

// The bit of a vertex that the patch has, or 0.
unsigned PatchCutter::place_of(const Members& members, VertexId vertex) {
  unsigned bit = 0;
  for (std::size_t i = 0; i < kMost; ++i) bit |= unsigned{members.vertex[i] == vertex} << i;
  return bit;
}

PatchCutter::Members PatchCutter::members_of(std::span<const TriangleId> patch) {
  Members members;
  members.known = true;
  members.vertex.fill(VertexId{-1});
  std::array<Mask16, kMost> corners{};
  unsigned once = 0, again = 0;
  for (std::size_t i = 0; i < patch.size(); ++i)
    for (const VertexId v : mesh_.corners(patch[i])) {
      std::uint8_t& place = place_[+v];
      if (place == kNoPlace) {
        place = static_cast<std::uint8_t>(members.vertices);
        members.vertex[members.vertices++] = v;
      }
      const unsigned bit = 1U << place;
      again |= once & bit;
      once |= bit;
      corners[i] |= static_cast<Mask16>(bit);
    }
  for (std::size_t i = 0; i < patch.size(); ++i)
    members.only_its_own[i] = static_cast<Mask16>(corners[i] & ~again);
  for (std::size_t i = 0; i < members.vertices; ++i) place_[+members.vertex[i]] = kNoPlace;
  return members;
}

// Whether a triangle of the patch is among those that move if this one does.
bool PatchCutter::is_left(std::int32_t patch, std::size_t at) const {
  while (patch_of_[+requests_[at].triangle] != patch) {
    if (at == 0) return false;
    at = requests_[at].for_whom;
  }
  return true;
}

// Moves that triangle into a patch, the triangle for which it makes room into the patch that it leaves, and
// so on.
void PatchCutter::move_all(std::size_t at, std::int32_t to, Patches& patches) {
  while (true) {
    const auto [triangle, for_whom] = requests_[at];
    const std::int32_t from = std::exchange(patch_of_[+triangle], to);
    members_[index(from)].known = members_[index(to)].known = false;
    std::erase(patches[index(from)], triangle);
    patches[index(to)].push_back(triangle);
    if (at == 0) return;
    at = for_whom, to = from;
  }
}

}  // namespace cscd::fast
