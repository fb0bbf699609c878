#include "bench/answer/options/answer_options.h"

#include "bench/answer/options/model_options.h"

namespace cscd::bench {
namespace {

constexpr char kAnswerGroup[] = "Answers";

// An option that is a length; `take` gets it.
template <class Take>
void add_length(CLI::App& command, const std::string& name, const Take& take, const std::string& help) {
  command
      .add_option_function<std::string>(
          name, [name, take](const std::string& text) { take(parse_length(name, text)); }, help)
      ->type_name("R");
}

}  // namespace

void add_answer_options(CLI::App& command, AnswerRequest& request, bool several_strategies) {
  command.add_option("input", request.input, kInputHelp)->required();
  command.add_option("--frames", request.frames, "A:B, the intervals between frames A and B; default all");
  CLI::OptionDefaults& defaults = *command.option_defaults();
  const std::string group_of_others = defaults.get_group();
  defaults.group(kAnswerGroup);
  CLI::Option* const strategy = command.add_option(
      "--strategy", request.strategies,
      several_strategies
          ? "culling strategy (cscd list); several, each with its own --strategy, stand side by "
            "side;\nwithout it, the best that the input allows"
          : "culling strategy (cscd list); without it, the best that the input allows");
  strategy->allow_extra_args(false);
  if (!several_strategies) strategy->expected(1);
  command.add_option("--elementary", request.elementary, "elementary test (cscd list)")
      ->capture_default_str();
  command.add_flag("--first", request.answers.first,
                   "only the contacts of the earliest time of each interval");
  command.add_flag("--unproven", request.answers.unproven,
                   "run the strategy even where its guarantee is void");
  command.add_flag("--keep-rest-crossings", request.answers.keep_rest_crossings,
                   "count pairs of triangles that cross at rest like all others");
  command.add_flag(
      "--new-contacts", request.new_contacts,
      "leave out contacts and crossings of pieces that lie in each other when an interval starts: "
      "only what touches anew counts");
  add_ignore_options(command, request.ignored);
  add_thickness_options(command, request.thickness);
  command.add_flag(
      "--true-motion", request.model.true_motion,
      "of a model file, ask also about the paths on which keys and bones carry the surface between "
      "frames,\nwith proof");
  add_length(
      command, "--resolution", [&request](const WrittenLength& length) { request.resolution = length; },
      "with --true-motion, what comes this near is looked at until it is told whether it touches, or is too\n"
      "close to tell; a length as for --thickness, default 0.01e. Less takes longer");
  command.add_option(
      "--preparation", request.preparation,
      "file in which what preparing the surface finds out is kept: written if there is none, else read, "
      "which takes a fraction of the time, also where the surface has changed in places since");
  command
      .add_option("--interval-seconds", request.interval_seconds,
                  "seconds after which an interval ends the program; default 60 for model files, else none")
      ->check(CLI::Range(0.01, 1e6));
  add_threads_option(command, request.threads);
  defaults.group(group_of_others);
  add_model_options(command, request.model);
}

std::string given_answer_option(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    if (option->get_group() == kAnswerGroup && option->count() > 0) return option->get_name();
  return {};
}

void add_ignore_options(CLI::App& command, IgnoreRequest& request) {
  command
      .add_option(
          "--ignore", request.pairs,
          "A:B, two bones, parts or meshes whose contacts and crossings with each other do not count;\n"
          "* in a name stands for any letters, and A:* is A and everything; may be given several times")
      ->allow_extra_args(false)
      ->type_name("A:B");
  command
      .add_option("--ignore-neighbours", request.neighbours,
                  "ignore bones that are at most so many joints apart, such as both sides of a knee with 1")
      ->check(CLI::Range(0, 1000));
}

void add_thickness_option(CLI::App& command, ThicknessRequest& request) {
  add_length(
      command, "--thickness", [&request](const WrittenLength& length) { request.thickness = length; },
      "what comes this near counts: a length such as 0.01, or 0.2e for mean edges of the pose at rest");
}

void add_thickness_options(CLI::App& command, ThicknessRequest& request) {
  add_thickness_option(command, request);
  command
      .add_option(
          "--exclude-rings", request.rings,
          "vertices that at most so many edges join do not collide; a pair of features is left out if\n"
          "all its vertices are so near")
      ->check(CLI::Range(0, 1000));
  add_length(
      command, "--exclude-near-rest", [&request](const WrittenLength& length) { request.near_rest = length; },
      "nor do vertices that are nearer than this at rest; a length as for --thickness");
}

}  // namespace cscd::bench
