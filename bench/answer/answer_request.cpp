#include "bench/answer/answer_request.h"

#include "bench/command_line/add_options.h"
#include "bench/inputs/input_options.h"
#include "bench/inputs/thickness.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"

namespace cscd::bench {

void require_sound(const AnswerRequest& request) {
  if (request.resolution.is_given() && !request.model.true_motion)
    throw InputError("--resolution: is for --true-motion; leave it out, or add that");
  if (request.resolution.is_given() && request.resolution.number == 0)
    throw InputError(
        "--resolution 0: what only touches would be looked at without end; give a length above 0");
  const ElementaryTest& elementary = elementary_test_named(request.elementary);
  require_fit(request.thickness, elementary);
  for (const std::string& name : request.strategies) require_fit(request.thickness, strategy_named(name));
  // With --first, the time up to which pairs are looked at has to be right.
  if (request.answers.first && (!elementary.apart_is_proof || !elementary.contact_is_proof))
    throw InputError("--first: elementary test '" + std::string(elementary.name) +
                     "' may be wrong about what touches; choose filtered_exact or exact");
  if (request.new_contacts && request.model.true_motion)
    throw InputError("--new-contacts with --true-motion: is about straight lines; leave out one of the two");
  if (request.new_contacts && request.answers.first)
    throw InputError(
        "--new-contacts with --first: the earliest contact may be an old one, after which --first "
        "looks for no other; leave out one of the two");
  if (!request.preparation.empty() && request.strategies.size() > 1)
    throw InputError("--preparation: is that of one strategy; name one alone with --strategy");
}

namespace {

constexpr char kAnswerGroup[] = "Answers";

}  // namespace

void add_answer_options(CLI::App& command, AnswerRequest& request, bool several_strategies) {
  using A = AnswerRequest;
  static const OptionRow<A> interval[] = {
      required<A>({"input", &A::input, kInputHelp}),
      {"--frames", &A::frames, "A:B, the intervals between frames A and B; default all"}};
  const OptionRow<A> strategies[] = {
      {.name = "--strategy",
       .member = &A::strategies,
       .help = several_strategies
                   ? "culling strategy (cscd list); several, each with its own --strategy, stand side by "
                     "side;\nwithout it, the best that the input allows"
                   : "culling strategy (cscd list); without it, the best that the input allows",
       .repeats = true},
      {"--elementary", &A::elementary, "elementary test (cscd list)"}};
  static const OptionRow<AnswerOptions> answers[] = {
      {"--first", &AnswerOptions::first, "only the contacts of the earliest time of each interval"},
      {"--unproven", &AnswerOptions::unproven, "run the strategy even where its guarantee does not hold"},
      {"--keep-rest-crossings", &AnswerOptions::keep_rest_crossings,
       "count pairs of triangles that cross at rest like all others"}};
  static const OptionRow<A> new_contacts[] = {
      {"--new-contacts", &A::new_contacts,
       "leave out contacts and crossings of pieces that lie in each other when an interval starts: "
       "only what touches anew counts"}};
  static const OptionRow<ModelOptions> true_motion[] = {
      {"--true-motion", &ModelOptions::true_motion,
       "of a model file, ask also about the paths on which keys and bones carry the surface between "
       "frames,\nwith proof"}};
  static const OptionRow<A> others[] = {
      {.name = "--resolution",
       .member = &A::resolution,
       .help =
           "with --true-motion, what comes this near is looked at until it is told whether it touches, or "
           "is too\n"
           "close to tell; a length as for --thickness, default 0.01e. Less takes longer",
       .type = "R"},
      {"--preparation", &A::preparation,
       "file in which what preparing the surface finds out is kept: written if there is none, else read, "
       "which takes a fraction of the time, also where the surface has changed in places since"},
      {"--interval-seconds",
       &A::interval_seconds,
       "seconds after which an interval ends the program; default 60 for model files and moving surfaces, "
       "else none",
       {{0.01, 1e6}}},
      threads_option<A>()};
  add_options<A>(command, interval, request);
  add_options<A>(command, strategies, request, kAnswerGroup);
  if (!several_strategies) command.get_option("--strategy")->expected(1);
  add_options<AnswerOptions>(command, answers, request.answers, kAnswerGroup);
  add_options<A>(command, new_contacts, request, kAnswerGroup);
  add_options(command, ignore_options(), request.ignored, kAnswerGroup);
  add_options(command, thickness_options(), request.thickness, kAnswerGroup);
  add_options<ModelOptions>(command, true_motion, request.model, kAnswerGroup);
  add_options<A>(command, others, request, kAnswerGroup);
  add_model_options(command, request.model);
}

std::string given_answer_option(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    if (option->get_group() == kAnswerGroup && option->count() > 0) return option->get_name();
  return {};
}

}  // namespace cscd::bench
