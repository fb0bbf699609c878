#include <CLI/App.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/answer/answer.h"
#include "bench/answer/answer_json.h"
#include "bench/answer/surface_names.h"
#include "bench/command_line/version.h"
#include "bench/commands/command.h"
#include "bench/commands/view_page.h"
#include "bench/input/input.h"
#include "bench/options/answer_options.h"
#include "bench/output/output.h"
#include "bench/output/progress.h"
#include "bench/rows/catalogue.h"
#include "bench/view/clip_recording.h"
#include "bench/view/html.h"
#include "bench/view/recording.h"
#include "core/base/error.h"
#include "scenes/catalog/scene.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

constexpr std::size_t kMostStrategies = 6;  // side by side; more could not be told apart

struct ViewOptions : ViewRequest {
  std::string output;
  bool force = false;
};

std::vector<const Strategy*> chosen_strategies(const ViewRequest& options, const Input& input) {
  if (options.strategies.empty()) return {&default_strategy(input)};
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

// The axis against which things fall, such as "z" or "-y"; none where no effect of the scene has gravity.
std::optional<std::string> up_of(const scenes::Scene& scene) {
  for (const scenes::EffectCall& effect : scene.effects) {
    if (!effect.parameters.has("gravity")) continue;
    const Vec3 gravity = effect.parameters.vector("gravity");
    int axis = 0;
    if (gravity.cwiseAbs().maxCoeff(&axis) == 0) continue;
    return std::string(gravity[axis] < 0 ? "" : "-") + "xyz"[axis];
  }
  return std::nullopt;
}

struct Contestant {
  Answerer answerer;
  StrategyRecording recording;
};

}  // namespace

std::string view_page(const ViewRequest& options) {
  require_viewer();
  require_sound(options);
  for (const std::string& name : options.strategies) strategy_named(name);
  if (options.strategies.size() > kMostStrategies)
    throw InputError("--strategy: a page compares up to " + std::to_string(kMostStrategies) +
                     " strategies; name fewer");

  Input input = open_input(options.input, options.model);
  input.threads = options.threads;
  input.use_bones = !options.strategies.empty();  // as for a query
  const ElementaryTest& elementary = elementary_test_named(options.elementary);
  const std::vector<const Strategy*> strategies = chosen_strategies(options, input);
  if (options.strategies.empty() && strategies[0]->needs.bones) input.use_bones = true;
  const IntervalRange range = parse_frames(options.frames, input.clip->frame_count());
  const SurfaceNames names(input);
  TextTable texts;
  Sections sections;
  const std::vector<std::uint16_t> places = places_of_triangles(input.mesh, names, texts, false);
  const std::vector<std::uint16_t> parts = places_of_triangles(input.mesh, names, texts, true);
  sections.add("place", std::span<const std::uint16_t>(places));
  sections.add("part", std::span<const std::uint16_t>(parts));

  Watchdog watchdog = watchdog_of(options, input);
  ClipRecording clip(input, range);
  std::vector<std::unique_ptr<Contestant>> contestants;
  for (const Strategy* strategy : strategies) {
    watchdog.restart();
    contestants.emplace_back(
        new Contestant{Answerer(input, *strategy, elementary, options.answers),
                       StrategyRecording(input, names, *strategy, elementary, clip.grid())});
  }
  {
    Progress progress("view " + options.input, range.last - range.first);
    for (std::size_t i = range.first; i < range.last; ++i) {
      clip.add_frame(input.clip->load_frame(i));
      bool touches = false;
      for (const auto& contestant : contestants) {
        watchdog.restart();
        const IntervalAnswer answer = contestant->answerer.answer(i);
        contestant->recording.add(answer, input.clip->load(i), texts);
        touches = touches || !answer.found.contacts.empty();
      }
      if (touches && input.clip->header().predicted) clip.add_predicted_end(input.clip->load(i).motion.end());
      progress.advance();
    }
    clip.add_frame(input.clip->load_frame(range.last));
  }
  watchdog.restart();

  const bool left_out = !options.answers.keep_rest_crossings;
  say_what_was_read(input, stdout);
  json rows = json::array();
  for (std::size_t s = 0; s < contestants.size(); ++s) {
    Contestant& contestant = *contestants[s];
    contestant.recording.set_preparation(contestant.answerer.preparation_ms());
    rows.push_back(contestant.recording.write(sections, "s" + std::to_string(s) + ".",
                                              contestant.answerer.rest_crossings(), left_out));
  }
  const Contestant& first = *contestants.front();
  std::printf("%s\n%s", options.input.c_str(), rows[0]["text"].get<std::string>().c_str());
  json header = {{"schema", "cscd.view/1"},
                 {"name", std::filesystem::path(options.input).filename().string()},
                 {"kind", input.import                    ? "model"
                          : is_point_cache(options.input) ? "cache"
                                                          : "scene"},
                 {"version", version_number()},
                 {"elementary", elementary.name},
                 {"clip", clip.write(sections)},
                 {"texts", texts.texts()},
                 {"rest", rest_json(input, names, first.answerer.rest_crossings(), left_out)},
                 {"strategies", std::move(rows)}};
  if (input.import) header["import"] = import_json(*input.import);
  if (header["kind"] == "scene")
    if (const auto up = up_of(scenes::load_scene(options.input))) header["up"] = *up;
  return viewer_with(header, sections);
}

namespace {

void view(const ViewOptions& options) {
  OutputFile output(options.output, options.force, ".html");
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
      "  cscd view character.glb\n"
      "  cscd view octopus --strategy drvbc --strategy drvbc_fast -o octopus.html\n\n"
      "The page needs no network and no server: open it in a browser. It begins at the first contact.\n"
      "Answers are those of cscd query with the same options. Positions are rounded to 65535 steps across "
      "the\n"
      "clip's box for the page; the answers come from the exact ones.");
  add_answer_options(*command, *options);
  command->add_option("--strategy", options->strategies,
                      "culling strategy (cscd list); several, each with its own --strategy, stand side by "
                      "side;\nwithout it, the best that the input allows");
  command->add_option("-o,--out", options->output,
                      "the .html file to write; default the input's name with that extension, here");
  command->add_flag("--force", options->force, "replace the output if it exists");
  command->callback([options] {
    if (options->output.empty())
      options->output = std::filesystem::path(options->input).stem().string() + ".html";
    view(*options);
  });
}

}  // namespace cscd::bench
