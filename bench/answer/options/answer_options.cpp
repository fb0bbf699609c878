#include "bench/answer/options/answer_options.h"

#include <nlohmann/json.hpp>

#include "bench/inputs/thickness.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

// The seconds that one interval of a model file may take, unless the user sets a limit. Scenes and point
// caches were made for this program and have no limit.
constexpr double kModelIntervalSeconds = 60;

}  // namespace

void add_answer_options(CLI::App& command, AnswerRequest& request) {
  command.add_option("input", request.input, kInputHelp)->required();
  command.add_option("--elementary", request.elementary, "elementary test (cscd list)")
      ->capture_default_str();
  command.add_option("--frames", request.frames, "A:B, the intervals between frames A and B; default all");
  command.add_flag("--first", request.answers.first,
                   "only the contacts of the earliest time of each interval");
  command.add_flag("--unproven", request.answers.unproven,
                   "run the strategy even where its guarantee is void");
  command.add_flag("--keep-rest-crossings", request.answers.keep_rest_crossings,
                   "count pairs of triangles that cross at rest like all others");
  command
      .add_option("--interval-seconds", request.interval_seconds,
                  "seconds after which an interval ends the program; default 60 for model files, else none")
      ->check(CLI::Range(0.01, 1e6));
  add_ignore_options(command, request.ignored);
  add_thickness_options(command, request.thickness);
  add_threads_option(command, request.threads);
  add_model_options(command, request.model);
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
  command
      .add_option_function<std::string>(
          "--thickness",
          [&request](const std::string& text) { request.thickness = parse_length("--thickness", text); },
          "what comes this near counts: a length such as 0.01, or 0.2e for mean edges of the pose at rest")
      ->type_name("R");
}

void add_thickness_options(CLI::App& command, ThicknessRequest& request) {
  add_thickness_option(command, request);
  command
      .add_option(
          "--exclude-rings", request.rings,
          "vertices that at most so many edges join do not collide; a pair of features is left out if\n"
          "all its vertices are so near")
      ->check(CLI::Range(0, 1000));
  command
      .add_option_function<std::string>(
          "--exclude-near-rest",
          [&request](const std::string& text) {
            request.near_rest = parse_length("--exclude-near-rest", text);
          },
          "nor do vertices that are nearer than this at rest; a length as for --thickness")
      ->type_name("R");
}

void add_resolution_option(CLI::App& command, AnswerRequest& request) {
  command
      .add_option_function<std::string>(
          "--resolution",
          [&request](const std::string& text) { request.resolution = parse_length("--resolution", text); },
          "with --true-motion, what comes this near is looked at until it is told whether it touches, or is "
          "too\n"
          "close to tell; a length as for --thickness, default 0.01e. Less takes longer")
      ->type_name("R");
}

void require_sound(const AnswerRequest& request) {
  if (request.resolution && !request.model.true_motion)
    throw InputError("--resolution: is for --true-motion; leave it out, or add that");
  if (request.resolution && request.resolution->number == 0)
    throw InputError(
        "--resolution 0: what only touches would be looked at without end; give a length above 0");
  const ElementaryTest& elementary = elementary_test_named(request.elementary);
  require_fit(request.thickness, elementary);
  // With --first, the time up to which pairs are looked at has to be right.
  if (request.answers.first && (!elementary.apart_is_proof || !elementary.contact_is_proof))
    throw InputError("--first: elementary test '" + std::string(elementary.name) +
                     "' may be wrong about what touches; choose filtered_exact or exact");
}

Watchdog watchdog_of(const AnswerRequest& request, const Input& input) {
  const double patience = request.interval_seconds.value_or(input.import ? kModelIntervalSeconds : 0);
  return Watchdog(patience, "cscd: " + request.input + ": an interval, or the preparation, took more than " +
                                nlohmann::json(patience).dump() +
                                " s; raise --interval-seconds to wait longer");
}

}  // namespace cscd::bench
