#include "bench/inputs/import.h"

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <unistd.h>

#include "core/base/error.h"
#include "core/base/number_text.h"
#include "scenes/base/temporaries.h"
#include "scenes/catalog/scene_cache.h"
#include "scenes/clip/point_cache.h"
#include "scenes/motion/motion_file.h"
#include "scenes/sandbox/run_limited.h"

namespace cscd::bench {
namespace {

namespace fs = std::filesystem;
using scenes::ImportReport;

constexpr std::size_t kMostModelBytes = std::size_t{256} << 20;
constexpr std::size_t kMostReportBytes = std::size_t{16} << 20;

// A folder of our own for as long as this lives.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    // Beside the scenes' frames if there is such a place: the frames of a clip may be larger than /tmp.
    std::error_code error;
    fs::path place;
    try {
      place = scenes::cache_folder();
      fs::create_directories(place, error);
    } catch (const InputError&) {
      error = std::make_error_code(std::errc::no_such_file_or_directory);
    }
    if (error || !make_in(place))
      if (!make_in(fs::temp_directory_path(error)))
        throw InputError("no place for temporary files; let CSCD_CACHE name a folder that can be written to");
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  static constexpr char kPrefix[] = "import-";

  // Removes the folders of processes that were killed. A folder's name holds the id of its process.
  static void remove_forsaken(const fs::path& place) {
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(place, ignored)) {
      const std::string name = entry.path().filename().string();
      if (!name.starts_with(kPrefix)) continue;
      const int owner = std::atoi(name.c_str() + std::strlen(kPrefix));
      if (owner > 0 && kill(owner, 0) != 0 && errno == ESRCH) fs::remove_all(entry.path(), ignored);
    }
  }
  bool make_in(const fs::path& place) {
    remove_forsaken(place);
    std::string name = (place / (kPrefix + std::to_string(getpid()) + "-XXXXXX")).string();
    if (mkdtemp(name.data()) == nullptr) return false;
    path_ = name;
    registered_.emplace(path_);
    return true;
  }
  fs::path path_;
  std::optional<Temporary> registered_;
};

void require_model_file(const fs::path& path) {
  const std::string name = path.string();
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw InputError(name + ": no such file; check the name");
  if (fs::is_directory(status)) return;  // of a sequence of frames
  if (!fs::is_regular_file(status)) throw InputError(name + ": is not a regular file; give a model file");
  if (access(path.c_str(), R_OK) != 0)
    throw InputError(name + ": cannot be read (" + std::strerror(errno) +
                     "); ask its owner for the right to read it");
  const std::uintmax_t bytes = fs::file_size(path, error);
  if (error || bytes == 0) throw InputError(name + ": is empty; export it again");
  if (bytes > kMostModelBytes)
    throw InputError(name + ": has " + std::to_string(bytes >> 20) + " MiB, more than the " +
                     std::to_string(kMostModelBytes >> 20) + " MiB that are read; simplify the model");
}

fs::path import_program() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path() / "cscd-import";
}

std::string read_report(const fs::path& path) {
  std::error_code error;
  if (fs::file_size(path, error) > kMostReportBytes || error) return {};
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string number(double value) {
  return rounded_text(value, 6);
}

// "1st", "2nd", "11th".
std::string ordinal(std::size_t n) {
  const bool teens = n / 10 % 10 == 1;
  const char* const ending = teens         ? "th"
                             : n % 10 == 1 ? "st"
                             : n % 10 == 2 ? "nd"
                             : n % 10 == 3 ? "rd"
                                           : "th";
  return std::to_string(n) + ending;
}

const ImportReport::Clip* chosen_clip(const ImportReport& report) {
  const auto chosen = static_cast<std::size_t>(report.chosen_clip);
  return report.chosen_clip >= 0 && chosen < report.clips.size() ? &report.clips[chosen] : nullptr;
}

std::string listed(const std::vector<std::size_t>& numbers) {
  std::string out;
  for (const std::size_t n : numbers) out += (out.empty() ? "" : ", ") + std::to_string(n);
  return out;
}

}  // namespace

ImportedModel import_model(const fs::path& path, const ModelOptions& options) {
  require_model_file(path);
  if (options.import.clip == kAllClips)
    throw InputError(std::string("--clip ") + kAllClips +
                     ": only query and view take all clips in one run; name one, or give its number");
  const TemporaryFolder folder;
  const fs::path cache = folder.path() / "frames.h5", report = folder.path() / "report",
                 sources = folder.path() / "sources", motion = folder.path() / "motion";
  std::error_code ignored;
  std::vector<std::string> arguments{fs::absolute(path, ignored).string(), cache.string(), report.string(),
                                     sources.string()};
  const bool has_motion = options.true_motion && !options.import.survey;
  scenes::ImportOptions import = options.import;
  if (has_motion) import.motion = motion.string();
  const std::vector<std::string> wishes = to_arguments(import);
  arguments.insert(arguments.end(), wishes.begin(), wishes.end());
  scenes::Limits limits;
  limits.memory_bytes = options.memory_mib << 20;
  limits.seconds = options.seconds;

  const scenes::Outcome outcome = run_limited(import_program(), arguments, limits);
  const std::string what = scenes::printable(outcome.errors.substr(0, outcome.errors.find('\n')), 1000);
  if (outcome.end == scenes::Outcome::End::timed_out)
    throw InputError(path.string() + ": its import was " + to_text(outcome) +
                     " and was ended; raise --import-seconds if the file is to be trusted");
  if (outcome.end == scenes::Outcome::End::exited && outcome.code == 2)
    throw InputError(path.string() + ": " + what);
  if (outcome.end != scenes::Outcome::End::exited || outcome.code != 0)
    throw InputError(path.string() + ": the reader failed on it (" + to_text(outcome) +
                     "), which is a fault of the reader or more than --import-memory " +
                     std::to_string(options.memory_mib) +
                     " MiB holds; raise that, or convert the file to another format");
  try {
    ImportedModel model{
        std::make_unique<scenes::PointCacheReader>(cache), scenes::parse_report(read_report(report)), {}};
    const scenes::ClipHeader& header = model.clip->header();
    model.sources = scenes::read_source_map(sources, {header.triangles.size(), header.vertex_count,
                                                      model.report.parts.size(), model.report.bones.size()});
    if (has_motion)
      model.motion =
          std::make_shared<const scenes::CharacterMotion>(scenes::read_motion(motion, header.vertex_count));
    return model;  // the open file outlives its name
  } catch (const scenes::NoBounds& error) {
    throw InputError(path.string() + ": --true-motion: " + error.what());
  } catch (const InputError& error) {
    throw InputError(path.string() + ": its import gave what cannot be used: " + error.what());
  }
}

double second_of_frame(const ImportReport& report, std::size_t frame, std::size_t frames) {
  const double lead_in = static_cast<double>(report.lead_in);
  const ImportReport::Clip* clip = chosen_clip(report);
  const double length = clip != nullptr ? clip->seconds : 0;
  return frame + 1 == frames ? length : (static_cast<double>(frame) - lead_in) / report.fps;
}

std::string rate_text(const ImportReport& report) {
  const std::string rate =
      number(report.fps) + (report.fps == 1 ? " frame a second, " : " frames a second, ");
  if (report.fps_from == scenes::kAsked) return rate + "as asked (--fps)";
  if (report.fps_from == scenes::kStated) return rate + "as the file says";
  if (report.fps_from == scenes::kSpaced) return rate + "as the keys of the file are spaced";
  return rate + "because the file does not say (--fps)";
}

double frame_at(const ImportReport& report, double seconds) {
  const ImportReport::Clip* clip = chosen_clip(report);
  return seconds * report.fps + (clip != nullptr && seconds >= 0 ? clip->first_frame : 0);
}

std::string clip_title(const ImportReport& r) {
  const ImportReport::Clip* clip = chosen_clip(r);
  if (clip == nullptr || r.joints == 0) return {};  // a moving surface alone has no clips
  const std::string name = clip->name.empty() ? "clip" : "clip '" + clip->name + "'";
  if (r.clips.size() == 1) return clip->name.empty() ? "its only clip" : name + " (the only one)";
  return name + " (" + ordinal(static_cast<std::size_t>(r.chosen_clip) + 1) + " of " +
         many(r.clips.size(), "clip") + ")";
}

std::string import_text(const ImportReport& r) {
  std::string out;
  const auto line = [&](const std::string& text) { out += "  " + text + "\n"; };
  if (const ImportReport::Clip* clip = chosen_clip(r)) {
    const std::string title = clip_title(r);
    std::string text = (title.empty() ? "" : title + ": ") + number(clip->seconds) + " s as " +
                       many(static_cast<std::size_t>(clip->frames), "frame") + ", from frame " +
                       number(clip->first_frame) + " to " +
                       number(std::round(1e3 * frame_at(r, clip->seconds)) / 1e3) + ", " + rate_text(r);
    if (r.joints > 0)
      text += "; drives " + std::to_string(clip->driven) + " of " +
              many(static_cast<std::size_t>(r.joints), "bone");
    if (clip->ticks_per_second == 0 && r.joints > 0 && r.format != "glTF 2")
      text += "; the file gives no ticks a second, 25 assumed";
    line(text);
  }
  if (chosen_clip(r) == nullptr && !r.clips.empty())  // a survey
    line(many(r.clips.size(), "clip") + ", " + rate_text(r));
  if (r.lead_in > 0)
    line("begins with " + std::to_string(r.lead_in) + " frames (" +
         number(static_cast<double>(r.lead_in) / r.fps) +
         " s) from the bind pose to the first pose, which are no part of the clip: their times and numbers "
         "are "
         "negative");
  return out;
}

std::string surface_text(const ImportReport& r) {
  std::string out;
  const auto line = [&](const std::string& text) { out += "  " + text + "\n"; };
  if (r.components > 0) {
    std::string which = (r.chosen_components.size() == 1 ? "component " : "components ") +
                        listed(r.chosen_components) + " of " + std::to_string(r.components);
    if (r.chosen_components.size() == r.components)
      which = r.components == 1 ? "one component" : "all " + std::to_string(r.components) + " components";
    line(which + ": " + std::to_string(r.chosen_triangles) + " of " + std::to_string(r.triangles) +
         " triangles");
  }
  if (r.collapsed_triangles + r.duplicate_triangles > 0)
    line("left out: " + std::to_string(r.collapsed_triangles) + " collapsed and " +
         std::to_string(r.duplicate_triangles) + " duplicate triangles");
  if (r.filled_holes > 0)
    line("filled: " + std::to_string(r.filled_holes) + " holes with " + std::to_string(r.filled_triangles) +
         " triangles");
  if (r.flipped_components > 0)
    line("turned outward: " + std::to_string(r.flipped_components) + " components");
  for (const std::string& note : r.notes) line("note: " + note);
  return out;
}

nlohmann::json import_json(const ImportReport& r) {
  nlohmann::json clips = nlohmann::json::array();
  for (const ImportReport::Clip& clip : r.clips)
    clips.push_back({{"name", clip.name},
                     {"start", clip.start},
                     {"seconds", clip.seconds},
                     {"ticks_per_second", clip.ticks_per_second},
                     {"frames", clip.frames},
                     {"first_frame", clip.first_frame},
                     {"bones_driven", clip.driven}});
  nlohmann::json parts = nlohmann::json::array();
  const auto count = [](std::int32_t n) { return n < 0 ? nlohmann::json() : nlohmann::json(n); };
  for (const ImportReport::Part& part : r.parts)
    parts.push_back({{"name", part.name},
                     {"node", part.node},
                     {"mesh", count(part.mesh)},
                     {"primitive", count(part.primitive)}});
  nlohmann::json unit, chosen, up;
  if (!r.up.empty()) up = r.up;
  if (r.centimetres_per_unit > 0) unit = r.centimetres_per_unit;
  if (r.chosen_clip >= 0) chosen = r.chosen_clip;
  return {
      {"format", r.format},
      {"up", up},
      {"centimetres_per_unit", unit},
      {"nodes", r.nodes},
      {"meshes", r.meshes},
      {"bones", r.joints},
      {"parts", parts},
      {"vertices", r.vertices},
      {"triangles", r.triangles},
      {"most_influences", r.most_influences},
      {"clips", clips},
      {"clip", chosen},
      {"fps", r.fps},
      {"fps_from", r.fps_from},
      {"lead_in_frames", r.lead_in},
      {"weld", {{"tolerance", r.weld_tolerance}, {"spread", r.weld_spread}, {"vertices", r.welded_vertices}}},
      {"collapsed_triangles", r.collapsed_triangles},
      {"duplicate_triangles", r.duplicate_triangles},
      {"filled", {{"holes", r.filled_holes}, {"triangles", r.filled_triangles}}},
      {"flipped_components", r.flipped_components},
      {"components", r.components},
      {"chosen_components", r.chosen_components},
      {"chosen_triangles", r.chosen_triangles},
      {"notes", r.notes}};
}

}  // namespace cscd::bench
