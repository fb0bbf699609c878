#include <CLI/App.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "bench/answer/answer.h"
#include "bench/answer/answer_json.h"
#include "bench/answer/answer_text.h"
#include "bench/answer/options/answer_options.h"
#include "bench/answer/true_answer.h"
#include "bench/command_line/command.h"
#include "bench/inputs/input.h"
#include "bench/inputs/thickness.h"
#include "bench/output/output.h"
#include "bench/output/progress.h"
#include "bench/strategies/catalogue.h"
#include "bench/strategies/strategy_row.h"
#include "core/base/error.h"
#include "core/base/number_text.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

constexpr std::size_t kStartPairs = 1000;  // listed of an interval, unless all are asked for

struct QueryOptions : AnswerRequest {
  std::string strategy, output, start_pairs, preparation;
  bool force = false, fail_on_contact = false, new_contacts = false;
  std::optional<WrittenLength> fail_deeper_than;
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

// The engine knows what is wrong with a kept preparation, but not in which file that is.
Answerer prepare(const QueryOptions& options, Input& input, const Strategy& strategy,
                 const ElementaryTest& elementary) {
  constexpr std::string_view kBegin = "preparation: ";
  try {
    return Answerer(input, strategy, elementary, options.answers);
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (input.preparation.empty() || !what.starts_with(kBegin)) throw;
    throw InputError("--preparation " + options.preparation + ": " + what.substr(kBegin.size()));
  }
}

// Answers the chosen intervals of a clip, and writes the document of it unless `document` is null.
ClipAnswer answer_clip(const QueryOptions& options, Input& input, const SurfaceNames& names,
                       JsonStream* document) {
  const ElementaryTest& elementary = elementary_test_named(options.elementary);
  const Strategy& strategy = options.strategy.empty() ? default_strategy(input, options.answers.first)
                                                      : strategy_named(options.strategy);
  input.use_bones = gets_bones(strategy, input.clip->interval_count());
  const IntervalRange range = parse_frames(options.frames, input);
  Watchdog watchdog = watchdog_of(options, input);
  if (!options.preparation.empty()) input.preparation = read_preparation(options.preparation);
  Answerer answerer = prepare(options, input, strategy, elementary);
  if (!options.preparation.empty() && input.preparation.empty())
    write_preparation(options.preparation, answerer.saved_preparation(), strategy);
  std::optional<TrueAnswerer> true_motion;
  if (input.motion)
    true_motion.emplace(input, elementary, answerer.rest_crossings(), options.answers, options.resolution);
  ClipAnswer answer = prepared_answer(input, names, strategy, elementary, options.answers, answerer);
  OverlapEvents events(input, names, answerer);
  std::optional<ClipJson> json;
  if (document != nullptr)
    json.emplace(*document, answer, options.input, most_start_pairs(options.start_pairs));
  Progress progress("query " + options.input, range.last - range.first);
  for (std::size_t i = range.first; i < range.last; ++i) {
    watchdog.restart();
    IntervalAnswer interval = answerer.answer(i);
    const Motion motion = input.clip->load(i).motion;
    const OverlapEvents::Here here = events.add(interval, motion.start(), {.pieces = options.new_contacts});
    if (true_motion) true_motion->answer(motion, interval);
    answer.true_motion.add(interval, names);
    interval.event_of_contact = here.event_of_contact;
    if (options.new_contacts) keep_new(interval, here, input.thickness.length > 0);
    answer.summary.add(interval, motion, names);
    if (json) json->add(answer, interval, motion);
    progress.advance();
  }
  watchdog.restart();
  std::optional<IntervalAnswer> last = last_pose_of(input, range.last, answerer, events);
  answer.take(std::move(last), events);
  if (json) json->finish(answer);
  if (answerer.new_triangles() > 0)
    std::printf("preparation %s: %zu of %zu triangles are new since it was kept, and were prepared now\n",
                options.preparation.c_str(), answerer.new_triangles(), input.mesh.triangle_count());
  return answer;
}

// What was said of a clip, or of all clips of a file.
struct Said {
  IntervalVerdict verdict = IntervalVerdict::clear;  // of a clip that touches or crosses, if there is one
  bool too_deep = false;                             // for --fail-deeper-than
  std::vector<std::string> apart;                    // of what the verdict does not speak
};

Said say_clip(QueryOptions options, Input input, JsonStream* document, bool is_brief = false) {
  input.threads = options.threads;
  // The one pose of a file is asked about as it is, whatever is left out of motions.
  if (input.is_one_pose) options.answers.keep_rest_crossings = true;
  ignore(input, options.ignored);
  set_thickness(input, options.thickness);
  const SurfaceNames names(input);
  const ClipAnswer answer = answer_clip(options, input, names, document);
  std::printf("%s", (is_brief ? brief_clip_text(answer) : clip_text(answer)).c_str());
  Said said;
  said.verdict = input.motion ? answer.true_motion.verdict() : answer.summary.verdict();
  said.apart = verdict_exceptions(answer);
  if (options.fail_deeper_than) {
    const DepthCheck check = check_depth(answer, *options.fail_deeper_than);
    said.too_deep = check.fails;
    std::printf("  %s\n", check.text.c_str());
  }
  return said;
}

// "'walk', 'run', 'jump' and 2 more".
std::string listed_names(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, names.size()); ++i)
    text += (i > 0 ? ", '" : "'") + names[i] + "'";
  if (names.size() > kMost) text += " and " + std::to_string(names.size() - kMost) + " more";
  return text;
}

// What the verdicts of all clips come to, as a sentence and in JSON.
class AllVerdicts {
 public:
  void add(const std::string& clip, IntervalVerdict verdict, const std::vector<std::string>& apart) {
    apart_.insert(apart.begin(), apart.end());
    names_[static_cast<std::size_t>(verdict)].push_back(clip);
    if (verdict == IntervalVerdict::clear) (apart.empty() ? untouched_ : left_out_).push_back(clip);
  }
  void pass_over(const std::string& clip) { still_.push_back(clip); }
  std::size_t answered() const {
    std::size_t count = 0;
    for (const std::vector<std::string>& names : names_) count += names.size();
    return count;
  }
  std::string sentence(const std::string& input) const {
    std::string text;
    const auto say = [&](const std::vector<std::string>& names, const char* one, const char* several) {
      if (names.empty()) return;
      text += (text.empty() ? " " : "; ") + std::to_string(names.size()) + " " +
              (names.size() == 1 ? one : several) + " (" + listed_names(names) + ")";
    };
    say(of(IntervalVerdict::intersects_at_start), "crosses itself at the start of intervals",
        "cross themselves at the start of intervals");
    say(of(IntervalVerdict::touches), "touches itself", "touch themselves");
    say(of(IntervalVerdict::close), "comes close to itself", "come close to themselves");
    say(of(IntervalVerdict::undecided), "may touch itself", "may touch themselves");
    say(untouched_, "does not touch itself", "do not touch themselves");
    say(left_out_, "touches itself only in what is left out", "touch themselves only in what is left out");
    say(still_, "is one pose and was passed over", "are one pose and were passed over");
    const std::size_t count = answered() + still_.size();
    if (!apart_.empty()) text += "; all of this apart from ";
    for (const std::string& each : apart_) text += (each == *apart_.begin() ? "" : " and ") + each;
    return short_name(input) + ", " + many(count, "clip") + " in all:" + text + ".";
  }
  // The clips that are close are counted where there is a thickness.
  json as_json(const std::string& input, bool is_thick) const {
    json out = {{"sentence", sentence(input)},
                {"clear", of(IntervalVerdict::clear).size()},
                {"touches", of(IntervalVerdict::touches).size()},
                {"intersects_at_start", of(IntervalVerdict::intersects_at_start).size()},
                {"undecided", of(IntervalVerdict::undecided).size()},
                {"passed_over", still_.size()}};
    if (is_thick) out["close"] = of(IntervalVerdict::close).size();
    return out;
  }

 private:
  const std::vector<std::string>& of(IntervalVerdict verdict) const {
    return names_[static_cast<std::size_t>(verdict)];
  }
  std::array<std::vector<std::string>, 5> names_;  // of clips, by their verdicts
  std::vector<std::string> untouched_, left_out_;  // of the clear ones: those without and with exceptions
  std::vector<std::string> still_;
  std::set<std::string> apart_;
};

// Answers the clips of a model file, one after the other. A clip of one pose moves nothing and is passed
// over, unless no clip moves.
Said say_all_clips(QueryOptions options, Input first, JsonStream* document) {
  const scenes::ImportReport seen = *first.import;
  if (!options.frames.empty())
    throw InputError("--frames " + options.frames + ": is for one clip, and " + options.input + " has " +
                     std::to_string(seen.clips.size()) + "; name one with --clip (cscd inspect lists them)");
  if (!options.preparation.empty())
    throw InputError("--preparation: is for one clip; name one with --clip (cscd inspect lists them)");
  std::printf("%s (%s)\n  %s, %s\n%s", options.input.c_str(), seen.format.c_str(),
              many(seen.clips.size(), "clip").c_str(), rate_text(seen).c_str(), surface_text(seen).c_str());
  Said all;
  if (document != nullptr) {
    document->begin_object();
    document->key("clips");
    document->begin_array();
  }
  const bool something_moves =
      options.model.import.from_bind_pose ||
      std::ranges::any_of(seen.clips, [](const scenes::ImportReport::Clip& clip) { return clip.frames > 1; });
  AllVerdicts verdicts;
  for (std::size_t clip = 0; clip < seen.clips.size(); ++clip) {
    if (seen.clips[clip].frames < 2 && something_moves && !options.model.import.from_bind_pose) {
      verdicts.pass_over(seen.clips[clip].name);
      continue;
    }
    options.model.import.clip.clear();
    options.model.import.clip_number = clip;
    const bool is_open = seen.chosen_clip == static_cast<long>(clip);
    Said one;
    name_input(options.input, [&] {
      one = say_clip(options, is_open ? std::move(first) : open_input(options.input, options.model), document,
                     seen.clips.size() > 1);
    });
    verdicts.add(seen.clips[clip].name, one.verdict, one.apart);
    if (collides(one.verdict)) all.verdict = one.verdict;
    all.too_deep = all.too_deep || one.too_deep;
  }
  std::printf("%s\n", verdicts.sentence(options.input).c_str());
  if (seen.clips.size() > 1) {
    const char* const paths = "; --true-motion asks about the paths on which bones carry the surface";
    std::printf("  --clip NAME says more of one, and --json FILE all of each%s\n",
                options.model.true_motion ? "" : paths);
  }
  if (document == nullptr) return all;
  document->end();
  json import = import_json(seen);
  import["clip"] = nullptr;  // none of them alone
  const bool is_thick = options.thickness.thickness.number > 0 || options.model.true_motion;
  for (const auto& [key, value] : {std::pair<const char*, json>{"import", std::move(import)},
                                   {"input", options.input},
                                   {"schema", kQuerySchema},
                                   {"summary", verdicts.as_json(options.input, is_thick)}}) {
    document->key(key);
    document->value(value);
  }
  document->end();
  return all;
}

// Without a name, all clips are asked about. The first that moves has then been opened, which tells how many
// there are; a file of one clip is read once.
Said say_answers(QueryOptions options, JsonStream* document) {
  options.model.import.one_pose = is_model_file(options.input);
  const bool all = options.model.import.clip == kAllClips && is_model_file(options.input);
  ModelOptions model = options.model;
  if (all) {
    model.import.clip.clear();
    model.import.survey = true;
  }
  Input input = open_input(options.input, model);
  if (all || !input.clip_was_named) return say_all_clips(options, std::move(input), document);
  say_what_was_read(input, stdout);
  Said said;
  name_input(options.input, [&] { said = say_clip(options, std::move(input), document); });
  return said;
}

void query(QueryOptions options) {
  require_sound(options);
  if (options.new_contacts && options.model.true_motion)
    throw InputError("--new-contacts with --true-motion: is about straight lines; leave out one of the two");
  if (options.new_contacts && options.answers.first)
    throw InputError(
        "--new-contacts with --first: the earliest contact may be an old one, after which --first "
        "looks for no other; leave out one of the two");
  if (!options.strategy.empty()) require_fit(options.thickness, strategy_named(options.strategy));
  most_start_pairs(options.start_pairs);
  std::optional<OutputFile> output;
  if (!options.output.empty()) output.emplace(options.output, options.force);

  JsonStream document([&](std::string_view piece) { output->write(piece); });
  const Said said = say_answers(options, output ? &document : nullptr);
  if (output) {
    document.finish();
    output->commit();
  }
  if (options.fail_on_contact && collides(said.verdict)) throw kContactFound;
  if (said.too_deep) throw kContactFound;
}

}  // namespace

void add_query(CLI::App& app) {
  auto options = std::make_shared<QueryOptions>();
  CLI::App* command = app.add_subcommand(
      "query",
      "Find where and when a mesh first touches itself in each interval of a clip.\n\n"
      "  cscd query rope\n"
      "  cscd query character.glb                    every clip of the file\n"
      "  cscd query character.glb --clip walk        one of them\n"
      "  cscd query character.h5 --strategy base --frames 0:10 --json answer.json\n"
      "  cscd query character.glb --clip all --fail-on-contact --json - | jq .clips[].summary\n\n"
      "Prints what a person wants to know. With --json FILE the whole answer goes there as JSON (schema\n"
      "cscd.query/4); --json - is standard output, and the text then goes to standard error. A file of "
      "several\n"
      "clips is answered as a list, `clips`, unless --clip names one; with --clip all any model file is.\n\n"
      "Each interval is clear, touches, or intersects_at_start; with --thickness, it may also be close: "
      "then\n"
      "something comes that near and nothing touches (with --first, as far as is looked). What crosses at "
      "rest (eyes in sockets, "
      "clothes\n"
      "in skin) is how a character is made: pairs of triangles that cross in the bind pose, or in frame 0 of "
      "a\n"
      "point cache, are named once and left out until they part, unless --keep-rest-crossings.\n\n"
      "Where a start is not embedded, the guarantee first_contact is void, and the fastest complete "
      "strategy\n"
      "answers that interval instead (--unproven: do not). Whoever wants the earliest contact and no later "
      "ones\n"
      "has it sooner with --first.\n\n"
      "Where triangles cross at starts, the text lists the ten places in which the surface lies deepest in "
      "itself:\n"
      "which piece in which, how deep, and from when to when. The JSON has all of them.");
  add_answer_options(*command, *options);
  command->add_option("--strategy", options->strategy,
                      "culling strategy (cscd list); without it, the best that the input allows");
  command->add_option(
      "--preparation", options->preparation,
      "file in which what preparing the surface finds out is kept: written if there is none, else read, "
      "which takes a fraction of the time, also where the surface has changed in places since");
  command->add_flag(
      "--true-motion", options->model.true_motion,
      "of a model file, ask also about the paths on which keys and bones carry the surface between "
      "frames,\nwith proof: its verdicts decide --fail-on-contact");
  add_resolution_option(*command, *options);
  command->add_option("--json", options->output, "where the whole answer goes; - is standard output");
  command->add_flag("--force", options->force, "replace the output if it exists");
  command->add_option(
      "--start-pairs", options->start_pairs,
      "how many of the pairs of triangles that cross at a start are listed, or all; default 1000");
  command->add_flag("--fail-on-contact", options->fail_on_contact,
                    "exit with status 3 when anything touches, crosses, or comes within the thickness");
  command
      ->add_option_function<std::string>(
          "--fail-deeper-than",
          [options = options.get()](const std::string& text) {
            options->fail_deeper_than = parse_length("--fail-deeper-than", text);
          },
          "exit with status 3 when a piece of the surface lies deeper in another in any frame: a length such "
          "as 0.01, or 0.2e for mean edges of the pose at rest")
      ->type_name("LENGTH");
  command->add_flag(
      "--new-contacts", options->new_contacts,
      "leave out contacts and crossings of pieces that lie in each other when an interval starts: "
      "only what touches anew counts");
  command->callback([options] { query(*options); });
}

}  // namespace cscd::bench
