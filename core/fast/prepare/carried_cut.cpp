#include "core/fast/prepare/carried_cut.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/digest.h"
#include "core/base/error.h"
#include "core/fast/clusters/surface_clusters.h"
#include "core/fast/prepare/cluster_observer.h"
#include "core/fast/prepare/patch_cutter.h"
#include "core/mesh/adjacency.h"

namespace cscd::fast {
namespace {

// A cluster gets another observer once one in so many of its triangles is new.
constexpr std::size_t kNewShare = 8;

// Finds triangles and vertices by their digests: one table, because a map would allocate each of its entries.
class ByDigest {
 public:
  explicit ByDigest(std::span<const std::uint64_t> digests) : slots_(std::bit_ceil(2 * digests.size() + 1)) {
    for (std::size_t i = 0; i < digests.size(); ++i) {
      Slot& slot = of(digests[i]);
      // Where several have one digest, none of them is told from the others.
      slot = {digests[i], slot.is_used ? kNone : static_cast<std::int32_t>(i), true};
    }
  }
  // Returns the number of what has this digest, kNone if there is none.
  std::int32_t find(std::uint64_t digest) { return of(digest).number; }
  // The same, and nothing has it any more.
  std::int32_t take(std::uint64_t digest) { return std::exchange(of(digest).number, kNone); }

 private:
  struct Slot {
    std::uint64_t digest = 0;
    std::int32_t number = kNone;
    bool is_used = false;
  };
  Slot& of(std::uint64_t digest) {
    std::size_t at = digest & (slots_.size() - 1);
    while (slots_[at].is_used && slots_[at].digest != digest) at = (at + 1) & (slots_.size() - 1);
    return slots_[at];
  }
  std::vector<Slot> slots_;  // at most half of them are used
};

std::vector<std::uint64_t> vertex_digests(std::span<const Vec3> reference) {
  std::vector<std::uint64_t> digests;
  digests.reserve(reference.size());
  for (const Vec3& place : reference)
    digests.push_back(digest_of_words(std::as_bytes(std::span(place.data(), 3))));
  return digests;
}

std::vector<std::uint64_t> digests_of(const TriangleMesh& mesh, std::span<const std::uint64_t> vertex) {
  std::vector<std::uint64_t> digests;
  digests.reserve(mesh.triangle_count());
  for (const Triangle& corners : mesh.triangles()) {
    std::array<std::uint64_t, 3> of{vertex[+corners[0]], vertex[+corners[1]], vertex[+corners[2]]};
    std::rotate(of.begin(), std::ranges::min_element(of), of.end());
    digests.push_back(digest_of_words(std::as_bytes(std::span(of))));
  }
  return digests;
}

// Returns the triangle of the earlier surface that each triangle was, kNone for a new one.
std::vector<std::int32_t> origins(std::span<const std::uint64_t> before, std::span<const std::uint64_t> now) {
  ByDigest triangle(before);
  std::vector<std::int32_t> origin;
  origin.reserve(now.size());
  for (const std::uint64_t digest : now) origin.push_back(triangle.take(digest));
  return origin;
}

// Lets a new triangle take the clusters of the nearest one that has stayed. kNone is left where a whole
// component is new.
std::vector<std::int32_t> nearest_origins(const TriangleMesh& mesh, std::vector<std::int32_t> like) {
  std::vector<TriangleId> queue;
  for (std::size_t t = 0; t < like.size(); ++t)
    if (like[t] == kNone)
      for_each_neighbour(mesh, TriangleId{static_cast<std::int32_t>(t)}, [&](TriangleId other) {
        if (like[+other] != kNone) queue.push_back(other);
      });
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const TriangleId t = queue[next];
    for_each_neighbour(mesh, t, [&](TriangleId other) {
      if (like[+other] != kNone) return;
      like[+other] = like[+t];
      queue.push_back(other);
    });
  }
  return like;
}

// Returns the clusters that components without a triangle from before are cut into; kNone for all other
// triangles.
std::vector<std::int32_t> clusters_of_new_components(const TriangleMesh& mesh,
                                                     std::span<const Vec3> reference,
                                                     std::span<const std::int32_t> like) {
  std::vector<std::int32_t> cluster(like.size(), kNone);
  std::vector<std::size_t> numbers;
  std::vector<Triangle> corners;
  for (std::size_t t = 0; t < like.size(); ++t)
    if (like[t] == kNone) {
      numbers.push_back(t);
      corners.push_back(mesh.triangles()[t]);
    }
  if (corners.empty()) return cluster;
  const std::vector<std::int32_t> found =
      surface_clusters(TriangleMesh(std::move(corners), mesh.vertex_count()), reference);
  for (std::size_t i = 0; i < numbers.size(); ++i) cluster[numbers[i]] = found[i];
  return cluster;
}

// Numbers what is left of the clusters from 0, in the order of their first triangles. A cluster that has been
// cut into two components becomes two. Returns the number from before for each, kNone for a new cluster.
std::vector<std::int32_t> renumber(const TriangleMesh& mesh, std::int32_t count_before,
                                   std::vector<std::int32_t>& cluster_of) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> number;  // of a cluster in a component
  std::vector<std::int32_t> before;
  std::pair last(kNone, kNone);
  std::int32_t its_number = kNone;
  for (std::size_t t = 0; t < cluster_of.size(); ++t) {
    if (cluster_of[t] == kNone) continue;
    const std::pair here(cluster_of[t], mesh.component(TriangleId{static_cast<std::int32_t>(t)}));
    if (here != last) {
      const auto [at, is_new] = number.try_emplace(here, static_cast<std::int32_t>(number.size()));
      if (is_new) before.push_back(here.first < count_before ? here.first : kNone);
      last = here, its_number = at->second;
    }
    cluster_of[t] = its_number;
  }
  return before;
}

// Returns the vertex of a cluster that is nearest to a place, kNone where the place is not finite.
VertexId nearest_vertex(const TriangleMesh& mesh, std::span<const Vec3> reference,
                        std::span<const TriangleId> cluster, const Vec3& place) {
  VertexId nearest{kNone};
  double least = std::numeric_limits<double>::infinity();
  for (const TriangleId t : cluster)
    for (const VertexId v : mesh.corners(t)) {
      const double distance = (reference[+v] - place).squaredNorm();
      if (!(distance < least)) continue;
      least = distance;
      nearest = v;
    }
  return nearest;
}

// Gives every cluster an observer. `before` is what renumber() returned.
void place_observers(const TriangleMesh& mesh, std::span<const Vec3> reference, ByDigest& vertex_at,
                     std::span<const std::int32_t> origin, std::span<const std::int32_t> before,
                     const Cover& earlier, std::span<const std::vector<Vec3>> places, Cover& cover) {
  std::vector<std::vector<TriangleId>> members(before.size());
  std::vector<std::size_t> added(before.size(), 0);
  for (std::size_t t = 0; t < cover.cluster_of.size(); ++t) {
    if (cover.cluster_of[t] == kNone) continue;
    members[index(cover.cluster_of[t])].push_back(TriangleId{static_cast<std::int32_t>(t)});
    added[index(cover.cluster_of[t])] += origin[t] == kNone;
  }
  const auto is_of = [&](VertexId vertex, std::size_t cluster) {
    return std::ranges::any_of(mesh.triangles_at(vertex), [&](TriangleId t) {
      return cover.cluster_of[+t] == static_cast<std::int32_t>(cluster);
    });
  };
  // An observer follows the vertices of its cluster in the places, or else near them, of those it followed.
  const auto moved_over = [&](std::size_t cluster) {
    const FollowingPoint& was = earlier.observers[index(before[cluster])];
    const std::vector<Vec3>& at = places[index(before[cluster])];
    FollowingPoint observer;
    for (std::size_t i = 0; i < at.size(); ++i) {
      VertexId vertex{vertex_at.find(vertex_digests({&at[i], 1})[0])};
      if (vertex == VertexId{kNone} || !is_of(vertex, cluster))
        vertex = nearest_vertex(mesh, reference, members[cluster], at[i]);
      if (vertex == VertexId{kNone}) return observer_of(mesh, reference, members[cluster]);
      observer.add(vertex, was.weights()[i]);
    }
    observer.stand_off(was.height());
    return observer;
  };
  for (std::size_t c = 0; c < before.size(); ++c) {
    const bool anew = before[c] == kNone || added[c] * kNewShare > members[c].size();
    cover.observers.push_back(anew ? observer_of(mesh, reference, members[c]) : moved_over(c));
  }
}

// Takes over the patches whose triangles have all stayed in one cluster of each cover, and cuts what is left.
PatchList carry_patches(const TriangleMesh& mesh, std::span<const Vec3> reference, const Covers& covers,
                        const EarlierCut& earlier, std::span<const std::int32_t> origin,
                        std::span<const std::int32_t> like) {
  const auto clusters_of = [&](std::size_t t) {
    return std::tuple(covers[0].cluster_of[t], covers[1].cluster_of[t], covers[2].cluster_of[t]);
  };
  static_assert(kCovers == 3);
  // Of each triangle from before: which it is now, and its cell.
  std::vector<TriangleId> now(earlier.digests.size(), TriangleId{kNone});
  std::vector<std::int32_t> cell_of(earlier.digests.size(), kNone);
  for (std::size_t t = 0; t < origin.size(); ++t)
    if (origin[t] != kNone) now[index(origin[t])] = TriangleId{static_cast<std::int32_t>(t)};
  PatchList patches;
  std::vector<bool> taken(origin.size(), false);
  const auto& [triangles_before, cells_before] = earlier.decided.patches;
  for (std::size_t p = 0; p < triangles_before.size(); ++p) {
    std::vector<TriangleId> patch;
    for (const TriangleId t : triangles_before[p]) {
      cell_of[+t] = cells_before[p];
      if (now[+t] != TriangleId{kNone}) patch.push_back(now[+t]);
    }
    if (patch.size() != triangles_before[p].size()) continue;
    if (!std::ranges::all_of(patch, [&](TriangleId t) { return clusters_of(+t) == clusters_of(+patch[0]); }))
      continue;
    // Where the surface was cut open between two triangles of a patch, they no longer share vertices.
    if (vertices_of(mesh, patch).size() > kLanes16) continue;
    for (const TriangleId t : patch) taken[+t] = true;
    patches.triangles.push_back(std::move(patch));
    patches.cell.push_back(cells_before[p]);
  }
  // Everything that is left and alike is one cell of the cutter.
  std::map<std::pair<std::int32_t, decltype(clusters_of(0))>, std::vector<TriangleId>> left;
  for (std::size_t t = 0; t < taken.size(); ++t)
    if (!taken[t])
      left[{like[t] == kNone ? kNone : cell_of[index(like[t])], clusters_of(t)}].push_back(
          TriangleId{static_cast<std::int32_t>(t)});
  const std::vector<Vec3> centroid = centroids(mesh, reference);
  PatchCutter cutter(mesh, centroid);
  for (const auto& [alike, triangles] : left)
    for (std::vector<TriangleId>& patch : cutter.cut(triangles)) {
      patches.triangles.push_back(std::move(patch));
      patches.cell.push_back(alike.first);
    }
  return patches;
}

void check_cover(const TriangleMesh& mesh, const Cover& cover) {
  for (const FollowingPoint& observer : cover.observers)
    for (const VertexId v : observer.vertices())
      if (static_cast<std::int32_t>(v) < 0 || +v >= mesh.vertex_count())
        refuse_preparation("has an observer at a vertex that the mesh lacks");
  std::vector<std::int32_t> component(cover.observers.size(), kNone);
  for (std::size_t t = 0; t < cover.cluster_of.size(); ++t) {
    if (cover.cluster_of[t] == kNone) continue;
    std::int32_t& own = component[static_cast<std::size_t>(cover.cluster_of[t])];
    const std::int32_t here = mesh.component(TriangleId{static_cast<std::int32_t>(t)});
    if (own != kNone && own != here) refuse_preparation("has a cluster in two components");
    own = here;
  }
  if (std::ranges::find(component, kNone) != component.end()) refuse_preparation("has an empty cluster");
}

void check_patches(const TriangleMesh& mesh, const DecidedCut& decided) {
  std::vector<bool> met(mesh.triangle_count(), false);
  std::size_t triangles = 0;
  for (const std::vector<TriangleId>& patch : decided.patches.triangles) {
    for (const TriangleId t : patch) {
      if (static_cast<std::int32_t>(t) < 0 || +t >= met.size() || met[+t])
        refuse_preparation("has a triangle in two patches");
      met[+t] = true;
      ++triangles;
      for (const Cover& cover : decided.covers)
        if (cover.cluster_of[+t] != cover.cluster_of[+patch.front()])
          refuse_preparation("has a patch in two clusters");
    }
    if (vertices_of(mesh, patch).size() > kLanes16) refuse_preparation("has a patch of too many vertices");
  }
  if (triangles != met.size()) refuse_preparation("has a triangle in no patch");
}

}  // namespace

void refuse_preparation(const std::string& fault) {
  throw InputError("preparation: " + fault + "; prepare anew without it");
}

void check(const TriangleMesh& mesh, const DecidedCut& decided) {
  for (const Cover& cover : decided.covers) check_cover(mesh, cover);
  const std::vector<std::int32_t>& first = decided.covers[0].cluster_of;
  if (std::ranges::find(first, kNone) != first.end()) refuse_preparation("has a triangle without a cluster");
  check_patches(mesh, decided);
}

CutSurface finished(const TriangleMesh& mesh, std::span<const Vec3> reference, DecidedCut decided) {
  CutSurface cut{std::move(decided.covers), {}};
  cut.tree = make_tree(mesh, reference, decided.patches, cut.covers[0].cluster_of);
  for (std::size_t c = 0; c < kCovers; ++c) enter_cover(mesh, cut.covers[c], c, cut.tree);
  return cut;
}

std::vector<std::uint64_t> triangle_digests(const TriangleMesh& mesh, std::span<const Vec3> reference) {
  return digests_of(mesh, vertex_digests(reference));
}

CarriedCut carried_over(const TriangleMesh& mesh, std::span<const Vec3> reference,
                        const EarlierCut& earlier) {
  const std::vector<std::uint64_t> vertices = vertex_digests(reference);
  const std::vector<std::int32_t> origin = origins(earlier.digests, digests_of(mesh, vertices));
  const auto new_triangles = static_cast<std::size_t>(std::ranges::count(origin, kNone));
  if (2 * new_triangles > origin.size()) refuse_preparation("was made for another surface");
  const std::vector<std::int32_t> like = nearest_origins(mesh, origin);
  const std::vector<std::int32_t> of_new = clusters_of_new_components(mesh, reference, like);

  ByDigest vertex_at(vertices);
  CarriedCut carried{{earlier.decided.covers_used, {}, {}}, new_triangles};
  for (std::size_t c = 0; c < kCovers; ++c) {
    const Cover& before = earlier.decided.covers[c];
    const auto count = static_cast<std::int32_t>(before.observers.size());
    Cover& cover = carried.decided.covers[c];
    for (std::size_t t = 0; t < like.size(); ++t)
      cover.cluster_of.push_back(like[t] != kNone ? before.cluster_of[index(like[t])]
                                 : c == 0         ? count + of_new[t]
                                                  : kNone);
    const std::vector<std::int32_t> numbers_before = renumber(mesh, count, cover.cluster_of);
    place_observers(mesh, reference, vertex_at, origin, numbers_before, before, earlier.places[c], cover);
  }
  carried.decided.patches = carry_patches(mesh, reference, carried.decided.covers, earlier, origin, like);
  return carried;
}

}  // namespace cscd::fast
