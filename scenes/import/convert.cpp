#include "scenes/import/convert.h"

#include <algorithm>
#include <memory>
#include <numeric>

#include "core/base/error.h"
#include "scenes/character/pieces.h"
#include "scenes/character/pose.h"
#include "scenes/character/skeleton.h"
#include "scenes/character/source_map.h"
#include "scenes/character/weld.h"
#include "scenes/clip/point_cache.h"
#include "scenes/exchange/mesh_sequence.h"
#include "scenes/exchange/sequence_files.h"
#include "scenes/import/clip_frames.h"
#include "scenes/import/frame_rate.h"
#include "scenes/import/surface.h"
#include "scenes/motion/motion_file.h"

namespace cscd::scenes {
namespace {

// Above this many components the report does not count bones for each: debris can have many thousand pieces.
constexpr std::size_t kMostPiecesWithBones = 1000;

// Counts the bones that a clip moves relative to the bone above. The clip has a channel either for the bone
// itself or for one of the nodes between both bones, which are no bones.
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
  report.up = character.up;
  report.centimetres_per_unit = character.centimetres_per_unit;
  report.notes = character.notes;
  report.nodes = character.nodes.size();
  report.meshes = character.parts.size();
  const FrameRate rate = frame_rate(character, options.fps);
  report.fps = rate.fps;
  report.fps_from = rate.from;
  for (const Part& part : character.parts) {
    report.parts.push_back(
        {part.name, character.nodes[static_cast<std::size_t>(part.node)].name, part.mesh, part.primitive});
    report.vertices += part.positions.size();
    report.triangles += part.triangles.size();
    for (std::size_t v = 0; v < part.positions.size(); ++v)
      report.most_influences = std::max(report.most_influences, part.first[v + 1] - part.first[v]);
  }
  const std::vector<int> moving = moving_nodes(character);
  report.joints = moving.size();
  for (const Animation& animation : character.animations) {
    report.clips.push_back({animation.name, animation.start, animation.seconds, animation.ticks_per_second,
                            frames_of(animation.seconds, rate.fps),
                            driven_bones(character, animation, moving),
                            frame_number(animation.start, rate.fps)});
  }
}

// Returns for each raw vertex the node that moves it most.
std::vector<int> main_nodes(const Character& character) {
  std::vector<int> nodes;
  for (const Part& part : character.parts)
    for (std::size_t v = 0; v < part.positions.size(); ++v) {
      const auto first = part.influences.begin() + static_cast<std::ptrdiff_t>(part.first[v]);
      const auto last = part.influences.begin() + static_cast<std::ptrdiff_t>(part.first[v + 1]);
      const auto most = std::max_element(
          first, last, [](const Influence& a, const Influence& b) { return a.weight < b.weight; });
      nodes.push_back(most == last ? part.node : part.joints[static_cast<std::size_t>(most->joint)].node);
    }
  return nodes;
}

SourceMap source_map(const Character& character, const RawSurface& raw, const ChosenSurface& chosen,
                     const Skeleton& skeleton) {
  SourceMap map;
  for (std::size_t t = 0; t < chosen.triangles.size(); ++t) {
    SourceMap::Corners& corners = map.triangle.emplace_back();
    if (chosen.raw_triangle[t] == ChosenSurface::kFilled) continue;
    corners.part = raw.triangle_part[chosen.raw_triangle[t]];
    const std::int32_t first = raw.first_vertex[static_cast<std::size_t>(corners.part)];
    // A triangle that was turned round lists its corners in another order than its raw triangle.
    for (std::size_t k = 0; k < 3; ++k)
      for (const std::int32_t corner : raw.triangles[chosen.raw_triangle[t]])
        if (chosen.weld_group[static_cast<std::size_t>(corner)] == chosen.raw_vertex[+chosen.triangles[t][k]])
          corners.vertex[k] = corner - first;
  }
  const std::vector<int> main = main_nodes(character);
  for (const std::int32_t v : chosen.raw_vertex) {
    const auto bone =
        std::lower_bound(skeleton.node.begin(), skeleton.node.end(), main[static_cast<std::size_t>(v)]);
    const bool found = bone != skeleton.node.end() && *bone == main[static_cast<std::size_t>(v)];
    map.bone.push_back(found ? static_cast<std::int32_t>(bone - skeleton.node.begin()) : -1);
  }
  return map;
}

std::vector<Vec3> of_surface(const ChosenSurface& chosen, std::span<const Vec3> raw_positions) {
  std::vector<Vec3> positions;
  positions.reserve(chosen.raw_vertex.size());
  for (const std::int32_t v : chosen.raw_vertex)
    positions.push_back(raw_positions[static_cast<std::size_t>(v)]);
  return positions;
}

void require_room(std::size_t frames, std::size_t vertices, std::size_t bones,
                  const CharacterLimits& limits) {
  const std::size_t bytes = frames * (vertices + 2 * bones) * sizeof(Vec3);
  if (frames > limits.frames || bytes > limits.cache_bytes)
    throw InputError(std::to_string(frames) + " frames of " + std::to_string(vertices) +
                     " vertices are more than the " + std::to_string(limits.frames) + " frames or " +
                     std::to_string(limits.cache_bytes >> 20) + " MiB that are supported; lower --fps");
}

void write_motion_of(const Character& character, const ChosenSurface& chosen, const ImportReport& report,
                     const ImportOptions& options) {
  if (report.lead_in > 0 || report.chosen_clip < 0)
    throw InputError(
        "--true-motion: the way from the bind pose is no motion of the file; leave out one of "
        "--from-bind-pose and --true-motion");
  MovingCharacter moving{character, chosen.raw_vertex};
  moving.character.animations = {character.animations[static_cast<std::size_t>(report.chosen_clip)]};
  write_motion(moving, options.motion);
}

void require_simple(const ImportOptions& options) {
  if (!options.motion.empty())
    throw InputError(
        "--true-motion: is a moving surface without bones, of whose motion between frames nothing is "
        "known but straight lines; leave it out");
  ImportOptions plain;
  plain.fps = options.fps;
  plain.survey = options.survey;
  plain.one_pose = options.one_pose;
  plain.clip_number = options.clip_number;  // of a survey's only clip
  if (options != plain)
    throw InputError(
        "is a moving surface without clips and bones, which is taken as it is; leave out all options of "
        "model files but --fps");
}

// The triangles with three corners, each set of corners once. Of two triangles with the same corners each
// edge has a third neighbour, at which no side of the surface is inside, so that no depth would be known. All
// vertices stay: those of no face are points.
struct Surface {
  WeldedTriangles faces;
  SourceMap sources;
};

Surface surface_of(const MeshSequence& sequence) {
  Surface surface;
  const auto all = sequence.triangles();
  std::vector<std::int32_t> number(sequence.vertex_count());
  std::iota(number.begin(), number.end(), 0);
  surface.faces = welded(all, number);
  if (surface.faces.triangles.empty())
    throw InputError("has no triangle with three corners; export it again");
  for (const std::size_t source : surface.faces.source) surface.sources.triangle.push_back({0, all[source]});
  surface.sources.bone.assign(number.size(), -1);
  return surface;
}

}  // namespace

ImportReport convert(Character character, const ImportOptions& options, const CharacterLimits& limits,
                     const std::filesystem::path& cache, const std::filesystem::path& sources) {
  ImportReport report;
  describe(character, options, report);
  put_keys_on_frames(character, report.fps);
  const RawSurface raw = raw_surface(character);
  const ChosenSurface chosen = choose_surface(character, raw, options, report);
  std::vector<bool> used(raw.positions.size(), false);
  for (const std::int32_t v : chosen.raw_vertex) used[static_cast<std::size_t>(v)] = true;
  const Frames frames = plan_frames(character, raw.bound, used, raw.diagonal, options, report);

  const Skeleton skeleton = make_skeleton(character, raw.bound, raw.positions, used);
  for (const int node : skeleton.node)
    report.bones.push_back(character.nodes[static_cast<std::size_t>(node)].name);
  if (options.survey && chosen.pieces.size() <= kMostPiecesWithBones)
    for (const Piece& piece : chosen.pieces) {
      std::vector<bool> own(raw.positions.size(), false);
      for (const VertexId v : piece.vertices) own[+v] = true;
      report.component_bones.push_back(make_skeleton(character, raw.bound, raw.positions, own).node.size());
    }
  write_source_map(source_map(character, raw, chosen, skeleton), sources);

  if (!options.motion.empty() && !options.survey) write_motion_of(character, chosen, report, options);

  require_room(frames.count, chosen.raw_vertex.size(), skeleton.node.size(), limits);
  PointCacheWriter writer(
      cache,
      {chosen.triangles, chosen.raw_vertex.size(), skeleton.parent, false, of_surface(chosen, raw.positions)},
      false);
  std::vector<Vec3> all;
  std::vector<Bone> bones;
  for (std::size_t frame = 0; frame < frames.count; ++frame) {
    const Moment moment = frames.moment(frame);
    skin(character, moment.pose, moment.weights, all);
    report.weld_spread = std::max(report.weld_spread, largest_spread(chosen.weld_group, all) / raw.diagonal);
    bones_at(skeleton, moment.pose, bones);
    writer.append({of_surface(chosen, all), bones});
  }
  writer.finish();
  return report;
}

ImportReport import_sequence(const std::filesystem::path& model, const ImportOptions& options,
                             const CharacterLimits& limits, const std::filesystem::path& cache,
                             const std::filesystem::path& sources) {
  require_simple(options);
  const std::filesystem::path file = sequence_file(model);
  const std::unique_ptr<MeshSequence> sequence = open_mesh_sequence(file);
  const std::size_t frames = sequence->frame_count();
  if (frames < 2 && !options.one_pose)
    throw InputError(
        "is one pose, and nothing moves; name one file of a sequence, as in walk.0001.obj, whose other "
        "frames lie beside it");
  const Surface surface = surface_of(*sequence);
  const std::size_t vertices = sequence->vertex_count();
  const TriangleMesh mesh(surface.faces.triangles, vertices);
  if (frames > limits.frames || frames * vertices * sizeof(Vec3) > limits.cache_bytes)
    throw InputError("its " + std::to_string(frames) + " frames of " + std::to_string(vertices) +
                     " vertices are more than the " + std::to_string(limits.frames) + " frames or " +
                     std::to_string(limits.cache_bytes >> 20) + " MiB that are supported; leave frames out");

  ImportReport report;
  report.format = sequence->format();
  report.meshes = report.nodes = 1;
  report.vertices = vertices;
  report.triangles = sequence->triangles().size();
  report.fps = options.fps ? *options.fps : sequence->fps().value_or(kAssumedFps);
  report.fps_from = options.fps ? kAsked : sequence->fps() ? kStated : kAssumed;
  report.clips.push_back(
      {"", 0, static_cast<double>(frames - 1) / report.fps, 0, frames, 0, sequence->first_frame()});
  report.parts.push_back({file.stem().string(), "the surface", -1, -1});
  report.chosen_clip = options.survey ? -1 : 0;
  report.collapsed_triangles = surface.faces.collapsed;
  report.duplicate_triangles = surface.faces.duplicate;
  report.components = static_cast<std::size_t>(mesh.component_count());
  for (std::size_t c = 0; c < report.components; ++c) report.chosen_components.push_back(c);
  if (options.survey) report.component_bones.assign(report.components, 0);
  report.chosen_triangles = surface.faces.triangles.size();
  write_source_map(surface.sources, sources);

  PointCacheWriter writer(cache, {surface.faces.triangles, vertices, {}, false}, false);
  std::vector<Vec3> positions;
  for (std::size_t frame = 0; frame < (options.survey ? 2 : std::max<std::size_t>(2, frames)); ++frame) {
    // A cache of one pose has two frames, too.
    sequence->read_frame(std::min(frame, frames - 1), positions);
    writer.append({positions, {}});
  }
  writer.finish();
  report.notes = sequence->notes();
  std::size_t points = 0;
  for (std::size_t v = 0; v < vertices; ++v)
    points += mesh.triangles_at(VertexId{static_cast<std::int32_t>(v)}).empty();
  if (points > 0) report.notes.push_back(note_on_points(points));
  return report;
}

}  // namespace cscd::scenes
