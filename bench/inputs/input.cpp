#include "bench/inputs/input.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>

#include "bench/inputs/own_output.h"
#include "bench/output/progress.h"
#include "bench/strategies/catalogue.h"
#include "bench/strategies/strategy_row.h"
#include "core/base/error.h"
#include "core/base/memory.h"
#include "core/base/number_text.h"
#include "scenes/catalog/scene_cache.h"
#include "scenes/clip/point_cache.h"
#include "scenes/sandbox/run_limited.h"

namespace cscd::bench {
namespace {

std::unique_ptr<scenes::ClipSource> clip_of(const scenes::Scene& scene, const std::string& name) {
  if (!scene.expected.digest)
    std::fprintf(stderr,
                 "note: %s promises no digest, so its frames may be any; cscd scene accept FILE writes it\n",
                 name.c_str());
  return scenes::open_scene(scene, progress_of("generating " + name));
}

// Frames whose numbers differ by less are one: numbers are seconds times a rate.
constexpr double kSameFrame = 1e-3;

// Numbers of frames are sums of rounded seconds: what is a whole number but for that is shown as one.
std::string shown(double value) {
  if (const double whole = std::round(value); std::abs(value - whole) < kSameFrame && std::abs(value) < 1e15)
    return std::to_string(static_cast<std::int64_t>(whole));
  return exact_text(value);
}

double parse_frame(std::string_view digits, double otherwise, const std::string& whole) {
  if (digits.empty()) return otherwise;
  double frame = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), frame);
  if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(frame))
    throw InputError("--frames " + whole + ": '" + std::string(digits) +
                     "' is not a frame number; write A:B, as in 0:10");
  return frame;
}

// What a scene, a model file or a point cache says. A scene in which things fall says it by its gravity,
// unless its file has a member `up`.
Up up_of(const scenes::Scene& scene) {
  if (!scene.up.empty()) return {scene.up, "the scene file says so"};
  for (const scenes::EffectCall& effect : scene.effects) {
    if (!effect.parameters.has("gravity")) continue;
    const Vec3 gravity = effect.parameters.vector("gravity");
    int axis = 0;
    if (gravity.cwiseAbs().maxCoeff(&axis) == 0) continue;
    return {std::string(gravity[axis] < 0 ? "" : "-") + "xyz"[axis], "things fall the other way"};
  }
  return {};
}

Up up_of(const scenes::ImportReport& report) {
  if (report.up.empty()) return {};
  if (report.format == "glTF 2") return {report.up, "glTF files have it so"};
  return {report.up, report.format == "Collada" ? "Collada files are turned so" : "the file says so"};
}

Up up_of(const scenes::ClipHeader& header) {
  if (header.up.empty()) return {};
  return {header.up, "the file says so"};
}

// Whether all frames are the first one. Of a clip that moves, the second frame mostly tells.
bool is_still(scenes::ClipSource& clip, const std::vector<Vec3>& reference) {
  for (std::size_t frame = 1; frame < clip.frame_count(); ++frame)
    if (!std::ranges::equal(clip.load_frame(frame).positions, reference)) return false;
  return true;
}

}  // namespace

bool is_point_cache(const std::filesystem::path& path) {
  return path.extension() == ".h5" || path.extension() == ".hdf5";
}

std::string short_name(const std::string& name) {
  std::filesystem::path path = std::filesystem::path(name).lexically_normal();
  std::error_code ignored;
  if (path == "." || path == ".." || path == "../" || path == "./")
    path = std::filesystem::absolute(path, ignored).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

bool is_model_file(const std::string& name) {
  const std::filesystem::path path(name);
  if (is_point_cache(path) || scenes::is_scene_file(path)) return false;
  if (path.has_extension()) return true;
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  // A folder is an input, too, but one that is called like a scene, as a folder `man` of manual pages is,
  // does not hide that scene: ./man names the folder.
  if (!std::filesystem::is_directory(status)) return std::filesystem::exists(status);
  return std::ranges::count(scenes::all_scene_names(), name) == 0;
}

Input open_input(const std::string& name, const ModelOptions& options) {
  if (const std::string why = why_own_output(name); !why.empty()) throw InputError(name + ": " + why);
  const bool model = is_model_file(name);
  if (!model && options.true_motion)
    throw InputError(
        "input " + name +
        ": --true-motion: between the frames of a scene or a point cache nothing is known but straight "
        "lines; give a model file (cscd export writes a scene as one)");
  if (!model && options != ModelOptions{})
    throw InputError("input " + name +
                     ": is no model file, so its frames are used as they are; leave out the options of model "
                     "files (--clip, --fps, ...)");
  std::unique_ptr<scenes::ClipSource> clip;
  std::optional<scenes::ImportReport> import;
  std::optional<scenes::SourceMap> sources;
  std::vector<std::string> bone_names, cloth_names;
  std::shared_ptr<const VertexPaths> motion;
  Up up;
  if (model) {
    ImportedModel imported = import_model(name, options);
    scenes::limit_memory(options.answer_memory_mib << 20);
    clip = std::move(imported.clip);
    import = std::move(imported.report);
    bone_names = import->bones;
    up = up_of(*import);
    sources = std::move(imported.sources);
    motion = std::move(imported.motion);
  } else if (is_point_cache(name)) {
    clip = std::make_unique<scenes::PointCacheReader>(name);
    up = up_of(clip->header());
  } else {
    scenes::Scene scene;
    name_input(name, [&] { scene = scenes::load_scene(name); });
    clip = clip_of(scene, name);
    bone_names = scenes::bone_names(scene);
    cloth_names = scenes::cloth_names(scene);
    up = up_of(scene);
  }
  const scenes::ClipHeader& header = clip->header();
  TriangleMesh mesh(header.triangles, header.vertex_count, name);
  const scenes::FrameView first = clip->load_frame(0);
  std::optional<Rig> rig = scenes::rig_of(header, first);
  std::vector<Vec3> reference(first.positions.begin(), first.positions.end());
  Input input{name,           std::move(clip),   std::move(mesh),   std::move(reference),
              std::move(rig), std::move(import), std::move(sources)};
  input.bone_names = std::move(bone_names);
  input.cloth_names = std::move(cloth_names);
  input.motion = std::move(motion);
  const bool named = !options.import.clip.empty() || options.import.clip_number;
  input.clip_was_named = named || options.import.survey || !input.import || input.import->clips.size() < 2;
  if (input.import && !options.import.survey && input.import->lead_in == 0) {
    const long chosen = input.import->chosen_clip;
    input.is_one_pose = chosen < 0 || input.import->clips[static_cast<std::size_t>(chosen)].frames < 2;
  }
  // What bones carry may move between the frames, and predicted steps without the frames.
  const bool is_frames_alone = input.clip->header().bone_parent.empty() && !input.clip->header().predicted;
  if (is_frames_alone && !options.import.survey && !input.is_one_pose) {
    input.is_one_pose = is_still(*input.clip, input.reference);
    if (input.is_one_pose && input.import)
      input.import->notes.push_back("its " + std::to_string(input.clip->frame_count()) +
                                    " frames are all alike: one pose");
  }
  input.up = std::move(up);
  return input;
}

void name_input(const std::string& name, const std::function<void()>& work) {
  try {
    work();
  } catch (const MemoryShortage& shortage) {
    throw InputError(name + ": " + std::string(shortage.finding()) +
                     "; give a smaller --thickness or a smaller input");
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (what.find(name) != std::string::npos) throw;
    throw InputError(name + ": " + what);
  }
}

void say_what_was_read(const Input& input, std::FILE* to) {
  if (!input.import) return;
  std::fprintf(to, "%s (%s)\n%s", input.name.c_str(), input.import->format.c_str(),
               import_text(*input.import).c_str());
  if (!input.clip_was_named)
    std::fprintf(to, "  it is the first clip that moves the surface; --clip names another\n");
  std::fprintf(to, "%s", surface_text(*input.import).c_str());
}

double frame_number(const Input& input, std::size_t frame) {
  if (!input.import) return static_cast<double>(frame);
  return frame_at(*input.import, second_of_frame(*input.import, frame, input.clip->frame_count()));
}

std::string frames_text(const IntervalRange& range, const Input& input) {
  return shown(frame_number(input, range.first)) + ":" + shown(frame_number(input, range.last));
}

IntervalRange parse_frames(const std::string& text, const Input& input) {
  const std::size_t end = input.clip->frame_count() - 1;
  if (text.empty()) return {0, end};
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos)
    throw InputError("--frames " + text +
                     ": has no colon; write A:B for the intervals between frames A and B");
  const std::string_view view(text);
  const double least = frame_number(input, 0), most = frame_number(input, end);
  const double from = parse_frame(view.substr(0, colon), least, text);
  const double to = parse_frame(view.substr(colon + 1), most, text);
  IntervalRange range{0, end};
  while (range.first < end && frame_number(input, range.first) < from - kSameFrame) ++range.first;
  while (range.last > 0 && frame_number(input, range.last) > to + kSameFrame) --range.last;
  if (from < least - kSameFrame || to > most + kSameFrame || range.first >= range.last)
    throw InputError("--frames " + text + ": not inside the clip's frames " + shown(least) + " to " +
                     shown(most) + ", or empty; choose " + shown(least) + " <= A < B <= " + shown(most));
  // Intervals lie between frames: to begin or end elsewhere would answer less than was asked.
  const auto require_frame = [&](double asked, std::size_t frame, std::size_t before) {
    if (std::abs(frame_number(input, frame) - asked) <= kSameFrame) return;
    throw InputError("--frames " + text + ": no frame has the number " + shown(asked) + "; choose " +
                     shown(frame_number(input, before)) + " or " + shown(frame_number(input, before + 1)));
  };
  require_frame(from, range.first, range.first == 0 ? 0 : range.first - 1);
  require_frame(to, range.last, range.last);
  return range;
}

bool allows(const Input& input, const Strategy& strategy) {
  return !why_not(strategy, input.mesh, input.rig.has_value());
}

const Strategy& default_strategy(const Input& input, bool first) {
  const Strategy* chosen = &complete_fallback();
  if (input.thickness.left_out) return *chosen;
  const Guarantee wanted = first ? Guarantee::first_contact : Guarantee::all_from_embedded;
  for (const Strategy* strategy : strategies_in(""))
    if (strategy->guarantee == wanted && allows(input, *strategy)) chosen = strategy;
  return *chosen;
}

}  // namespace cscd::bench
