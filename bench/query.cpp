#include <CLI/App.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/catalogue.h"
#include "bench/command.h"
#include "bench/input.h"
#include "bench/model_options.h"
#include "bench/output.h"
#include "bench/progress.h"
#include "bench/report_json.h"
#include "bench/watchdog.h"
#include "core/base/error.h"
#include "core/detect/embedding.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

struct QueryOptions {
  std::string input, strategy, elementary = "filtered_exact", frames, output;
  bool force = false, unproven = false, first = false;
  std::optional<double> interval_seconds;
  int threads = 1;
  ModelOptions model;
};

json to_json(const Contact& contact, const TriangleMesh& mesh) {
  const auto index = [](VertexId vertex) { return static_cast<int>(vertex); };
  json out;
  if (contact.pair.kind == FeaturePair::Kind::vertex_face) {
    const Triangle& corner = mesh.corners(TriangleId{contact.pair.b});
    out = {{"kind", "vf"},
           {"vertex", contact.pair.a},
           {"triangle", contact.pair.b},
           {"vertices", {contact.pair.a, index(corner[0]), index(corner[1]), index(corner[2])}}};
  } else {
    const Edge &a = mesh.ends(EdgeId{contact.pair.a}), &b = mesh.ends(EdgeId{contact.pair.b});
    out = {{"kind", "ee"}, {"vertices", {index(a[0]), index(a[1]), index(b[0]), index(b[1])}}};
  }
  out["time"] = contact.time;
  return out;
}

// `collides` and `time` speak of decided contacts; with nothing but undecided pairs the answer is unknown:
// null.
json to_json(const ContactSet& found, const TriangleMesh& mesh) {
  json contacts = json::array(), undecided = json::array();
  json time;
  for (const Contact& contact : found.contacts) {
    const bool decided = contact.verdict == Verdict::contact;
    if (decided && time.is_null()) time = contact.time;
    (decided ? contacts : undecided).push_back(to_json(contact, mesh));
  }
  json collides = !contacts.empty();
  if (contacts.empty() && !undecided.empty()) collides = nullptr;
  return {{"collides", collides}, {"time", time}, {"contacts", contacts}, {"undecided", undecided}};
}

// Of one interval, where nothing else was asked for: a model file is not trusted to end, what was made for
// this program is.
constexpr double kModelIntervalSeconds = 60;

// The time up to which pairs are looked at has to be right.
void require_right_times(const ElementaryTest& elementary) {
  if (!elementary.apart_is_proof || !elementary.contact_is_proof)
    throw InputError("--first: elementary test '" + std::string(elementary.name) +
                     "' may be wrong about what touches; choose filtered_exact or exact");
}

Prepared make_detector(const Strategy& strategy, const Setup& setup, bool first) {
  Prepared prepared = strategy.make(setup);
  if (first && !prepared.detector->look_for_first_only())
    throw InputError("--first: strategy " + std::string(strategy.name) +
                     " tests pairs by itself and finds all; leave one of the two out");
  return prepared;
}

void query(const QueryOptions& options) {
  const ElementaryTest& elementary = elementary_test_named(options.elementary);
  if (options.first) require_right_times(elementary);
  const Strategy* strategy = options.strategy.empty() ? nullptr : &strategy_named(options.strategy);
  OutputFile output(options.output, options.force);

  Input input = open_input(options.input, options.model);
  input.threads = options.threads;
  if (strategy == nullptr) strategy = &default_strategy(input);
  const IntervalRange range = parse_frames(options.frames, input.clip->frame_count());
  const double patience = options.interval_seconds.value_or(input.import ? kModelIntervalSeconds : 0);
  Watchdog watchdog(patience, "cscd: " + options.input +
                                  ": an interval, or the preparation, took more than " +
                                  json(patience).dump() + " s; raise --interval-seconds to wait longer");
  const Setup setup = input.setup(elementary);
  const Prepared prepared = make_detector(*strategy, setup, options.first);
  const int threads = prepared.preparation.threads;
  const bool may_fall_back = strategy->guarantee == Guarantee::first_contact && !options.unproven;
  std::unique_ptr<Detector> fallback;  // made when it is first needed

  EmbeddingTest embedding(input.mesh, input.reference);
  Progress progress("query " + options.input, range.last - range.first);
  ContactSet found;
  json intervals = json::array();
  std::size_t colliding = 0, not_embedded = 0;
  for (std::size_t i = range.first; i < range.last; ++i) {
    watchdog.restart();
    const scenes::ClipInterval interval = input.clip->load(i);
    const bool embedded = embedding.embedded(interval.motion.start());
    const bool fall_back = may_fall_back && !embedded;
    if (fall_back && !fallback) fallback = make_detector(complete_stand_in(), setup, options.first).detector;
    Detector& used = fall_back ? *fallback : *prepared.detector;
    const Report report = used.detect(interval.motion, interval.bones ? &*interval.bones : nullptr, found);
    found.sort();
    if (options.first) keep_first(found);

    json entry = to_json(found, input.mesh);
    entry["index"] = i;
    entry["starts_embedded"] = embedded;
    entry["strategy"] = fall_back ? complete_stand_in().name : strategy->name;
    entry["proven"] =
        elementary.apart_is_proof && (fall_back || strategy->guarantee == Guarantee::complete ||
                                      (embedded && strategy->guarantee == Guarantee::first_contact));
    entry["counts"] = counts_json(report);
    entry["ms"] = milliseconds_json(report.ms);
    colliding += !entry["contacts"].empty();
    not_embedded += !embedded;
    intervals.push_back(std::move(entry));
    progress.advance();
  }

  watchdog.restart();
  json document = {{"schema", "cscd.query/1"},         {"input", options.input},
                   {"strategy", strategy->name},       {"guarantee", to_string(strategy->guarantee)},
                   {"elementary", elementary.name},    {"threads", threads},
                   {"intervals", std::move(intervals)}};
  if (options.first) document["first_only"] = true;
  if (input.import) document["import"] = import_json(*input.import);
  output.commit(document.dump(1) + "\n");
  std::printf(
      "%s: %zu intervals, %zu with contacts, %zu with a start that is not embedded (strategy %s on %d "
      "thread%s, elementary test %s)\n",
      options.input.c_str(), range.last - range.first, colliding, not_embedded,
      std::string(strategy->name).c_str(), threads, threads == 1 ? "" : "s",
      std::string(elementary.name).c_str());
}

}  // namespace

void add_query(CLI::App& app) {
  auto options = std::make_shared<QueryOptions>();
  CLI::App* command =
      app.add_subcommand("query",
                         "Find where and when a mesh first touches itself in each interval of a clip.\n\n"
                         "  cscd query rope --json rope.json\n"
                         "  cscd query character.h5 --strategy base --frames 0:10 --json out.json\n"
                         "  cscd query character.glb --clip walk --json out.json\n\n"
                         "Where a start is not embedded, the guarantee first_contact is void, and the "
                         "fastest complete strategy\n"
                         "answers that interval instead (--unproven: do not). Whoever wants the earliest "
                         "contact and no later ones\n"
                         "has it sooner with --first.");
  command->add_option("input", options->input, kInputHelp)->required();
  command->add_option("--strategy", options->strategy,
                      "culling strategy (cscd list); without it, the best that the input allows");
  command->add_option("--elementary", options->elementary, "elementary test (cscd list)")
      ->capture_default_str();
  command->add_option("--frames", options->frames, "A:B, the intervals between frames A and B; default all");
  command->add_option("--json", options->output, "where the answer goes")->required();
  command->add_flag("--force", options->force, "replace the output if it exists");
  command->add_flag("--first", options->first, "only the contacts of the earliest time of each interval");
  command->add_flag("--unproven", options->unproven, "run the strategy even where its guarantee is void");
  command
      ->add_option("--interval-seconds", options->interval_seconds,
                   "seconds after which an interval is given up; default 60 for model files, else none")
      ->check(CLI::Range(0.01, 1e6));
  add_threads_option(*command, options->threads);
  add_model_options(*command, options->model);
  command->callback([options] { query(*options); });
}

}  // namespace cscd::bench
