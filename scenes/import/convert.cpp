#include "scenes/import/convert.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>

#include "core/base/error.h"
#include "scenes/character/pieces.h"
#include "scenes/character/pose.h"
#include "scenes/character/skeleton.h"
#include "scenes/character/weld.h"
#include "scenes/clip/point_cache.h"
#include "scenes/import/fill_holes.h"

namespace cscd::scenes {
namespace {

// Seams are welded in the bind pose and looked at in this many poses of all clips together, so that the
// surface does not depend on the clip that is chosen.
constexpr std::size_t kProbes = 32;
// Debris of many thousand pieces is not told bone by bone.
constexpr std::size_t kMostPiecesWithBones = 1000;
// In other poses the vertices of a seam may part by this many weld tolerances: their weights are rounded.
constexpr double kPosedSlack = 100;

std::size_t frames_of(const Animation& animation, double fps) {
  return static_cast<std::size_t>(std::floor(animation.seconds * fps + 1e-6)) + 1;
}

// The surface in the bind pose: vertices of all parts one after the other.
struct Raw {
  Pose bound;
  std::vector<Vec3> positions;
  std::vector<RawTriangle> triangles;
  double diagonal = 0;
};

Raw raw_surface(const Character& character) {
  Raw raw;
  raw.bound = bind_pose(character);
  skin(character, raw.bound, raw.positions);
  require_finite(raw.positions, "bind pose");
  Eigen::AlignedBox3d box;
  std::int32_t first = 0;
  for (const Part& part : character.parts) {
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

// Positions in poses that are spread over all clips.
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

Welded weld_at(const Raw& raw, std::span<const std::vector<Vec3>> poses, double share) {
  const double tolerance = share * raw.diagonal;
  Welded result{weld(raw.positions, tolerance), {}};
  for (const std::vector<Vec3>& pose : poses) split_groups(result.group, pose, kPosedSlack * tolerance);
  result.surface = welded(raw.triangles, result.group);
  return result;
}

// The largest tolerance up to the default at which no triangle collapses that does not collapse anyway, and
// no edge gets a third triangle because two sides of something thin became one. A tolerance that the user
// names is taken or refused.
Welded weld_surface(const Raw& raw, std::span<const std::vector<Vec3>> poses,
                    const std::optional<double>& wanted, ImportReport& report) {
  const auto crowded = [&](const Welded& w) {
    return crowded_edges(w.surface.triangles, raw.positions.size());
  };
  // What is equal in the file is told from what is near by a tolerance of a few roundings of its floats.
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
    char number[32];
    const std::string shown(number, std::to_chars(number, number + sizeof number, share).ptr);
    if (wanted) throw InputError("--weld " + shown + ": " + what + "; choose a smaller tolerance");
    report.notes.push_back("weld tolerance " + shown + " is too large: " + what);
  }
}

// Triangles of components that face inward, turned round.
std::size_t flip_inward(std::vector<Triangle>& triangles, std::span<const Vec3> positions) {
  std::size_t flipped = 0;
  for (const Piece& piece : pieces_of(TriangleMesh(triangles, positions.size()))) {
    if (!piece.mesh.closed_and_oriented() || signed_volume(piece, positions) >= 0) continue;
    ++flipped;
    for (const TriangleId t : piece.triangles) std::swap(triangles[+t][1], triangles[+t][2]);
  }
  return flipped;
}

// The chosen surface with vertices numbered anew.
struct Chosen {
  std::vector<Piece> pieces;  // all of the surface
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> raw_vertex;  // of each vertex
};

Chosen choose(const std::vector<Triangle>& triangles, std::size_t raw_vertices, const ImportOptions& options,
              ImportReport& report) {
  const TriangleMesh mesh(triangles, raw_vertices);
  Chosen chosen;
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

// The bones that a clip moves against the bone above: by a channel of their own, or by one of the nodes
// between, which are no bones.
std::size_t driven_bones(const Character& character, const Animation& animation,
                         const std::vector<int>& bones) {
  std::vector<bool> channel(character.nodes.size(), false), bone(channel);
  for (const Channel& c : animation.channels) channel[static_cast<std::size_t>(c.node)] = true;
  for (const int b : bones) bone[static_cast<std::size_t>(b)] = true;
  return static_cast<std::size_t>(std::count_if(bones.begin(), bones.end(), [&](int b) {
    auto node = static_cast<std::size_t>(b);
    while (!channel[node]) {
      const int above = character.nodes[node].parent;
      if (above < 0 || bone[static_cast<std::size_t>(above)]) return false;
      node = static_cast<std::size_t>(above);
    }
    return true;
  }));
}

void describe(const Character& character, const ImportOptions& options, ImportReport& report) {
  report.format = character.format;
  report.centimetres_per_unit = character.centimetres_per_unit;
  report.notes = character.notes;
  report.nodes = character.nodes.size();
  report.meshes = character.parts.size();
  report.fps = options.fps;
  for (const Part& part : character.parts) {
    report.vertices += part.positions.size();
    report.triangles += part.triangles.size();
    for (std::size_t v = 0; v < part.positions.size(); ++v)
      report.most_influences = std::max(report.most_influences, part.first[v + 1] - part.first[v]);
  }
  const std::vector<int> moving = moving_nodes(character);
  report.joints = moving.size();
  for (const Animation& animation : character.animations) {
    report.clips.push_back({animation.name, animation.seconds, animation.ticks_per_second,
                            frames_of(animation, options.fps), driven_bones(character, animation, moving)});
  }
}

std::string known_clips(const Character& character) {
  std::string known;
  for (std::size_t i = 0; i < character.animations.size(); ++i)
    known += (i ? ", " : "") + std::to_string(i) + " '" + character.animations[i].name + "'";
  return known;
}

// By name, else by number, else the first that moves.
std::size_t choose_clip(const Character& character, const ImportOptions& options) {
  const auto& all = character.animations;
  if (all.empty())
    throw InputError(
        "has a bind pose but no clip, so nothing moves (" + std::to_string(character.nodes.size()) +
        " nodes, " + std::to_string(moving_nodes(character).size()) +
        " bones); export it with an animation, or pass --from-bind-pose to move to the pose at rest");
  if (options.clip.empty()) {
    for (std::size_t i = 0; i < all.size(); ++i)
      if (frames_of(all[i], options.fps) >= 2) return i;
    if (options.from_bind_pose) return 0;
    throw InputError("has clips of one frame only: " + known_clips(character) +
                     "; pass --from-bind-pose to move from the bind pose to one of them, or a larger --fps");
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].name == options.clip) return i;
  std::size_t number = 0;
  const char* end = options.clip.data() + options.clip.size();
  const auto [stop, error] = std::from_chars(options.clip.data(), end, number);
  if (error != std::errc{} || stop != end || number >= all.size())
    throw InputError("--clip " + options.clip + ": there is no such clip; choose one of " +
                     known_clips(character));
  return number;
}

// Where nodes stand and how far morph targets are blended.
struct Moment {
  Pose pose;
  MorphWeights weights;
};

Moment moment_at(const Character& character, const Animation& animation, double seconds) {
  return {pose_at(character, animation, seconds), weights_at(character, animation, seconds)};
}

// The moments to be written, one after the other.
struct Frames {
  std::size_t count = 0;
  std::function<Moment(std::size_t)> moment;
};

Frames plan(const Character& character, const Pose& bound, const ImportOptions& options,
            ImportReport& report) {
  if (options.survey) {
    const auto start_of_clip = [&character, &bound](std::size_t frame) -> Moment {
      if (frame == 0 || frame > character.animations.size()) return {bound, rest_weights(character)};
      const Animation& animation = character.animations[frame - 1];
      return moment_at(character, animation, animation.start);
    };
    return {std::max<std::size_t>(2, character.animations.size() + 1), start_of_clip};  // a cache has two
  }
  const bool to_rest = character.animations.empty() && options.from_bind_pose;
  if (to_rest) report.notes.push_back("has no clip; moves from the bind pose to the pose at rest");
  const long chosen = to_rest ? -1 : static_cast<long>(choose_clip(character, options));
  const Animation at_rest{};
  const Animation& animation = to_rest ? at_rest : character.animations[static_cast<std::size_t>(chosen)];
  const std::size_t frames = frames_of(animation, options.fps);
  const std::size_t lead_in =
      options.from_bind_pose
          ? std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(kLeadInSeconds * options.fps)))
          : 0;
  report.chosen_clip = chosen;
  report.lead_in = lead_in;
  if (frames + lead_in < 2)
    throw InputError("--clip " + options.clip + ": is one frame; pass --from-bind-pose to move to it");
  const auto moment = [&character, &bound, animation, fps = options.fps,
                       lead_in](std::size_t frame) -> Moment {
    if (frame >= lead_in)
      return moment_at(character, animation, animation.start + static_cast<double>(frame - lead_in) / fps);
    const Moment start = moment_at(character, animation, animation.start);
    const double share = static_cast<double>(frame) / static_cast<double>(lead_in);
    return {blend(character, bound, start.pose, share), blend(rest_weights(character), start.weights, share)};
  };
  return {frames + lead_in, moment};
}

}  // namespace

ImportReport convert(const Character& character, const ImportOptions& options, const CharacterLimits& limits,
                     const std::filesystem::path& cache) {
  ImportReport report;
  describe(character, options, report);
  const Raw raw = raw_surface(character);
  const Frames frames = plan(character, raw.bound, options, report);
  Welded surface = weld_surface(raw, probes(character), options.weld, report);
  report.collapsed_triangles = surface.surface.collapsed;
  report.duplicate_triangles = surface.surface.duplicate;
  std::vector<Triangle>& triangles = surface.surface.triangles;
  if (triangles.empty()) throw InputError("no triangle has three corners of its own; repair the model");

  if (options.fill_holes > 0) {
    const FilledHoles filled =
        fill_holes(TriangleMesh(triangles, raw.positions.size()), raw.positions, options.fill_holes);
    triangles.insert(triangles.end(), filled.triangles.begin(), filled.triangles.end());
    report.filled_holes = filled.holes;
    report.filled_triangles = filled.triangles.size();
    if (filled.left > 0)
      report.notes.push_back(std::to_string(filled.left) + " holes left open: too long, or tangled");
  }
  if (options.flip_inward) report.flipped_components = flip_inward(triangles, raw.positions);

  const Chosen chosen = choose(triangles, raw.positions.size(), options, report);
  report.welded_vertices = static_cast<std::size_t>(
      std::count_if(surface.group.begin(), surface.group.end(),
                    [&, v = std::int32_t{0}](std::int32_t group) mutable { return group != v++; }));
  std::vector<bool> used(raw.positions.size(), false);
  for (const std::int32_t v : chosen.raw_vertex) used[static_cast<std::size_t>(v)] = true;
  const Skeleton skeleton = make_skeleton(character, raw.bound, raw.positions, used);
  if (options.survey && chosen.pieces.size() <= kMostPiecesWithBones)
    for (const Piece& piece : chosen.pieces) {
      std::vector<bool> own(raw.positions.size(), false);
      for (const VertexId v : piece.vertices) own[+v] = true;
      report.component_bones.push_back(make_skeleton(character, raw.bound, raw.positions, own).node.size());
    }

  const std::size_t bytes =
      frames.count * (chosen.raw_vertex.size() + 2 * skeleton.node.size()) * sizeof(Vec3);
  if (frames.count > limits.frames || bytes > limits.cache_bytes)
    throw InputError(std::to_string(frames.count) + " frames of " + std::to_string(chosen.raw_vertex.size()) +
                     " vertices are more than the " + std::to_string(limits.frames) + " frames or " +
                     std::to_string(limits.cache_bytes >> 20) + " MiB that are supported; lower --fps");

  PointCacheWriter writer(cache, {chosen.triangles, chosen.raw_vertex.size(), skeleton.parent, false}, false);
  std::vector<Vec3> all, positions;
  std::vector<Bone> bones;
  for (std::size_t frame = 0; frame < frames.count; ++frame) {
    const Moment moment = frames.moment(frame);
    skin(character, moment.pose, moment.weights, all);
    report.weld_spread = std::max(report.weld_spread, largest_spread(surface.group, all) / raw.diagonal);
    positions.clear();
    for (const std::int32_t v : chosen.raw_vertex) positions.push_back(all[static_cast<std::size_t>(v)]);
    bones_at(skeleton, moment.pose, bones);
    writer.append({positions, bones});
  }
  writer.finish();
  return report;
}

}  // namespace cscd::scenes
