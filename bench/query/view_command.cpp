#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/answer/answer_json.h"
#include "bench/answer/answer_request.h"
#include "bench/answer/clip_answerer.h"
#include "bench/command_line/add_options.h"
#include "bench/command_line/command.h"
#include "bench/command_line/usage.h"
#include "bench/inputs/input.h"
#include "bench/output/output.h"
#include "bench/query/view/clip_recording.h"
#include "bench/query/view/engine_recording.h"
#include "bench/query/view/html.h"
#include "bench/query/view/overlap_recording.h"
#include "bench/query/view/recording.h"
#include "bench/query/view/viewer_page.h"
#include "bench/query/view_page.h"
#include "bench/strategies/catalogue.h"
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

// What the page has to know of an interval's true motion.
json true_moment(const Input& input, const SurfaceNames& names, const IntervalAnswer& answer,
                 std::size_t first) {
  const TrueAnswer& own = *answer.motion;
  json out = true_motion_json(input, answer);
  out["interval"] = answer.index - first;
  out["at"] = out[own.parts_again ? "from" : "to"];
  std::string text = "true motion: " + std::string(to_string(own.verdict));
  if (own.pair)
    text = "true motion: " +
           meeting_text({names.place_of(own.pair->first), names.place_of(own.pair->second)}, own.verdict);
  const bool lines = answer.verdict != IntervalVerdict::clear;
  if (differs(answer)) text += lines ? ", where straight lines touch" : ", where straight lines do not";
  out["text"] = std::move(text);
  return out;
}

// What require_page_room() adds for the positions that the page's engine answers.
std::size_t engine_bytes(const ViewRequest& options, const Input& input) {
  return options.with_engine ? EngineRecording::page_bytes(input.clip->header().predicted) : 0;
}

// Answers one clip, adds its arrays to `sections`, and returns what a page has to know of it.
json record_clip(const ViewRequest& options, Input opened, Sections& sections) {
  ClipAnswerer asked(options, std::move(opened));
  const Input& input = asked.input();
  const SurfaceNames& names = asked.names();
  TextTable texts;
  const std::vector<std::uint16_t> places = places_of_triangles(input.mesh, names, texts, false);
  const std::vector<std::uint16_t> parts = places_of_triangles(input.mesh, names, texts, true);
  sections.add("place", places);
  sections.add("part", parts);

  ClipRecording clip(input, asked.range(), engine_bytes(options, input));
  EngineRecording engine(asked.answers().front());
  std::vector<StrategyRecording> recordings;
  for (const ClipAnswer& answer : asked.answers()) recordings.emplace_back(answer, clip.grid());
  OverlapRecording overlaps;
  json true_moments = json::array();
  const auto record_motion = [&](const IntervalAnswer& answer) {
    const TrueAnswer& motion = *answer.motion;
    if (motion.verdict != IntervalVerdict::clear || differs(answer))
      true_moments.push_back(true_moment(input, names, answer, asked.range().first));
    if (motion.pair && differs(answer) && answer.found.contacts.empty())
      clip.add_other_end(asked.true_positions_at(motion.parts_again ? motion.from : motion.to));
  };
  asked.answer_all("view " + options.input, true, [&](const AnsweredPose& pose) {
    clip.add_frame(pose.interval);
    if (options.with_engine) {
      const bool is_predicted = input.clip->header().predicted && !pose.is_last();
      engine.add(pose.interval.motion.start(),
                 is_predicted ? pose.interval.motion.end() : std::span<const Vec3>());
    }
    if (pose.is_last()) return;
    overlaps.add(pose.here, pose.interval.motion.start());
    for (std::size_t s = 0; s < recordings.size(); ++s)
      recordings[s].add(pose.answers[s], pose.interval, texts);
    if (input.motion) record_motion(pose.answers.front());
    const bool touches = std::ranges::any_of(
        pose.answers, [](const IntervalAnswer& answer) { return !answer.found.contacts.empty(); });
    if (touches && input.clip->header().predicted) clip.add_other_end(pose.interval.motion.end());
  });

  overlaps.write(sections);
  const Up up = options.up.empty() ? input.up : Up{options.up, "--up says so"};
  json rows = json::array();
  for (std::size_t s = 0; s < recordings.size(); ++s)
    rows.push_back(recordings[s].write(sections, "s" + std::to_string(s) + "."));
  const ClipAnswer& first = asked.answers().front();
  json header = {{"up", {{"axis", up.axis}, {"because", up.because}}},
                 {"engine_colours", !options.strategies.empty()},
                 {"thickness", input.thickness.asked.thickness.text},
                 {"clip", clip.write(sections)},
                 {"texts", texts.texts()},
                 {"events", event_lines(first)},
                 {"true_motion", input.motion ? std::move(true_moments) : json()},
                 {"rest", rest_json(first)},
                 {"strategies", std::move(rows)}};
  if (input.import) header["import"] = import_json(*input.import);
  if (options.with_engine) header["engine"] = engine.write(sections, options);
  return header;
}

// What was answered of a clip, in several lines, the verdict first.
std::string text_of(const json& recorded) {
  return recorded["strategies"][0]["text"].get<std::string>();
}

// Adds every clip of a model file. Says the verdicts of the first clips alone: the page tells the rest, and
// what is printed has to fit a screen.
void record_all_clips(const ViewRequest& options, json& header, Sections& sections) {
  ModelOptions model = options.model;
  model.import.clip.clear();
  model.import.survey = true;
  Input survey = open_input(options.input, model);
  say_what_was_read(survey, stdout);
  const std::vector<scenes::ImportReport::Clip> clips = survey.import->clips;
  std::size_t frames = 0;
  for (const scenes::ImportReport::Clip& clip : clips) frames += clip.frames;
  require_page_room(frames, survey.mesh.vertex_count(), engine_bytes(options, survey),
                    options.input + ": a page of all " + std::to_string(clips.size()) + " clips,",
                    "by naming one clip with --clip");
  header["clips"] = json::array();
  std::size_t said = 0;
  const auto say = [&](const std::string& line) {
    if (++said <= kMostVerdicts) std::printf("%s\n", line.c_str());
  };
  const auto take = [&](std::size_t c, Input input) {
    sections.set_prefix("c" + std::to_string(header["clips"].size()) + ".");
    json recorded = record_clip(options, std::move(input), sections);
    const std::string text = text_of(recorded);
    say(text.substr(0, text.find('\n')));
    recorded["title"] = clips[c].name.empty() ? "clip " + std::to_string(c) : clips[c].name;
    header["clips"].push_back(std::move(recorded));
  };
  for_each_clip(options, std::move(survey), take,
                [&](std::size_t c) { say("clip '" + clips[c].name + "' is one pose; passed over"); });
  if (said > kMostVerdicts)
    std::printf("and %zu more clips; the page has them, and cscd query says how each ends\n",
                said - kMostVerdicts);
}

}  // namespace

std::string view_page(ViewRequest options) {
  require_viewer();
  require_sound(options);
  if (options.with_engine) require_page_answers(options);
  const std::string with_engine = options.with_engine ? engine_page(version_number()) : std::string();
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
  return viewer_with(options.with_engine ? with_engine : viewer_page(), header, sections);
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
      "The page needs no network and no server: open it in a browser. It begins where something lies "
      "deepest,\n"
      "or else at the first contact.\n"
      "Answers are those of cscd query with the same options. Positions are rounded to 65535 steps across\n"
      "the clip's box for the page; the answers come from the exact ones.");
  add_answer_options(*command, *options, true);
  const OptionRow<ViewOptions> rows[] = {
      {.name = "--up",
       .member = &ViewOptions::up,
       .help = "the axis that points up, where the input does not say it or says it wrongly",
       .choices = {scenes::kUpAxes.begin(), scenes::kUpAxes.end()}},
      {"-o,--out", &ViewOptions::output,
       "the .html file to write; default the input's name with that extension, here"},
      {"--with-engine", &ViewOptions::with_engine,
       "the page holds the engine, too, and answers again with another thickness or with pairs "
       "ignored;\n`scripts/check wasm` makes what that needs"},
      {"--force", &ViewOptions::force, "replace the output even if it is no page that cscd view wrote"}};
  add_options<ViewOptions>(*command, rows, *options);
  command->callback([options] {
    if (options->output.empty())
      options->output = std::filesystem::path(short_name(options->input)).stem().string() + ".html";
    view(*options);
  });
}

}  // namespace cscd::bench
