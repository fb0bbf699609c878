#include "bench/query/export_files.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <vector>

#include "bench/answer/answer_text.h"
#include "bench/output/output.h"
#include "bench/query/view/strategy_observers.h"
#include "core/base/error.h"
#include "core/detect/contact_geometry.h"
#include "core/detect/start/crossings.h"
#include "scenes/base/output_target.h"
#include "scenes/clip/clip_part.h"
#include "scenes/clip/point_cache.h"
#include "scenes/exchange/mesh_cache.h"
#include "scenes/exchange/surface_file.h"
#include "scenes/exchange/usd_file.h"
#include "scenes/exchange/vtk_file.h"
#include "scenes/export/glb.h"
#include "scenes/export/skinned_scene.h"

namespace cscd::bench {
namespace {

namespace fs = std::filesystem;

// The number of a frame in the files. In the clip, it is the number by which answers name the frame; a number
// nearly whole is taken for whole, because models hold times in single precision. The lead-in counts down
// from the clip, because the frames of a file follow one another.
double file_number(const Input& input, std::size_t frame) {
  const std::size_t lead_in = input.import ? input.import->lead_in : 0;
  const double number = frame_number(input, std::max(frame, lead_in)), whole = std::round(number);
  const double before = frame < lead_in ? static_cast<double>(lead_in - frame) : 0;
  return (std::abs(number - whole) < 1e-3 ? whole : number) - before;
}

std::size_t count(const IntervalRange& range) {
  return range.last - range.first + 1;  // of frames
}

// Says that files count their frames from 0 where the first of them has another number.
void note_renumbered(const Input& input, const IntervalRange& range) {
  if (const double first = file_number(input, range.first); first != 0)
    std::printf("note: the first frame of %s has the number %.6g, and the files count from 0\n",
                input.name.c_str(), first);
}

// The number in the name of the first file of a sequence, below 0 where that of the frame is.
std::int64_t first_in_names(const Input& input, const IntervalRange& range) {
  const double first = file_number(input, range.first);
  if (first == std::floor(first)) return static_cast<std::int64_t>(first);
  note_renumbered(input, range);
  return 0;
}

// Files that are opened together before the work, so that none appears if one cannot.
class Files {
 public:
  explicit Files(bool force) : force_(force) {}
  std::size_t add(const fs::path& path) {
    paths_.push_back(path);
    targets_.push_back(file_target(path, force_));
    return paths_.size() - 1;
  }
  // Adds a file for each frame: NAME.0012.obj for frame 12 of NAME.obj, and NAME.-0012.obj for frame -12.
  // Numbers have as many digits as the longest needs, at least four.
  void add_sequence(const fs::path& output, std::int64_t first, std::size_t frames,
                    const std::string& extension) {
    const std::int64_t end = first + static_cast<std::int64_t>(frames);
    const std::size_t digits =
        std::max({std::size_t{4}, std::to_string(end - 1).size(), std::to_string(std::abs(first)).size()});
    for (std::int64_t f = first; f < end; ++f) {
      std::string number = std::to_string(std::abs(f));
      number.insert(0, digits - number.size(), '0');
      if (f < 0) number.insert(0, 1, '-');
      add(output.parent_path() / (output.stem().string() + "." + number + extension));
    }
  }
  void write(std::size_t file, std::string_view content) {
    UnfinishedFile out(targets_[file], force_);
    out.write(content);
    out.finish();
  }
  std::string name(std::size_t file) const { return paths_[file].filename().string(); }
  std::size_t count() const { return paths_.size(); }

 private:
  bool force_;
  std::vector<fs::path> paths_, targets_;  // as they were named, and behind all links
};

double fps_of(const Input& input) {
  return input.import ? input.import->fps : scenes::kExportedFps;
}

// Where a file does not say how long its unit is, a metre is assumed, as glTF has it.
double metres_per_unit(const Input& input) {
  const double centimetres = input.import ? input.import->centimetres_per_unit : 0;
  return centimetres > 0 ? centimetres / 100 : 1;
}

void export_sequence(const Input& input, const IntervalRange& range, const fs::path& output,
                     const std::string& format, bool force) {
  const std::size_t frames = count(range);
  Files files(force);
  files.add_sequence(output, first_in_names(input, range), frames, format);
  for (std::size_t f = 0; f < frames; ++f) {
    const std::span<const Vec3> positions = input.clip->load_frame(range.first + f).positions;
    files.write(f, format == ".obj" ? scenes::to_obj(positions, input.mesh.triangles())
                                    : scenes::to_ply(positions, input.mesh.triangles()));
  }
  std::printf("%s to %s", files.name(0).c_str(), files.name(frames - 1).c_str());
}

void export_mesh_cache(const Input& input, const IntervalRange& range, const fs::path& output,
                       const std::string& format, bool force) {
  const auto kind = format == ".pc2" ? scenes::MeshCacheFormat::pc2 : scenes::MeshCacheFormat::mdd;
  Files files(force);
  const std::size_t cache = files.add(output), faces = files.add(fs::path(output).replace_extension(".obj"));
  std::string bytes = scenes::mesh_cache_head(kind, input.mesh.vertex_count(), count(range), fps_of(input),
                                              file_number(input, range.first));
  for (std::size_t f = range.first; f <= range.last; ++f)
    bytes += scenes::mesh_cache_frame(kind, input.clip->load_frame(f).positions);
  files.write(faces, scenes::to_obj(input.reference, input.mesh.triangles()));
  files.write(cache, bytes);
  std::printf("%s, faces in %s", output.string().c_str(), files.name(faces).c_str());
}

void export_point_cache(const Input& input, const IntervalRange& range, const fs::path& output, bool force) {
  note_renumbered(input, range);
  scenes::ClipHeader header = input.clip->header();
  if (!input.up.because.empty()) header.up = input.up.axis;
  if (range.first > 0) header.rest.assign(input.rest().begin(), input.rest().end());
  scenes::PointCacheWriter writer(output, std::move(header), force);
  scenes::ClipPart part(*input.clip, range.first, range.last);
  scenes::copy_frames(part, writer);
  writer.finish();
  std::printf("%s", output.string().c_str());
}

void export_baked(const Input& input, const IntervalRange& range, const fs::path& output, bool force) {
  const double first = file_number(input, range.first);
  if (first < 0) note_renumbered(input, range);  // glTF has no time before 0
  OutputFile file(output, force, ".glb");
  scenes::ClipPart part(*input.clip, range.first, range.last);
  file.commit(scenes::baked_glb(part, output.stem().string(), fps_of(input), std::max(first, 0.0),
                                input.up.axis, metres_per_unit(input)));
  std::printf("%s", output.string().c_str());
}

void print_counts(const Input& input, const IntervalRange& range) {
  std::printf(": %zu frames of %zu vertices and %zu triangles\n", count(range), input.mesh.vertex_count(),
              input.mesh.triangle_count());
}

// What is known of a pose and of the interval that starts there. [triangles] each, [contacts], and [curves].
struct PoseMarks {
  std::vector<float> touches, close, crosses;  // close: within the thickness, and does not touch
  std::vector<float> depth;  // [vertices], in another piece of the surface at the start; 0 in none
  std::vector<std::vector<Vec3>> curves;  // of events; the first point of a closed one comes last, too
  std::vector<float> event;
  // Empty without observers. The clusters are those of the covers of drvbc_fast; -1 where there is none.
  std::vector<float> cluster, positive, second_cover, third_cover, patch;
  std::vector<Vec3> points;
  std::vector<float> time, kind, normal;  // kind: 0 vertex and face, 1 two edges
};

// White where nothing is deep, and from yellow to red up to the deepest vertex of the clip.
scenes::Rgb colour_of_depth(float depth, float deepest) {
  if (depth <= 0) return {255, 255, 255};
  return {230, static_cast<std::uint8_t>(200.0F - 200.0F * std::min(depth / deepest, 1.0F)), 20};
}

// Makes marks of the first strategy's answers.
class Marker {
 public:
  explicit Marker(const ClipAnswerer& asked)
      : input_(asked.input()),
        observers_(input_, asked.answers().front().strategy, asked.answers().front().elementary) {}

  PoseMarks mark(const AnsweredPose& pose) {
    PoseMarks marks;
    for (std::vector<float>* of_triangles : {&marks.touches, &marks.close, &marks.crosses})
      of_triangles->resize(input_.mesh.triangle_count());
    for (const CrossingPair& pair : pose.crossing.pairs) mark_both(pair, marks.crosses);
    add_overlaps(pose.here, pose.interval.motion.start(), marks);
    if (pose.is_last()) return marks;
    add_contacts(pose.answers.front(), pose.interval.motion, marks);
    add_clusters(pose.interval, marks);
    return marks;
  }

 private:
  static void mark_both(const CrossingPair& pair, std::vector<float>& marks) {
    marks[+pair.first] = marks[+pair.second] = 1;
  }

  void add_contacts(const IntervalAnswer& answer, const Motion& motion, PoseMarks& marks) const {
    const bool is_thick = input_.thickness.length > 0;
    if (answer.motion && answer.motion->verdict == IntervalVerdict::touches)
      mark_both(*answer.motion->pair, marks.touches);
    for (const Contact& contact : answer.found.contacts) {
      if (contact.verdict != Verdict::contact) continue;
      const bool touches = !is_thick || answer.touching.contains(contact.pair);
      for (const CrossingPair& pair : carriers(input_.mesh, contact.pair))
        mark_both(pair, touches ? marks.touches : marks.close);
      const ContactGeometry geometry = contact_geometry(input_.mesh, motion, contact.pair, contact.time);
      marks.points.push_back(geometry.point);
      marks.time.push_back(static_cast<float>(contact.time));
      marks.kind.push_back(contact.pair.kind == FeaturePair::Kind::vertex_face ? 0 : 1);
      const Vec3 normal = geometry.normal.value_or(Vec3::Zero());
      for (int axis = 0; axis < 3; ++axis) marks.normal.push_back(static_cast<float>(normal[axis]));
    }
  }

  void add_clusters(const scenes::ClipInterval& interval, PoseMarks& marks) {
    observers_.look(interval);
    const RadialView view = observers_.view();
    marks.cluster.assign(view.cluster.begin(), view.cluster.end());
    marks.positive.assign(view.positive.begin(), view.positive.end());
    marks.patch.assign(view.patch.begin(), view.patch.end());
    std::vector<float>* const covers[] = {&marks.second_cover, &marks.third_cover};
    for (std::size_t c = 0; c < std::size(covers); ++c)
      if (c < view.further_covers.size())
        covers[c]->assign(view.further_covers[c].cluster.begin(), view.further_covers[c].cluster.end());
      else
        covers[c]->assign(input_.mesh.triangle_count(), -1.0F);
  }

  void add_overlaps(const OverlapEvents::Here& here, std::span<const Vec3> start, PoseMarks& marks) const {
    marks.depth.resize(input_.mesh.vertex_count());
    for (std::size_t i = 0; i < here.event.size(); ++i) {
      if (here.event[i] == OverlapEvents::kNone) continue;
      const Overlap& overlap = here.overlaps.overlaps[i];
      for (const CrossingRegion& region : overlap.regions)
        for (std::size_t k = 0; k < region.vertices.size(); ++k) {
          float& depth = marks.depth[+region.vertices[k]];
          depth = std::max(depth, static_cast<float>(region.way[k].norm()));
        }
      for (const std::int32_t c : overlap.curves) {
        const CrossingCurve& curve = here.overlaps.crossing.curves[static_cast<std::size_t>(c)];
        std::vector<Vec3>& points = marks.curves.emplace_back();
        for (const CrossingCurve::Node& node : curve.nodes)
          points.push_back(here.overlaps.crossing.point(node, start));
        if (curve.closed()) points.push_back(points.front());
        marks.event.push_back(static_cast<float>(here.event[i]));
      }
    }
  }

  const Input& input_;
  StrategyObservers observers_;
};

// A surface with depths for each frame, and NAME.curves.0000.obj beside it with the curves.
void export_events(ClipAnswerer& asked, const fs::path& output, bool force) {
  const Input& input = asked.input();
  const IntervalRange& range = asked.range();
  const std::size_t frames = count(range);
  Files files(force);
  const std::int64_t first = first_in_names(input, range);
  files.add_sequence(output, first, frames, ".ply");
  const fs::path curves = output.parent_path() / (output.stem().string() + ".curves.obj");
  files.add_sequence(curves, first, frames, ".obj");

  Marker marker(asked);
  std::vector<std::map<std::size_t, float>> deep(frames);  // few vertices lie inside another piece
  float deepest = 0;
  asked.answer_all("export " + output.string(), true, [&](const AnsweredPose& pose) {
    const PoseMarks marks = marker.mark(pose);
    const std::size_t f = pose.frame - range.first;
    for (std::size_t v = 0; v < marks.depth.size(); ++v)
      if (marks.depth[v] > 0) deepest = std::max(deepest, deep[f][v] = marks.depth[v]);
    const std::vector<std::size_t> events(marks.event.begin(), marks.event.end());
    files.write(frames + f, scenes::curves_to_obj(marks.curves, events));
  });
  // One scale of colours for all frames, so their deepest vertex has to be known before the first is written.
  for (std::size_t f = 0; f < frames; ++f) {
    const std::span<const Vec3> positions = input.clip->load_frame(range.first + f).positions;
    std::vector<float> depth(positions.size());
    for (const auto& [vertex, value] : deep[f]) depth[vertex] = value;
    std::vector<scenes::Rgb> colours;
    for (const float value : depth) colours.push_back(colour_of_depth(value, deepest));
    files.write(f, scenes::to_ply(positions, input.mesh.triangles(), depth, colours));
  }
  std::printf("%s to %s with depths, curves in %s to %s", files.name(0).c_str(),
              files.name(frames - 1).c_str(), files.name(frames).c_str(), files.name(2 * frames - 1).c_str());
}

void export_paraview(ClipAnswerer& asked, const fs::path& output, bool force) {
  const Input& input = asked.input();
  const IntervalRange& range = asked.range();
  const std::size_t frames = count(range);
  Files files(force);
  const std::size_t list = files.add(output);
  const std::int64_t first = first_in_names(input, range);
  files.add_sequence(output, first, frames, ".vtp");
  const fs::path contacts = output.parent_path() / (output.stem().string() + ".contacts.pvd");
  files.add_sequence(contacts, first, frames, ".vtp");
  const fs::path curves = output.parent_path() / (output.stem().string() + ".curves.pvd");
  files.add_sequence(curves, first, frames, ".vtp");

  Marker marker(asked);
  std::vector<scenes::VtkMoment> moments;
  asked.answer_all("export " + output.string(), true, [&](const AnsweredPose& pose) {
    const PoseMarks marks = marker.mark(pose);
    const std::size_t f = pose.frame - range.first;
    scenes::VtkSurface surface(pose.interval.motion.start(), input.mesh.triangles());
    // The last frame begins no interval; every file of a series has the same arrays all the same.
    const std::vector<float> zeros(input.mesh.triangle_count(), 0.0F);
    const auto cells = [&](const char* name, const std::vector<float>& values) {
      surface.add(name, values.empty() ? zeros : values);
    };
    cells("touches", marks.touches);
    if (input.thickness.length > 0) cells("close", marks.close);
    cells("crosses_at_start", marks.crosses);
    cells("cluster", marks.cluster);
    cells("positive", marks.positive);
    cells("second_cover", marks.second_cover);
    cells("third_cover", marks.third_cover);
    cells("patch", marks.patch);
    surface.add_to_points("depth", marks.depth);
    scenes::VtkSurface lines(marks.curves);
    lines.add("event", marks.event);
    scenes::VtkSurface points(marks.points, {});
    points.add("time_in_interval", marks.time);
    points.add("two_edges", marks.kind);
    points.add("normal", marks.normal, 3);
    files.write(1 + f, surface.text());
    files.write(1 + frames + f, points.text());
    files.write(1 + 2 * frames + f, lines.text());
    const double time = file_number(input, pose.frame) / fps_of(input);
    moments.push_back({time, 0, files.name(1 + f)});
    moments.push_back({time, 1, files.name(1 + frames + f)});
    moments.push_back({time, 2, files.name(1 + 2 * frames + f)});
  });
  files.write(list, scenes::to_pvd(moments));
  std::printf("%s, which lists %zu .vtp files", output.string().c_str(), files.count() - 1);
}

void export_usd(ClipAnswerer& asked, const fs::path& output, bool force) {
  const Input& input = asked.input();
  OutputFile file(output, force, ".usda");
  constexpr scenes::UsdSurface::Colour kPalette[] = {
      {0.79F, 0.83F, 0.86F}, {0.94F, 0.89F, 0.26F}, {0.90F, 0.62F, 0.0F}, {0.84F, 0.37F, 0.0F}};
  Marker marker(asked);
  scenes::UsdSurface surface(input.mesh.triangles(), {fps_of(input), input.up.axis, metres_per_unit(input)});
  Vec3 low = input.reference[0], high = low;
  for (const Vec3& x : input.reference) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  asked.answer_all("export " + output.string(), true, [&](const AnsweredPose& pose) {
    const PoseMarks marks = marker.mark(pose);
    std::vector<std::uint8_t> colour;  // clear, close, touches, crosses
    for (std::size_t t = 0; t < marks.touches.size(); ++t)
      colour.push_back(marks.crosses[t] > 0 ? 3 : marks.touches[t] > 0 ? 2 : marks.close[t] > 0 ? 1 : 0);
    surface.append(file_number(input, pose.frame), pose.interval.motion.start(), colour, kPalette,
                   marks.depth, marks.points, marks.curves);
  });
  file.commit(surface.text(0.004 * (high - low).norm()));
  std::printf("%s", output.string().c_str());
}

}  // namespace

fs::path file_target(const fs::path& output, bool force) {
  const OutputTarget target = find_output_target(output, force);
  if (target.is_stream)
    throw InputError("output " + output.string() +
                     ": is a device or a pipe, and this format needs an ordinary file; choose one");
  return target.path;
}

void export_frames(const Input& input, const IntervalRange& range, const fs::path& output,
                   const std::string& format, bool force) {
  if (format == ".h5" || format == ".hdf5")
    export_point_cache(input, range, output, force);
  else if (format == ".obj" || format == ".ply")
    export_sequence(input, range, output, format, force);
  else if (format == ".pc2" || format == ".mdd")
    export_mesh_cache(input, range, output, format, force);
  else
    export_baked(input, range, output, force);
  print_counts(input, range);
}

void export_answers(ClipAnswerer& asked, const fs::path& output, const std::string& format, bool force) {
  if (format == ".ply")
    export_events(asked, output, force);
  else if (format == ".pvd")
    export_paraview(asked, output, force);
  else
    export_usd(asked, output, force);
  print_counts(asked.input(), asked.range());
  std::printf("%s\n", verdict_text(asked.answers().front()).c_str());
}

}  // namespace cscd::bench
