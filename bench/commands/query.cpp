#include <CLI/App.hpp>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <sys/stat.h>
#include <unistd.h>

#include "bench/answer/answer.h"
#include "bench/answer/answer_json.h"
#include "bench/answer/answer_summary.h"
#include "bench/commands/command.h"
#include "bench/input/input.h"
#include "bench/options/answer_options.h"
#include "bench/output/output.h"
#include "bench/output/progress.h"
#include "bench/rows/catalogue.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

constexpr std::size_t kStartPairs = 1000;  // listed of an interval, unless all are asked for

struct QueryOptions : AnswerRequest {
  std::string strategy, output, start_pairs, preparation;
  bool force = false, fail_on_contact = false;
};

// Returns what an earlier run left in the file; nothing if there is no such file yet.
std::vector<std::byte> read_preparation(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (file.bad()) throw InputError("--preparation " + path + ": cannot be read");
  const auto bytes = std::as_bytes(std::span(text));
  if (bytes.empty()) throw InputError("--preparation " + path + ": is empty; remove it");
  return {bytes.begin(), bytes.end()};
}

void write_preparation(const std::string& path, std::span<const std::byte> bytes, const Strategy& strategy) {
  if (bytes.empty())
    throw InputError("--preparation " + path + ": strategy " + std::string(strategy.name) +
                     " has no preparation worth keeping; leave the option out");
  OutputFile(path, false, ".preparation").commit({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::size_t most_start_pairs(const std::string& text) {
  if (text.empty()) return kStartPairs;
  if (text == "all") return std::numeric_limits<std::size_t>::max();
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc{} || end != text.data() + text.size())
    throw InputError("--start-pairs " + text + ": is neither a number nor all; give one of the two");
  return count;
}

// A program that reads standard output gets JSON there, like one that asks for `--json -`.
bool standard_output_is_read_by_a_program() {
  struct stat facts {};
  return fstat(STDOUT_FILENO, &facts) == 0 && (S_ISFIFO(facts.st_mode) || S_ISSOCK(facts.st_mode));
}

struct ClipAnswer {
  json document;  // null unless it was asked for
  bool collides = false;
};

ClipAnswer answer_clip(const QueryOptions& options, Input input, bool with_json) {
  const ElementaryTest& elementary = elementary_test_named(options.elementary);
  input.threads = options.threads;
  const Strategy& strategy =
      options.strategy.empty() ? default_strategy(input) : strategy_named(options.strategy);
  // Bones spare the default strategy a little work in every interval, and preparing for them takes longer
  // than they spare in a clip of some hundred frames.
  input.use_bones = !options.strategy.empty() || strategy.needs.bones;
  const IntervalRange range = parse_frames(options.frames, input.clip->frame_count());
  const std::size_t listed_pairs = most_start_pairs(options.start_pairs);
  Watchdog watchdog = watchdog_of(options, input);
  if (!options.preparation.empty()) input.preparation = read_preparation(options.preparation);
  Answerer answerer(input, strategy, elementary, options.answers);
  if (!options.preparation.empty() && input.preparation.empty())
    write_preparation(options.preparation, answerer.saved_preparation(), strategy);
  const SurfaceNames names(input);
  AnswerSummary summary;
  summary.preparation_ms = answerer.preparation_ms();
  json intervals = json::array();
  {
    Progress progress("query " + options.input, range.last - range.first);
    for (std::size_t i = range.first; i < range.last; ++i) {
      watchdog.restart();
      const IntervalAnswer answer = answerer.answer(i);
      summary.add(answer, names);
      if (with_json)
        intervals.push_back(interval_json(input, names, answer, input.clip->load(i).motion, listed_pairs));
      progress.advance();
    }
  }
  watchdog.restart();
  const bool left_out = !options.answers.keep_rest_crossings;
  say_what_was_read(input, stdout);
  if (!input.import) std::printf("%s\n", options.input.c_str());
  if (answerer.new_triangles() > 0)
    std::printf("preparation %s: %zu of %zu triangles are new since it was kept, and were prepared now\n",
                options.preparation.c_str(), answerer.new_triangles(), input.mesh.triangle_count());
  std::printf("%s", summary_text(input, names, summary, answerer.rest_crossings(), left_out).c_str());

  ClipAnswer result{nullptr, summary.collides()};
  if (!with_json) return result;
  result.document = {{"schema", "cscd.query/2"},
                     {"input", options.input},
                     {"strategy", strategy.name},
                     {"guarantee", to_string(strategy.guarantee)},
                     {"elementary", elementary.name},
                     {"threads", answerer.threads()},
                     {"first_only", options.answers.first},
                     {"rest_crossings", rest_json(input, names, answerer.rest_crossings(), left_out)},
                     {"summary", summary_json(input, summary)},
                     {"intervals", std::move(intervals)}};
  if (input.import) result.document["import"] = import_json(*input.import);
  return result;
}

// The clips of a model file, one after the other. A clip of one pose moves nothing and is passed over.
ClipAnswer answer_all_clips(QueryOptions options, bool with_json) {
  options.model.import.clip.clear();
  ModelOptions survey = options.model;
  survey.import.survey = true;
  const scenes::ImportReport seen = *open_input(options.input, survey).import;
  ClipAnswer all{{{"schema", "cscd.query/2"}, {"input", options.input}, {"clips", json::array()}}, false};
  all.document["import"] = import_json(seen);
  std::size_t answered = 0;
  for (std::size_t clip = 0; clip < seen.clips.size(); ++clip) {
    if (seen.clips[clip].frames < 2 && !options.model.import.from_bind_pose) {
      std::printf("%s: clip %zu '%s' is one pose; passed over\n", options.input.c_str(), clip,
                  seen.clips[clip].name.c_str());
      continue;
    }
    options.model.import.clip_number = clip;
    ClipAnswer one = answer_clip(options, open_input(options.input, options.model), with_json);
    all.collides = all.collides || one.collides;
    if (with_json) all.document["clips"].push_back(std::move(one.document));
    ++answered;
  }
  if (answered == 0)
    throw InputError(options.input +
                     ": has no clip of more than one pose, so nothing moves; pass "
                     "--from-bind-pose to move from the bind pose to one of them");
  return all;
}

void query(QueryOptions options) {
  require_sound(options);
  if (!options.strategy.empty()) strategy_named(options.strategy);
  most_start_pairs(options.start_pairs);
  if (options.output.empty() && standard_output_is_read_by_a_program()) options.output = "-";
  std::optional<OutputFile> output;
  if (!options.output.empty()) output.emplace(options.output, options.force);

  const bool all_clips = options.model.import.clip == kAllClips && is_model_file(options.input);
  const ClipAnswer answer =
      all_clips ? answer_all_clips(options, output.has_value())
                : answer_clip(options, open_input(options.input, options.model), output.has_value());
  if (output) {
    // Names of files and their text may hold anything: what is no UTF-8 is replaced.
    output->commit(answer.document.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
  }
  if (options.fail_on_contact && answer.collides) throw kContactFound;
}

}  // namespace

void add_query(CLI::App& app) {
  auto options = std::make_shared<QueryOptions>();
  CLI::App* command = app.add_subcommand(
      "query",
      "Find where and when a mesh first touches itself in each interval of a clip.\n\n"
      "  cscd query rope\n"
      "  cscd query character.glb --clip walk\n"
      "  cscd query character.h5 --strategy base --frames 0:10 --json answer.json\n"
      "  cscd query character.glb --clip all --fail-on-contact --json - | jq .clips[].summary\n\n"
      "Prints what a person wants to know. A program that reads standard output gets the whole answer as "
      "JSON\n"
      "there (schema cscd.query/2), like one that asks for --json -.\n\n"
      "Each interval is clear, touches, or intersects_at_start. What crosses at rest (eyes in sockets, "
      "clothes\n"
      "in skin) is how a character is made: pairs of triangles that cross in the bind pose, or in frame 0 of "
      "a\n"
      "point cache, are named once and left out, unless --keep-rest-crossings.\n\n"
      "Where a start is not embedded, the guarantee first_contact is void, and the fastest complete "
      "strategy\n"
      "answers that interval instead (--unproven: do not). Whoever wants the earliest contact and no later "
      "ones\n"
      "has it sooner with --first.");
  add_answer_options(*command, *options);
  command->add_option("--strategy", options->strategy,
                      "culling strategy (cscd list); without it, the best that the input allows");
  command->add_option(
      "--preparation", options->preparation,
      "file in which what preparing the surface finds out is kept: written if there is none, else read, "
      "which takes a fraction of the time, also where the surface has changed in places since");
  command->add_option("--json", options->output, "where the whole answer goes; - is standard output");
  command->add_flag("--force", options->force, "replace the output if it exists");
  command->add_option(
      "--start-pairs", options->start_pairs,
      "how many of the pairs of triangles that cross at a start are listed, or all; default 1000");
  command->add_flag("--fail-on-contact", options->fail_on_contact,
                    "exit with status 3 when anything touches or crosses");
  command->callback([options] { query(*options); });
}

}  // namespace cscd::bench
