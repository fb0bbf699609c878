#include "scenes/import/surface.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/base/error.h"
#include "core/base/number_text.h"
#include "scenes/import/fill_holes.h"

namespace cscd::scenes {
namespace {

// Seams are welded in the bind pose and then checked in this many poses, spread over all clips, so that the
// surface does not depend on the clip that is chosen.
constexpr std::size_t kProbes = 32;
// In other poses the vertices of a seam may move apart by this many weld tolerances, because
// their weights are rounded.
constexpr double kPosedSlack = 100;

// Returns the positions of all raw vertices in poses that are spread over all clips.
std::vector<std::vector<Vec3>> probes(const Character& character) {
  std::vector<std::vector<Vec3>> positions;
  if (character.animations.empty()) return positions;
  const std::size_t clips = std::min(character.animations.size(), kProbes);
  const std::size_t each = kProbes / clips;
  for (std::size_t c = 0; c < clips; ++c) {
    const Animation& animation = character.animations[c];
    for (std::size_t i = 0; i < each; ++i) {
      const double share = each == 1 ? 0.5 : static_cast<double>(i) / static_cast<double>(each - 1);
      const double seconds = animation.start + share * animation.seconds;
      skin(character, pose_at(character, animation, seconds), weights_at(character, animation, seconds),
           positions.emplace_back());
    }
  }
  return positions;
}

struct Welded {
  std::vector<std::int32_t> group;
  WeldedTriangles surface;
};

Welded weld_at(const RawSurface& raw, std::span<const std::vector<Vec3>> poses, double share) {
  const double tolerance = share * raw.diagonal;
  Welded result{weld(raw.positions, tolerance), {}};
  for (const std::vector<Vec3>& pose : poses) split_groups(result.group, pose, kPosedSlack * tolerance);
  result.surface = welded(raw.triangles, result.group);
  return result;
}

// Welds at the largest tolerance, up to the default, that does no harm. A tolerance does harm if a triangle
// collapses that would not collapse when only equal vertices are joined, or if an edge gets a third
// triangle because two sides of something thin were joined. A tolerance that the user names is used, or
// refused if it does harm.
Welded weld_surface(const RawSurface& raw, std::span<const std::vector<Vec3>> poses,
                    const std::optional<double>& wanted, ImportReport& report) {
  const auto crowded = [&](const Welded& w) {
    return crowded_edges(w.surface.triangles, raw.positions.size());
  };
  // Vertices that are equal in the file are joined at a tolerance of a few roundings of the file's floats.
  const double least = 1e-8;
  const Welded exact = weld_at(raw, poses, least);
  const std::size_t exact_crowded = crowded(exact);
  for (double share = wanted.value_or(kDefaultWeld);; share = share > 10 * least ? share / 10 : least) {
    Welded tried = share <= least && !wanted ? exact : weld_at(raw, poses, share);
    report.weld_tolerance = share;
    const std::size_t collapsed =
        tried.surface.collapsed - std::min(exact.surface.collapsed, tried.surface.collapsed);
    const std::size_t joined = crowded(tried) - std::min(exact_crowded, crowded(tried));
    if (share <= least || (collapsed == 0 && joined == 0)) return tried;
    const std::string what = std::to_string(collapsed) + " triangles collapse and " + std::to_string(joined) +
                             " edges get more than two triangles";
    const std::string shown = exact_text(share);
    if (wanted) throw InputError("--weld " + shown + ": " + what + "; choose a smaller tolerance");
    report.notes.push_back("weld tolerance " + shown + " is too large: " + what);
  }
}

// Turns round the triangles of closed components that face inward. Returns the number of these components.
std::size_t flip_inward(std::vector<Triangle>& triangles, std::span<const Vec3> positions) {
  std::size_t flipped = 0;
  for (const Piece& piece : pieces_of(TriangleMesh(triangles, positions.size()))) {
    if (!piece.mesh.closed_and_oriented() || signed_volume(piece, positions) >= 0) continue;
    ++flipped;
    for (const TriangleId t : piece.triangles) std::swap(triangles[+t][1], triangles[+t][2]);
  }
  return flipped;
}

ChosenSurface choose(const WeldedTriangles& surface, std::size_t raw_vertices, const ImportOptions& options,
                     ImportReport& report) {
  const std::vector<Triangle>& triangles = surface.triangles;
  const TriangleMesh mesh(triangles, raw_vertices);
  ChosenSurface chosen;
  chosen.pieces = pieces_of(mesh);
  const std::vector<Piece>& pieces = chosen.pieces;
  report.components = pieces.size();
  report.chosen_components = choose_pieces(pieces, options.survey ? "all" : options.component);
  std::vector<bool> wanted(pieces.size(), false);
  for (const std::size_t p : report.chosen_components) wanted[p] = true;

  std::vector<std::int32_t> number(raw_vertices, -1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!wanted[static_cast<std::size_t>(mesh.component(TriangleId{static_cast<std::int32_t>(t)}))]) continue;
    chosen.triangles.push_back(triangles[t]);
    chosen.raw_triangle.push_back(surface.source[t]);
    for (const VertexId v : triangles[t]) number[+v] = 0;
  }
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] == 0) {
      number[v] = static_cast<std::int32_t>(chosen.raw_vertex.size());
      chosen.raw_vertex.push_back(static_cast<std::int32_t>(v));
    }
  for (Triangle& t : chosen.triangles)
    for (VertexId& v : t) v = VertexId{number[+v]};
  report.chosen_triangles = chosen.triangles.size();
  return chosen;
}

}  // namespace

std::string note_on_points(std::size_t count) {
  return std::to_string(count) +
         (count == 1 ? " vertex is of no face: a point that touches faces, and crosses nothing"
                     : " vertices are of no face: points that touch faces, and cross nothing");
}

std::string note_on_loose_vertices(std::size_t count) {
  return std::to_string(count) +
         (count == 1 ? " vertex is of no face and is" : " vertices are of no face and are") +
         " left out: no answer is about " + (count == 1 ? "it" : "them");
}

RawSurface raw_surface(const Character& character) {
  RawSurface raw;
  raw.bound = bind_pose(character);
  skin(character, raw.bound, raw.positions);
  require_finite(raw.positions, "bind pose");
  Eigen::AlignedBox3d box;
  std::int32_t first = 0;
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const Part& part = character.parts[p];
    raw.first_vertex.push_back(first);
    raw.triangle_part.insert(raw.triangle_part.end(), part.triangles.size(), static_cast<std::int32_t>(p));
    for (const RawTriangle& t : part.triangles) {
      raw.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      for (const std::int32_t corner : raw.triangles.back())
        box.extend(raw.positions[static_cast<std::size_t>(corner)]);
    }
    first += static_cast<std::int32_t>(part.positions.size());
  }
  if (raw.triangles.empty())
    throw InputError("holds " + std::to_string(character.nodes.size()) + " nodes and " +
                     std::to_string(character.animations.size()) +
                     " clips, but no triangles; export it together with its mesh");
  raw.diagonal = box.diagonal().norm();
  if (!(raw.diagonal > 0)) throw InputError("all vertices lie in one point; repair the model");
  return raw;
}

ChosenSurface choose_surface(const Character& character, const RawSurface& raw, const ImportOptions& options,
                             ImportReport& report) {
  std::vector<bool> has_face(raw.positions.size(), false);
  for (const RawTriangle& t : raw.triangles)
    for (const std::int32_t corner : t) has_face[static_cast<std::size_t>(corner)] = true;
  if (const auto loose = static_cast<std::size_t>(std::ranges::count(has_face, false)); loose > 0)
    report.notes.push_back(note_on_loose_vertices(loose));
  Welded surface = weld_surface(raw, probes(character), options.weld, report);
  report.collapsed_triangles = surface.surface.collapsed;
  report.duplicate_triangles = surface.surface.duplicate;
  std::vector<Triangle>& triangles = surface.surface.triangles;
  if (triangles.empty()) throw InputError("no triangle has three corners of its own; repair the model");

  if (const std::size_t edges = options.fill_holes.value_or(0); edges > 0) {
    const FilledHoles filled =
        fill_holes(TriangleMesh(triangles, raw.positions.size()), raw.positions, edges);
    triangles.insert(triangles.end(), filled.triangles.begin(), filled.triangles.end());
    surface.surface.source.resize(triangles.size(), ChosenSurface::kFilled);
    report.filled_holes = filled.holes;
    report.filled_triangles = filled.triangles.size();
    if (filled.left > 0)
      report.notes.push_back(std::to_string(filled.left) + " holes left open: too long, or tangled");
  }
  if (options.flip_inward) report.flipped_components = flip_inward(triangles, raw.positions);

  ChosenSurface chosen = choose(surface.surface, raw.positions.size(), options, report);
  chosen.weld_group = std::move(surface.group);
  report.welded_vertices = static_cast<std::size_t>(
      std::count_if(chosen.weld_group.begin(), chosen.weld_group.end(),
                    [v = std::int32_t{0}](std::int32_t group) mutable { return group != v++; }));
  return chosen;
}

}  // namespace cscd::scenes
