#include <CLI/App.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <thread>

#include "bench/command_line/add_options.h"
#include "bench/command_line/command.h"
#include "bench/inputs/input.h"
#include "bench/inputs/input_options.h"
#include "bench/inputs/thickness.h"
#include "bench/measure/studies/scale_study.h"
#include "bench/measure/studies/scale_summary.h"
#include "bench/measure/studies/small_steps.h"
#include "bench/output/data.h"
#include "bench/output/json_text.h"
#include "bench/output/output.h"
#include "bench/output/progress.h"
#include "bench/records/environment.h"
#include "bench/records/shortfall.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"
#include "scenes/catalog/resized.h"

// How cost grows: with triangles, with the length of the step, with bones, threads and contacts, with a
// thickness, and with how far small steps move (schema cscd.scale/2). What is run unless told otherwise is
// data, scale_plan.json.
namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

struct ScaleOptions {
  std::vector<std::string> studies, scenes, strategies;
  std::vector<std::size_t> sizes;
  std::vector<double> steps, moves;
  std::optional<std::size_t> intervals, repetitions;
  std::size_t reference_limit = 250'000, seed = 2014;
  int threads = 1;
  bool smoke = false, largest = false, force = false;
  std::string output;
};

std::span<const OptionRow<ScaleOptions>> scale_options() {
  using S = ScaleOptions;
  static const OptionRow<S> rows[] = {
      {.name = "--study",
       .member = &S::studies,
       .help = "size, step, bones, threads, contacts, thickness, small, with commas; default all but the "
               "last two",
       .choices = {"size", "step", "bones", "threads", "contacts", "thickness", "small"}},
      {"--scene", &S::scenes,
       "scenes with commas; default the six, and cloth for contacts, thickness and small; point caches\n"
       "for thickness and small"},
      {"--sizes", &S::sizes, "numbers of triangles, about", {{500, 20'000'000}}},
      {"--largest", &S::largest, "775 thousand and 3.1 million triangles too"},
      {"--steps", &S::steps, "lengths of steps, in frame steps", {{1e-3, 1000}}},
      {"--moves", &S::moves, "how far small steps move, in mean edges", {{1e-9, 1}}},
      {"--strategy", &S::strategies, "strategies with commas; default by study"},
      {"--intervals", &S::intervals, "of each scene, spread evenly", {{1, 1000}}},
      {"--repetitions", &S::repetitions, "of each interval's timing", {{1, 1000}}},
      {"--reference-up-to", &S::reference_limit,
       "triangles up to which the reference answers and is timed on every interval"},
      {"--seed", &S::seed, "of the order of the strategies"},
      {"--smoke", &S::smoke, "small surfaces, in seconds; times mean nothing"},
      threads_option<S>()};
  return rows;
}

// Returns the named rows that this build has, as packages may be missing. Throws InputError where the user
// named a row that no build knows.
std::vector<StrategyRow> chosen_rows(const ScaleOptions& options, const ordered_json& names) {
  std::vector<StrategyRow> rows = rows_called(options.strategies);
  if (!rows.empty()) return rows;
  for (const std::string text : names)
    for (const Strategy& strategy : strategies())
      for (const StrategyRow row : {StrategyRow{&strategy}, StrategyRow{&strategy, true}})
        if (row.name() == text) rows.push_back(row);
  return rows;
}

std::size_t frames_of(const std::string& scene) {
  return is_point_cache(scene) ? open_input(scene).clip->frame_count() : scenes::load_scene(scene).frames;
}

std::size_t triangles_of(const std::string& scene) {
  return is_point_cache(scene) ? open_input(scene).mesh.triangle_count()
                               : scenes::triangle_count(scenes::load_scene(scene));
}

// Makes the subjects of a run out of what was asked for and, where nothing was, of the plan in data. One
// member a study, called scene by scene with what all subjects of the scene have in common.
class Plan {
 public:
  explicit Plan(const ScaleOptions& options)
      : options_(options),
        data_(data_json("scale_plan.json").at(options.smoke ? "smoke" : "full")),
        sizes_(or_planned(options.sizes, "sizes")),
        steps_(or_planned(options.steps, "steps")) {
    std::ranges::sort(steps_);
    for (const double step : steps_)
      if (step > 1 && step != std::floor(step))
        throw InputError("--steps: " + ordered_json(step).dump() +
                         " is neither a share of a frame nor a whole number of frames; round it");
  }

  // Scenes of which only the studies of contacts, of thickness and of small steps are planned come last.
  std::vector<std::string> scenes() const {
    std::vector<std::string> names = or_planned(options_.scenes, "scenes");
    if (!options_.scenes.empty()) return names;
    for (const char* key : {"contact_scenes", "thickness_scenes", "small_scenes"})
      for (const std::string name : data_.at(key))
        if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    return names;
  }

  // Returns the settings that all studies begin from.
  ScaleSubject common(const std::string& scene, const char* rows) const {
    ScaleSubject subject;
    subject.rows = chosen_rows(options_, data_.at(rows));
    subject.scene = scene;
    subject.steps = {{scene}};
    subject.triangles = data_.at("other_triangles");
    subject.repetitions = or_planned(options_.repetitions, "repetitions");
    subject.reference_limit = options_.reference_limit;
    subject.threads = options_.threads;
    return subject;
  }

  bool lists(const char* key, const std::string& scene) const {
    return std::ranges::find(data_.at(key), ordered_json(scene)) != data_.at(key).end();
  }

  void size(ScaleSubject subject) {
    std::vector<std::size_t> sizes = sizes_;
    if (options_.largest)
      for (const std::size_t size : data_.at("largest")) sizes.push_back(size);
    std::ranges::sort(sizes);
    for (const std::size_t size : sizes) subject.triangles = size, add(subject);
  }
  void step(ScaleSubject subject) {
    subject.steps.clear();
    for (const double step : steps_) subject.steps.push_back({subject.scene, step});
    add(subject);
  }
  void bones(ScaleSubject subject) {
    for (const std::size_t bones : data_.at("bones")) subject.bones = bones, add(subject);
  }
  void threads(ScaleSubject subject) {
    subject.triangles = data_.at("thread_triangles");
    for (const int threads : data_.at("threads"))
      if (threads == 1 || threads <= static_cast<int>(std::thread::hardware_concurrency()))
        subject.threads = threads, add(subject);
  }
  void contacts(ScaleSubject subject) {
    subject.recorded = true;
    subject.triangles = 0;
    subject.steps.push_back({subject.scene + "_contact"});
    add(subject, "contact_intervals");
  }

  void thickness(ScaleSubject subject) {
    for (const StrategyRow& row : subject.rows)
      require_fit({.thickness = parse_length("--thickness", "1e")}, *row.strategy);
    subject.recorded = true;
    subject.triangles = 0;
    subject.steps.clear();
    for (const double edges : data_.at("thicknesses"))
      subject.steps.push_back({.scene = subject.scene, .edges = edges});
    add(subject);
  }

  void small(ScaleSubject subject) {
    std::vector<double> moves = or_planned(options_.moves, "moves");
    std::ranges::sort(moves);
    subject.triangles = 0;
    subject.steps.clear();
    for (const double edges : data_.at("small_thicknesses"))
      for (const double distance : moves)
        for (const char* series : {"substeps", "trials", "iterations"})
          if (series == std::string_view("substeps") || distance == data_.at("moves_of_all_series"))
            subject.steps.push_back(
                {.scene = subject.scene, .edges = edges, .moves = distance, .series = series});
    subject.repetitions = or_planned(options_.repetitions, "small_repetitions");
    add(subject, "small_intervals");
    std::vector<std::size_t>& starts = all_.back().starts;
    std::vector<std::size_t> repeated;
    for (const std::size_t start : starts) repeated.insert(repeated.end(), kMeasuredSteps, start);
    starts = std::move(repeated);
  }

  std::vector<ScaleSubject> take() { return std::move(all_); }

 private:
  template <class T>
  std::vector<T> or_planned(const std::vector<T>& given, const char* key) const {
    return given.empty() ? data_.at(key).get<std::vector<T>>() : given;
  }
  std::size_t or_planned(const std::optional<std::size_t>& given, const char* key) const {
    return given ? *given : data_.at(key).get<std::size_t>();
  }
  void add(ScaleSubject subject, const char* intervals = "intervals") {
    // A variant with contacts may be shorter than its scene.
    std::size_t frames = frames_of(subject.scene);
    for (const ScaleStep& step : subject.steps)
      if (step.scene != subject.scene) frames = std::min(frames, frames_of(step.scene));
    std::size_t count = or_planned(options_.intervals, intervals);
    if (is_point_cache(subject.scene)) count = std::min(count, std::max<std::size_t>(frames, 3) - 2);
    subject.starts =
        frames == 2 ? std::vector<std::size_t>{0} : spread_starts(frames, count, subject.steps.back().frames);
    all_.push_back(std::move(subject));
  }

  const ScaleOptions& options_;
  const ordered_json data_;
  std::vector<std::size_t> sizes_;
  std::vector<double> steps_;
  std::vector<ScaleSubject> all_;
};

constexpr struct {
  const char* name;
  const char *scenes, *rows;  // where the plan in data lists them
  bool any_scene;             // that the user names, planned or not
  void (Plan::*add)(ScaleSubject);
} kStudies[] = {{"size", "scenes", "size_strategies", true, &Plan::size},
                {"step", "scenes", "step_strategies", true, &Plan::step},
                {"bones", "bone_scenes", "bone_strategies", false, &Plan::bones},
                {"threads", "thread_scenes", "thread_strategies", false, &Plan::threads},
                {"contacts", "contact_scenes", "contact_strategies", false, &Plan::contacts},
                {"thickness", "thickness_scenes", "thickness_strategies", true, &Plan::thickness},
                {"small", "small_scenes", "small_strategies", true, &Plan::small}};

// Point caches have one size and the motion that they hold, so that two studies alone take them. These run
// where they are named: thick queries of large surfaces take as long as all the other studies.
bool only_where_named(std::string_view study) {
  return study == "thickness" || study == "small";
}

bool takes(const ScaleOptions& options, std::string_view study, const std::string& scene) {
  if (!only_where_named(study) && is_point_cache(scene)) return false;
  if (options.studies.empty()) return !only_where_named(study);
  return std::ranges::find(options.studies, study) != options.studies.end();
}

// Returns the subjects of a full run, or of a small one.
std::vector<ScaleSubject> planned(const ScaleOptions& options) {
  Plan plan(options);
  for (const std::string& scene : plan.scenes())
    for (const auto& study : kStudies) {
      if (!takes(options, study.name, scene)) continue;
      const bool is_named = study.any_scene && !options.scenes.empty();
      if (!is_named && !plan.lists(study.scenes, scene)) continue;
      ScaleSubject subject = plan.common(scene, study.rows);
      subject.study = study.name;
      (plan.*study.add)(std::move(subject));
    }
  return plan.take();
}

// Queries that will be asked, weighed by triangles: about what a run costs.
double estimated_minutes(std::span<const ScaleSubject> all) {
  constexpr double kMicrosecondsATriangle = 125, kSecondsOnce = 1;
  double seconds = 0;
  for (const ScaleSubject& subject : all) {
    const auto triangles =
        static_cast<double>(subject.triangles > 0 ? subject.triangles : triangles_of(subject.scene));
    const auto intervals = static_cast<double>(subject.steps.size() * subject.starts.size());
    seconds += kSecondsOnce + kMicrosecondsATriangle * 1e-6 * triangles * intervals;
  }
  return seconds / 60;
}

std::vector<std::string> command_line(ScaleOptions options, std::span<const ScaleSubject> all) {
  options.repetitions = all.front().repetitions;
  std::vector<std::string> words = {"cscd", "scale"};
  echo_options<ScaleOptions>(scale_options(), options, words);
  return words;
}

void print(const ordered_json& subject) {
  std::printf("%s %s: %zu triangles, %zu bones, threads: %d%s\n",
              subject.at("study").get<std::string>().c_str(), subject.at("scene").get<std::string>().c_str(),
              subject.at("triangles").get<std::size_t>(), subject.at("bones").get<std::size_t>(),
              subject.at("threads").get<int>(), subject.at("ok") ? "" : ", NOT VERIFIED");
  for (const ordered_json& row : subject.at("left_out")) {
    const std::string why = row.at("why");  // what follows a colon is about single triangles
    std::printf("  left out: %s, because %s\n", row.at("name").get<std::string>().c_str(),
                why.substr(0, why.find(':')).c_str());
  }
  for (const ordered_json& step : subject.at("steps")) {
    for (const ordered_json& failure : step.at("verified").at("failures"))
      std::printf("  %s\n", failure.get<std::string>().c_str());
    const bool is_thick = step.contains("thickness");
    std::string what = step.at("scene");
    if (step.contains("moves"))
      what += ", " + step.at("series").get<std::string>() + " of " + step.at("moves").dump() + " edges";
    std::printf("  %s, %s %-5s %zu of %zu %s:", what.c_str(), is_thick ? "thickness" : "step",
                step.at(is_thick ? "thickness" : "step").dump().c_str(),
                step.at("colliding").get<std::size_t>(), step.at("starts").size(),
                is_thick ? "come that close" : "collide");
    std::string lacking;  // what stands behind the marks
    for (const ordered_json& row : step.at("strategies")) {
      if (!row.contains("ms")) continue;
      const std::string name = row.at("name"), less = row.value("shortfall", "");
      const std::string mark = less.empty() ? "" : std::string(kShortfallMark);
      std::printf("  %s %.2f ms%s", name.c_str(), row.at("ms").at("total").get<double>(), mark.c_str());
      if (!less.empty()) lacking += "    " + mark + " " + name + " " + less + "\n";
    }
    std::printf("\n%s", lacking.c_str());
  }
  std::fflush(stdout);
}

void run_scale(const ScaleOptions& options) {
  const std::vector<ScaleSubject> all = planned(options);
  if (all.empty()) throw InputError("--study, --scene: leave nothing to measure; name a scene of the study");
  OutputFile output(options.output, options.force);
  std::printf("%zu surfaces; about %.1f minutes on an idle machine\n", all.size(), estimated_minutes(all));
  std::fflush(stdout);

  std::mt19937_64 random(options.seed);
  ordered_json subjects = ordered_json::array();
  const ordered_json where = environment();  // with the load before the work
  Progress progress("scale", all.size());
  bool ok = true;
  for (const ScaleSubject& subject : all) {
    subjects.push_back(measure_subject(subject, random));
    ok = ok && subjects.back().at("ok");
    print(subjects.back());
    progress.advance();
  }
  const ordered_json record = {{"schema", "cscd.scale/2"},
                               {"environment", where},
                               {"command", command_line(options, all)},
                               {"seed", options.seed},
                               {"smoke", options.smoke},
                               {"ok", ok},
                               {"fits", fits(subjects)},
                               {"step_ratios", step_ratios(subjects)},
                               {"contact_ratios", contact_ratios(subjects)},
                               {"thickness_ratios", thickness_ratios(subjects)},
                               {"subjects", std::move(subjects)}};
  output.commit(json_text(record));
  if (!ok) end_with(ExitStatus::failed);
}

}  // namespace

void add_scale(CLI::App& app) {
  auto options = std::make_shared<ScaleOptions>();
  CLI::App* command = app.add_subcommand(
      "scale",
      "Measure how cost grows: with triangles, with the length of the step, with bones, with threads, with\n"
      "contacts, with the thickness, with how far small steps move.\n\n"
      "  cscd scale --json scale.json\n"
      "  cscd scale --smoke\n"
      "  cscd scale --study size --scene rope --sizes 12000,48000,194000 --json rope.json\n\n"
      "size     the scenes with other numbers of triangles in the same motion, and memory a triangle\n"
      "step     intervals between frames that lie further apart, or nearer\n"
      "bones    chains of bones merged or cut, on the same surface\n"
      "threads  the same surface on one thread and more, up to those of the machine\n"
      "contacts the scene and its variant with contacts, NAME_contact, in turn; intervals as recorded\n"
      "thickness what comes within a distance, in mean edges, counts; also of point caches; where named "
      "alone\n"
      "small    steps as a solver takes them, of so many mean edges: one after the other, trials from one\n"
      "         start, iterations that creep; every fourth of 25 is measured; also of point caches; where "
      "named "
      "alone\n\n"
      "Every answer is held against the complete reference before anything is timed; on meshes above\n"
      "--reference-up-to on one interval a step, and the others against each other. Exit status 1 where an\n"
      "answer is wrong. \"STRATEGY --first\" looks for the earliest contact alone.");
  add_options(*command, scale_options(), *options);
  add_output_options(*command, *options, "where the record goes");
  command->callback([options] { run_scale(*options); });
}

}  // namespace cscd::bench
