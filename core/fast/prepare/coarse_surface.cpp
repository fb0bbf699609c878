#include "core/fast/prepare/coarse_surface.h"

#include <algorithm>
#include <limits>

#include "core/fast/clusters/seams.h"
#include "core/fast/prepare/covers.h"
#include "core/fast/prepare/rings.h"

namespace cscd::fast {
namespace {

// The next level is made at most this many times. Each attempt keeps more vertices than the one before.
constexpr int kAttempts = 4;
// A level that has more than this share of the finer level's triangles is not worth its work.
constexpr double kMostLeft = 0.7;
constexpr std::int32_t kBand = 3;  // so many rings of triangles on both sides of a seam are labelled anew

// Returns the vertices to keep, ascending: those that have to stay, and enough of the others that every
// vertex of a triangle is kept or has a kept vertex beside it. Of the others no two are neighbours.
std::vector<VertexId> kept_of(const TriangleMesh& mesh, const std::vector<bool>& has_to_stay) {
  std::vector<VertexId> kept;
  std::vector<bool> beside(mesh.vertex_count());
  for (std::size_t i = 0; i < beside.size(); ++i) {
    const VertexId v{static_cast<std::int32_t>(i)};
    if ((beside[i] && !has_to_stay[i]) || mesh.triangles_at(v).empty()) continue;
    kept.push_back(v);
    for (const TriangleId t : mesh.triangles_at(v))
      for (const VertexId corner : mesh.corners(t)) beside[+corner] = true;
  }
  return kept;
}

// Returns for each vertex the number of the nearest kept vertex beside it, [vertices]; for a kept vertex its
// own.
std::vector<std::int32_t> nearest_kept(const TriangleMesh& mesh, std::span<const Vec3> positions,
                                       std::span<const VertexId> kept) {
  std::vector<std::int32_t> nearest(mesh.vertex_count(), kNone);
  std::vector<double> least(mesh.vertex_count(), std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < kept.size(); ++k)
    for (const TriangleId t : mesh.triangles_at(kept[k]))
      for (const VertexId v : mesh.corners(t)) {
        const double way = (positions[+v] - positions[+kept[k]]).squaredNorm();
        if (nearest[+v] != kNone && !(way < least[+v])) continue;
        nearest[+v] = static_cast<std::int32_t>(k);
        least[+v] = way;
      }
  for (std::size_t k = 0; k < kept.size(); ++k) nearest[+kept[k]] = static_cast<std::int32_t>(k);
  return nearest;
}

// Returns whether the triangles at the vertex form one fan. Every edge at the vertex must have two triangles,
// or the walk round the vertex may never end.
bool is_one_fan(const TriangleMesh& mesh, VertexId v) {
  const std::span<const TriangleId> around = mesh.triangles_at(v);
  const auto at_v = [&](EdgeId e) { return mesh.ends(e)[0] == v || mesh.ends(e)[1] == v; };
  TriangleId triangle = around.front();
  EdgeId edge = *std::ranges::find_if(mesh.edges_of(triangle), at_v);
  std::size_t met = 0;
  do {
    const std::span<const TriangleId> both = mesh.triangles_at(edge);
    triangle = both[both[0] == triangle ? 1 : 0];
    edge = *std::ranges::find_if(mesh.edges_of(triangle), [&](EdgeId e) { return e != edge && at_v(e); });
    ++met;
  } while (triangle != around.front());
  return met == around.size();
}

// Returns for each vertex whether the surface fails to be a closed manifold at the vertex, [vertices].
std::vector<bool> faulty_vertices(const TriangleMesh& mesh) {
  std::vector<bool> faulty(mesh.vertex_count());
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    const EdgeId edge{static_cast<std::int32_t>(e)};
    if (mesh.triangles_at(edge).size() == 2) continue;
    for (const VertexId v : mesh.ends(edge)) faulty[+v] = true;
  }
  for (std::size_t i = 0; i < faulty.size(); ++i) {
    const VertexId v{static_cast<std::int32_t>(i)};
    if (!faulty[i] && !mesh.triangles_at(v).empty()) faulty[i] = !is_one_fan(mesh, v);
  }
  return faulty;
}

// Gives each vertex the label that most of the triangles at it have, [vertices]; kNone for a vertex without
// triangles.
std::vector<std::int32_t> labels_of_vertices(const TriangleMesh& mesh,
                                             std::span<const std::int32_t> label_of) {
  std::vector<std::int32_t> labels;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    std::int32_t most = kNone;
    std::ptrdiff_t times = 0;
    const std::span<const TriangleId> around = mesh.triangles_at(VertexId{static_cast<std::int32_t>(v)});
    const auto label = [&](TriangleId t) { return label_of[+t]; };
    for (const TriangleId t : around) {
      if (label(t) == most) continue;
      const auto count = std::ranges::count(around, label(t), label);
      if (count > times) most = label(t), times = count;
    }
    labels.push_back(most);
  }
  return labels;
}

// Lets labels grow anew over the triangles near seams, and over triangles without a label. Carried seams are
// as jagged as the triangles of the coarser level, and become straight by this.
void straighten(const TriangleMesh& mesh, std::vector<std::int32_t>& label_of) {
  std::vector<std::vector<TriangleId>> seams(1);
  for_each_seam_edge(mesh, label_of, [&](TriangleId a, TriangleId b) {
    seams[0].insert(seams[0].end(), {a, b});
  });
  const Rings band = rings_from(mesh, seams, kBand);
  const auto size = index(*std::ranges::max_element(label_of)) + 1;
  std::vector<std::int32_t> deepest(size, 0);  // [labels]: rings from its seams to where it grows from
  for (std::size_t t = 0; t < label_of.size(); ++t)
    if (label_of[t] != kNone) {
      std::int32_t& depth = deepest[index(label_of[t])];
      depth = std::max(depth, band.distance[t] == kNone ? kBand : band.distance[t]);
    }
  std::vector<std::vector<TriangleId>> grows(size);
  for (std::size_t t = 0; t < label_of.size(); ++t)
    if (label_of[t] != kNone &&
        (band.distance[t] == kNone || band.distance[t] >= deepest[index(label_of[t])]))
      grows[index(label_of[t])].push_back(TriangleId{static_cast<std::int32_t>(t)});
  const Rings grown = rings_from(mesh, grows, std::numeric_limits<std::int32_t>::max());
  for (std::size_t t = 0; t < label_of.size(); ++t)
    if (label_of[t] == kNone || band.distance[t] != kNone)
      if (grown.seed[t] != kNone) label_of[t] = grown.seed[t];
}

}  // namespace

CoarseSurface::CoarseSurface(const TriangleMesh& mesh, std::span<const Vec3> positions, std::size_t enough)
    : mesh_(mesh), positions_(positions) {
  while (this->mesh().triangle_count() > enough) {
    std::unique_ptr<Level> level = coarser(this->mesh(), this->positions());
    if (!level) return;
    levels_.push_back(std::move(level));
  }
}

std::unique_ptr<CoarseSurface::Level> CoarseSurface::coarser(const TriangleMesh& mesh,
                                                             std::span<const Vec3> positions) {
  std::vector<bool> has_to_stay(mesh.vertex_count());
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    std::unique_ptr<Level> level = level_with(mesh, positions, has_to_stay);
    if (!level || level->mesh.triangle_count() > kMostLeft * static_cast<double>(mesh.triangle_count()))
      return nullptr;
    if (!keep_what_fails(mesh, *level, has_to_stay))
      return mesh.closed_and_oriented() && !level->mesh.closed_and_oriented() ? nullptr : std::move(level);
  }
  return nullptr;
}

std::unique_ptr<CoarseSurface::Level> CoarseSurface::level_with(const TriangleMesh& mesh,
                                                                std::span<const Vec3> positions,
                                                                const std::vector<bool>& has_to_stay) {
  const std::vector<VertexId> kept = kept_of(mesh, has_to_stay);
  std::vector<std::int32_t> nearest = nearest_kept(mesh, positions, kept);
  std::vector<Triangle> triangles;
  std::vector<std::size_t> left(index(mesh.component_count()), 0);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    Triangle corners = mesh.triangles()[t];
    for (VertexId& v : corners) v = VertexId{nearest[+v]};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    triangles.push_back(corners);
    ++left[index(mesh.component(TriangleId{static_cast<std::int32_t>(t)}))];
  }
  if (triangles.empty()) return nullptr;
  auto level = std::make_unique<Level>(
      Level{std::move(nearest), TriangleMesh(std::move(triangles), kept.size()), {}, std::move(left)});
  for (const VertexId v : kept) level->positions.push_back(positions[+v]);
  return level;
}

bool CoarseSurface::keep_what_fails(const TriangleMesh& mesh, const Level& level,
                                    std::vector<bool>& has_to_stay) {
  const bool closed = mesh.closed_and_oriented();
  const std::size_t least = closed ? 4 : 1;  // a closed component of two triangles has them twice
  bool any = false;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const TriangleId triangle{static_cast<std::int32_t>(t)};
    if (level.left[index(mesh.component(triangle))] >= least) continue;
    any = true;
    for (const VertexId v : mesh.corners(triangle)) has_to_stay[+v] = true;
  }
  if (!closed || level.mesh.closed_and_oriented()) return any;
  const std::vector<bool> faulty = faulty_vertices(level.mesh);
  // The vertices beside faulty ones stay too. Without them the next attempt often fails right beside.
  std::vector<bool> stays(faulty.size());
  for (const Triangle& corners : level.mesh.triangles())
    if (std::ranges::any_of(corners, [&](VertexId v) { return faulty[+v]; }))
      for (const VertexId v : corners) stays[+v] = true;
  for (std::size_t v = 0; v < has_to_stay.size(); ++v)
    if (level.kept[v] != kNone && stays[index(level.kept[v])]) any = has_to_stay[v] = true;
  return any;
}

std::vector<std::int32_t> CoarseSurface::coarse_labels(std::span<const std::int32_t> label_of) const {
  std::vector<std::int32_t> labels(label_of.begin(), label_of.end());
  for (const std::unique_ptr<Level>& level : levels_) {
    std::vector<std::int32_t> coarser(level->mesh.vertex_count());
    for (std::size_t v = 0; v < labels.size(); ++v)
      if (level->kept[v] != kNone) coarser[index(level->kept[v])] = labels[v];
    labels = std::move(coarser);
  }
  return labels;
}

std::vector<std::int32_t> CoarseSurface::carried(std::vector<std::int32_t> label_of) const {
  for (std::size_t l = levels_.size(); l-- > 0;) {
    const Level& level = *levels_[l];
    const TriangleMesh& finer = l > 0 ? levels_[l - 1]->mesh : mesh_;
    const std::vector<std::int32_t> labels = labels_of_vertices(level.mesh, label_of);
    label_of.assign(finer.triangle_count(), kNone);
    for (std::size_t t = 0; t < label_of.size(); ++t) {
      std::int32_t of[3];
      for (std::size_t k = 0; k < 3; ++k) of[k] = labels[index(level.kept[+finer.triangles()[t][k]])];
      label_of[t] = of[1] == of[2] || of[0] == kNone ? of[1] : of[0];
    }
    straighten(finer, label_of);
  }
  return label_of;
}

}  // namespace cscd::fast
