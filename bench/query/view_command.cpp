#include <CLI/App.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "bench/answer/answer.h"
#include "bench/answer/answer_json.h"
#include "bench/answer/options/answer_options.h"
#include "bench/answer/surface_names.h"
#include "bench/answer/true_answer.h"
#include "bench/command_line/command.h"
#include "bench/command_line/usage.h"
#include "bench/inputs/input.h"
#include "bench/inputs/thickness.h"
#include "bench/output/output.h"
#include "bench/output/progress.h"
#include "bench/query/view/clip_recording.h"
#include "bench/query/view/html.h"
#include "bench/query/view/overlap_recording.h"
#include "bench/query/view/recording.h"
#include "bench/query/view_page.h"
#include "bench/strategies/catalogue.h"
#include "bench/strategies/strategy_row.h"
#include "core/base/error.h"
#include "scenes/clip/up_axis.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

constexpr std::size_t kMostStrategies = 6;  // side by side; more could not be told apart
constexpr std::size_t kMostVerdicts = 12;   // of clips, printed

struct ViewOptions : ViewRequest {
  std::string output;
  bool force = false;
};

std::vector<const Strategy*> chosen_strategies(const ViewRequest& options, const Input& input) {
  if (options.strategies.empty()) return {&default_strategy(input, options.answers.first)};
  std::vector<const Strategy*> chosen;
  for (const std::string& name : options.strategies) chosen.push_back(&strategy_named(name));
  return chosen;
}

// For every triangle the numbers of its bone, or else its part, and of its part.
std::vector<std::uint16_t> places_of_triangles(const TriangleMesh& mesh, const SurfaceNames& names,
                                               TextTable& texts, bool parts) {
  std::vector<std::uint16_t> places;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const TriangleId triangle{static_cast<std::int32_t>(t)};
    places.push_back(texts.number_of(parts ? names.part_of(triangle) : names.place_of(triangle)));
  }
  return places;
}

struct Contestant {
  Answerer answerer;
  StrategyRecording recording;
};

// What the page has to know of an interval's true motion.
json true_moment(const Input& input, const SurfaceNames& names, const IntervalAnswer& answer,
                 std::size_t first) {
  const TrueAnswer& own = *answer.motion;
  json out = true_motion_json(input, answer);
  out["interval"] = answer.index - first;
  out["at"] = out[own.parts_again ? "from" : "to"];
  std::string text = "true motion: ";
  const bool crosses = own.verdict == TrueVerdict::intersects_at_start;
  if (own.pair) {
    text += meeting_text({names.place_of(own.pair->first), names.place_of(own.pair->second)},
                         crosses                               ? "crosses"
                         : own.verdict == TrueVerdict::touches ? "touches"
                                                               : "comes close to");
  } else {
    text += to_string(own.verdict);
  }
  const bool lines = answer.verdict != IntervalVerdict::clear;
  if (differs(answer)) text += lines ? ", where straight lines touch" : ", where straight lines do not";
  out["text"] = std::move(text);
  return out;
}

// Answers one clip, adds its arrays to `sections`, and returns what a page has to know of it.
json record_clip(ViewRequest options, Input input, Sections& sections) {
  input.threads = options.threads;
  // The one pose of a file is asked about as it is, whatever is left out of motions.
  if (input.is_one_pose) options.answers.keep_rest_crossings = true;
  ignore(input, options.ignored);
  set_thickness(input, options.thickness);
  const ElementaryTest& elementary = elementary_test_named(options.elementary);
  const std::vector<const Strategy*> strategies = chosen_strategies(options, input);
  const IntervalRange range = parse_frames(options.frames, input);
  const SurfaceNames names(input);
  TextTable texts;
  const std::vector<std::uint16_t> places = places_of_triangles(input.mesh, names, texts, false);
  const std::vector<std::uint16_t> parts = places_of_triangles(input.mesh, names, texts, true);
  sections.add("place", places);
  sections.add("part", parts);

  Watchdog watchdog = watchdog_of(options, input);
  ClipRecording clip(input, range);
  std::vector<std::unique_ptr<Contestant>> contestants;
  for (const Strategy* strategy : strategies) {
    watchdog.restart();
    input.use_bones = gets_bones(*strategy, input.clip->interval_count());
    Answerer answerer(input, *strategy, elementary, options.answers);
    ClipAnswer answer = prepared_answer(input, names, *strategy, elementary, options.answers, answerer);
    contestants.emplace_back(
        new Contestant{std::move(answerer), StrategyRecording(std::move(answer), clip.grid())});
  }
  std::optional<TrueAnswerer> true_motion;
  if (input.motion)
    true_motion.emplace(input, elementary, contestants.front()->answerer.rest_crossings(), options.answers,
                        options.resolution);
  json true_moments = json::array();
  Answerer& first_answerer = contestants.front()->answerer;
  OverlapEvents events(input, names, first_answerer);
  OverlapRecording overlaps;
  input.use_bones = true;  // strategies that do without take no notice
  {
    Progress progress("view " + options.input, range.last - range.first);
    for (std::size_t i = range.first; i < range.last; ++i) {
      clip.add_frame(input.clip->load_frame(i));
      bool touches = false;
      std::optional<TrueAnswer> motion;  // the same beside all strategies
      std::pair<Crossings, Crossings> start;
      for (const auto& contestant : contestants) {
        watchdog.restart();
        IntervalAnswer answer = contestant->answerer.answer(i);
        const scenes::ClipInterval loaded = input.clip->load(i);
        // All strategies see the same starts.
        if (contestant == contestants.front()) {
          overlaps.add(events.add(answer, loaded.motion.start(), {.ways = true}), loaded.motion.start());
          start = {answer.start, answer.start_touching};
        } else {
          std::tie(answer.start, answer.start_touching) = start;
          answer.verdict = verdict_of(answer, input.thickness.length > 0);
        }
        if (true_motion && contestant == contestants.front()) {
          true_motion->answer(loaded.motion, answer);
          motion = answer.motion;
          if (motion->verdict != TrueVerdict::clear || differs(answer))
            true_moments.push_back(true_moment(input, names, answer, range.first));
          if (motion->pair && differs(answer) && answer.found.contacts.empty())
            clip.add_other_end(true_motion->positions_at(motion->parts_again ? motion->from : motion->to));
        }
        answer.motion = motion;
        contestant->recording.add(answer, loaded, texts);
        touches = touches || !answer.found.contacts.empty();
      }
      if (touches && input.clip->header().predicted) clip.add_other_end(input.clip->load(i).motion.end());
      progress.advance();
    }
    clip.add_frame(input.clip->load_frame(range.last));
  }
  watchdog.restart();
  const std::optional<IntervalAnswer> last = last_pose_of(input, range.last, first_answerer, events);

  overlaps.write(sections);
  for (const auto& contestant : contestants) contestant->recording.take(last, events);
  const Up up = options.up.empty() ? input.up : Up{options.up, "--up says so"};
  json rows = json::array();
  for (std::size_t s = 0; s < contestants.size(); ++s)
    rows.push_back(contestants[s]->recording.write(sections, "s" + std::to_string(s) + "."));
  json header = {{"up", {{"axis", up.axis}, {"because", up.because}}},
                 {"engine_colours", !options.strategies.empty()},
                 {"thickness", input.thickness.asked.thickness.text},
                 {"clip", clip.write(sections)},
                 {"texts", texts.texts()},
                 {"events", event_lines(input, events.all())},
                 {"true_motion", input.motion ? std::move(true_moments) : json()},
                 {"rest", rest_json(contestants.front()->recording.answer())},
                 {"strategies", std::move(rows)}};
  if (input.import) header["import"] = import_json(*input.import);
  return header;
}

// What was answered of a clip, in several lines, the verdict first.
std::string text_of(const json& recorded) {
  return recorded["strategies"][0]["text"].get<std::string>();
}

// Adds every clip of a model file that is longer than one pose. Says the verdicts of the first clips alone:
// the page tells the rest, and what is printed has to fit a screen.
void record_all_clips(const ViewRequest& options, json& header, Sections& sections) {
  if (!options.frames.empty())
    throw InputError("--frames " + options.frames + ": is for one clip; name one with --clip");
  ViewRequest one = options;
  one.model.import.clip.clear();
  one.model.import.survey = true;
  const Input survey = open_input(options.input, one.model);
  one.model.import.survey = false;
  say_what_was_read(survey, stdout);
  const std::vector<scenes::ImportReport::Clip>& clips = survey.import->clips;
  std::size_t frames = 0;
  for (const scenes::ImportReport::Clip& clip : clips) frames += clip.frames;
  require_page_room(frames, survey.mesh.vertex_count(),
                    options.input + ": a page of all " + std::to_string(clips.size()) + " clips,",
                    "by naming one clip with --clip");
  header["clips"] = json::array();
  std::size_t said = 0;
  const auto say = [&](const std::string& line) {
    if (++said <= kMostVerdicts) std::printf("%s\n", line.c_str());
  };
  for (std::size_t c = 0; c < clips.size(); ++c) {
    if (clips[c].frames < 2 && !one.model.import.from_bind_pose) {
      say("clip '" + clips[c].name + "' is one pose; passed over");
      continue;
    }
    one.model.import.clip_number = c;
    sections.set_prefix("c" + std::to_string(header["clips"].size()) + ".");
    json recorded;
    name_input(options.input,
               [&] { recorded = record_clip(one, open_input(options.input, one.model), sections); });
    const std::string text = text_of(recorded);
    say(text.substr(0, text.find('\n')));
    recorded["title"] = clips[c].name.empty() ? "clip " + std::to_string(c) : clips[c].name;
    header["clips"].push_back(std::move(recorded));
  }
  if (said > kMostVerdicts)
    std::printf("and %zu more clips; the page has them, and cscd query says how each ends\n",
                said - kMostVerdicts);
  if (header["clips"].empty())
    throw InputError(options.input + ": has no clip of more than one pose, so nothing moves");
}

}  // namespace

std::string view_page(ViewRequest options) {
  require_viewer();
  require_sound(options);
  for (const std::string& name : options.strategies) require_fit(options.thickness, strategy_named(name));
  if (options.strategies.size() > kMostStrategies)
    throw InputError("--strategy: a page compares up to " + std::to_string(kMostStrategies) +
                     " strategies; name fewer");
  const bool model = is_model_file(options.input);
  options.model.import.one_pose = model;
  json header = {{"schema", "cscd.view/1"},
                 {"name", short_name(options.input)},
                 {"kind", model                           ? "model"
                          : is_point_cache(options.input) ? "cache"
                                                          : "scene"},
                 {"version", version_number()},
                 {"elementary", elementary_test_named(options.elementary).name}};
  Sections sections;
  if (model && options.model.import.clip == kAllClips) {
    record_all_clips(options, header, sections);
  } else {
    Input input = open_input(options.input, options.model);
    say_what_was_read(input, stdout);
    name_input(options.input, [&] { header.update(record_clip(options, std::move(input), sections)); });
    std::printf("%s", text_of(header).c_str());
  }
  return viewer_with(header, sections);
}

namespace {

void view(const ViewOptions& options) {
  OutputFile output(options.output, options.force || is_page_of_viewer(options.output), ".html");
  const std::string page = view_page(options);
  output.commit(page);
  if (!is_standard_output(options.output))
    std::printf("%s: %.1f MB; open it in a browser\n", options.output.c_str(),
                static_cast<double>(page.size()) / 1e6);
}

}  // namespace

void add_view(CLI::App& app) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* command = app.add_subcommand(
      "view",
      "Write one HTML file that shows the surface in motion, and where and when it touches itself.\n\n"
      "  cscd view character.glb                    its first clip that moves\n"
      "  cscd view character.glb --clip all         every clip in one page, with a list to choose from\n"
      "  cscd view octopus --strategy drvbc --strategy drvbc_fast -o octopus.html\n\n"
      "The page needs no network and no server: open it in a browser. It begins at the first contact.\n"
      "Answers are those of cscd query with the same options. Positions are rounded to 65535 steps across "
      "the\n"
      "clip's box for the page; the answers come from the exact ones.");
  add_answer_options(*command, *options);
  command->add_flag(
      "--true-motion", options->model.true_motion,
      "of a model file, show also where the paths on which keys and bones carry the surface touch");
  add_resolution_option(*command, *options);
  command->add_option("--strategy", options->strategies,
                      "culling strategy (cscd list); several, each with its own --strategy, stand side by "
                      "side;\nwithout it, the best that the input allows");
  command
      ->add_option("--up", options->up,
                   "the axis that points up, where the input does not say it or says it wrongly")
      ->check(CLI::IsMember(std::vector<std::string>(scenes::kUpAxes.begin(), scenes::kUpAxes.end())));
  command->add_option("-o,--out", options->output,
                      "the .html file to write; default the input's name with that extension, here");
  command->add_flag("--force", options->force,
                    "replace the output even if it is no page that cscd view wrote");
  command->callback([options] {
    if (options->output.empty())
      options->output = std::filesystem::path(short_name(options->input)).stem().string() + ".html";
    view(*options);
  });
}

}  // namespace cscd::bench
