#include "scenes/import/sequence_import.h"

#include <algorithm>
#include <memory>

#include "core/base/error.h"
#include "scenes/character/source_map.h"
#include "scenes/clip/point_cache.h"
#include "scenes/exchange/mesh_sequence.h"
#include "scenes/import/frame_rate.h"

namespace cscd::scenes {
namespace {

void require_simple(const ImportOptions& options) {
  ImportOptions plain;
  plain.fps = options.fps;
  plain.survey = options.survey;
  plain.clip_number = options.clip_number;  // of a survey's only clip
  if (options != plain)
    throw InputError(
        "is a moving surface without clips and bones, which is taken as it is; leave out all options of "
        "model "
        "files but --fps");
}

// The triangles with three corners, and the vertices that they have, in the order of the file.
struct Surface {
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> vertex;  // [vertices]: number in the file
  SourceMap sources;
  std::size_t collapsed = 0;
};

Surface surface_of(const MeshSequence& sequence) {
  Surface surface;
  std::vector<std::int32_t> number(sequence.vertex_count(), -1);
  for (const auto& corners : sequence.triangles())
    for (const std::int32_t v : corners) number[static_cast<std::size_t>(v)] = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<std::int32_t>(surface.vertex.size());
    surface.vertex.push_back(static_cast<std::int32_t>(v));
  }
  for (const auto& corners : sequence.triangles()) {
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
      ++surface.collapsed;
      continue;
    }
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = VertexId{number[static_cast<std::size_t>(corners[k])]};
    surface.triangles.push_back(triangle);
    surface.sources.triangle.push_back({0, corners});
  }
  if (surface.triangles.empty()) throw InputError("has no triangle with three corners; export it again");
  surface.sources.bone.assign(surface.vertex.size(), -1);
  return surface;
}

}  // namespace

ImportReport import_sequence(const std::filesystem::path& model, const ImportOptions& options,
                             const CharacterLimits& limits, const std::filesystem::path& cache,
                             const std::filesystem::path& sources) {
  require_simple(options);
  const std::unique_ptr<MeshSequence> sequence = open_mesh_sequence(model);
  const std::size_t frames = sequence->frame_count();
  if (frames < 2) throw InputError("holds one frame, and nothing moves; export more");
  const Surface surface = surface_of(*sequence);
  const TriangleMesh mesh(surface.triangles, surface.vertex.size());
  if (frames > limits.frames || frames * surface.vertex.size() * sizeof(Vec3) > limits.cache_bytes)
    throw InputError("its " + std::to_string(frames) + " frames of " + std::to_string(surface.vertex.size()) +
                     " vertices are more than the " + std::to_string(limits.frames) + " frames or " +
                     std::to_string(limits.cache_bytes >> 20) + " MiB that are supported; leave frames out");

  ImportReport report;
  report.format = sequence->format();
  report.meshes = report.nodes = 1;
  report.vertices = sequence->vertex_count();
  report.triangles = sequence->triangles().size();
  report.fps = options.fps.value_or(kAssumedFps);
  report.fps_from = options.fps ? kAsked : kAssumed;
  report.clips.push_back({"", 0, static_cast<double>(frames - 1) / report.fps, 0, frames, 0});
  report.parts.push_back({model.stem().string(), "the surface", -1, -1});
  report.chosen_clip = options.survey ? -1 : 0;
  report.collapsed_triangles = surface.collapsed;
  report.components = static_cast<std::size_t>(mesh.component_count());
  for (std::size_t c = 0; c < report.components; ++c) report.chosen_components.push_back(c);
  if (options.survey) report.component_bones.assign(report.components, 0);
  report.chosen_triangles = surface.triangles.size();
  write_source_map(surface.sources, sources);

  PointCacheWriter writer(cache, {surface.triangles, surface.vertex.size(), {}, false}, false);
  std::vector<Vec3> all, used(surface.vertex.size());
  for (std::size_t frame = 0; frame < (options.survey ? 2 : frames); ++frame) {
    sequence->read_frame(frame, all);
    for (std::size_t v = 0; v < used.size(); ++v) used[v] = all[static_cast<std::size_t>(surface.vertex[v])];
    writer.append({used, {}});
  }
  writer.finish();
  return report;
}

}  // namespace cscd::scenes
