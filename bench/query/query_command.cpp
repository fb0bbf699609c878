#include <CLI/App.hpp>
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "bench/answer/answer_json.h"
#include "bench/answer/answer_request.h"
#include "bench/answer/answer_text.h"
#include "bench/answer/clip_answerer.h"
#include "bench/answer/verdicts.h"
#include "bench/command_line/add_options.h"
#include "bench/command_line/command.h"
#include "bench/inputs/input.h"
#include "bench/inputs/thickness.h"
#include "bench/output/output.h"
#include "core/base/error.h"
#include "core/base/number_text.h"
#include "scenes/base/joined.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

constexpr std::size_t kStartPairs = 1000;  // listed of an interval, unless all are asked for

struct QueryOptions : AnswerRequest {
  std::string output, start_pairs;
  bool force = false, fail_on_contact = false;
  WrittenLength fail_deeper_than;
};

std::size_t most_start_pairs(const std::string& text) {
  if (text.empty()) return kStartPairs;
  if (text == "all") return std::numeric_limits<std::size_t>::max();
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc{} || end != text.data() + text.size())
    throw InputError("--start-pairs " + text + ": is neither a number nor all; give one of the two");
  return count;
}

// What was said of a clip, or of all clips of a file.
struct Said {
  IntervalVerdict verdict = IntervalVerdict::clear;  // of all clips: of one that collides, if any does
  bool too_deep = false;                             // for --fail-deeper-than
  std::vector<std::string> apart;                    // clips that the verdict does not count, as sentences
  json headline;                                     // of a clip
};

// `told` are the notes of the file that were printed, where this is one of its clips.
Said say_clip(const QueryOptions& options, Input input, JsonStream* document,
              std::set<std::string>* told = nullptr) {
  require_unit(input, options.fail_deeper_than, "--fail-deeper-than");
  ClipAnswerer asked(options, std::move(input));
  const ClipAnswer& answer = asked.answers().front();
  std::optional<ClipJson> json;
  if (document != nullptr)
    json.emplace(*document, answer, options.input, most_start_pairs(options.start_pairs));
  asked.answer_all("query " + options.input, false, [&](const AnsweredPose& pose) {
    if (json && !pose.is_last()) json->add(answer, pose.answers.front(), pose.interval.motion);
  });
  if (json) json->finish(answer);
  std::printf("%s", (told != nullptr ? brief_clip_text(answer) : clip_text(answer)).c_str());
  if (told != nullptr)
    for (const std::string& note : answer.input.import->notes)
      if (told->insert(note).second) std::printf("  note: %s\n", note.c_str());
  Said said;
  said.verdict = answer.verdict();
  said.apart = verdict_exceptions(answer);
  said.headline = headline_json(answer);
  if (options.fail_deeper_than.is_given()) {
    const DepthCheck check = check_depth(answer, options.fail_deeper_than);
    said.too_deep = check.fails;
    std::printf("  %s\n", check.text.c_str());
  }
  return said;
}

// What the verdicts of all clips come to, as a sentence and in JSON.
class AllVerdicts {
 public:
  void add(const std::string& clip, std::size_t number, const Said& said) {
    apart_.insert(said.apart.begin(), said.apart.end());
    counts_.add(said.verdict);
    names_[said.verdict].push_back(clip);
    if (said.verdict == IntervalVerdict::clear) (said.apart.empty() ? untouched_ : left_out_).push_back(clip);
    if (said.headline.is_null() || !(excess(said.headline) > excess(headline_))) return;
    headline_ = said.headline;
    headline_["clip"] = number;
    worst_ = clip;
  }
  void pass_over(const std::string& clip) { still_.push_back(clip); }
  std::string sentence(const std::string& input) {
    std::string text;
    if (!headline_.is_null()) text = " in '" + worst_ + "' " + headline_["text"].get<std::string>();
    const auto say = [&](const std::vector<std::string>& names, const char* one, const char* several) {
      if (names.empty()) return;
      text += (text.empty() ? " " : "; ") + std::to_string(names.size()) + " " +
              (names.size() == 1 ? one : several) + " (" + first_of(names, 6) + ")";
    };
    say(names_[IntervalVerdict::intersects_at_start], "crosses itself at the start of intervals",
        "cross themselves at the start of intervals");
    say(names_[IntervalVerdict::touches], "touches itself", "touch themselves");
    say(names_[IntervalVerdict::close], "comes close to itself", "come close to themselves");
    say(names_[IntervalVerdict::undecided], "may touch itself", "may touch themselves");
    say(untouched_, "does not touch itself", "do not touch themselves");
    say(left_out_, "touches itself only in what is left out", "touch themselves only in what is left out");
    say(still_, "is one pose and was passed over", "are one pose and were passed over");
    const std::size_t count = counts_.total() + still_.size();
    if (!apart_.empty()) text += "; all of this apart from ";
    for (const std::string& each : apart_) text += (each == *apart_.begin() ? "" : " and ") + each;
    return short_name(input) + ", " + many(count, "clip") + " in all:" + text + ".";
  }
  // The clips that are close are counted where there is a thickness.
  json as_json(const std::string& input, bool is_thick) {
    json out = verdict_counts_json(counts_, is_thick);
    out.update({{"sentence", sentence(input)}, {"headline", headline_}, {"passed_over", still_.size()}});
    return out;
  }

 private:
  // How much deeper something lies than it does at rest.
  static double excess(const json& headline) {
    if (headline.is_null()) return 0;
    const json& at_rest = headline["at_rest"];
    return headline["depth"]["at_least"].get<double>() - (at_rest.is_null() ? 0 : at_rest.get<double>());
  }

  VerdictCounts counts_;
  std::map<IntervalVerdict, std::vector<std::string>> names_;  // of clips, by their verdicts
  std::vector<std::string> untouched_, left_out_;  // of the clear ones: those without and with exceptions
  std::vector<std::string> still_;
  std::set<std::string> apart_;
  json headline_;  // the worst of all clips
  std::string worst_;
};

// Answers the clips of a model file, one after the other.
Said say_all_clips(const QueryOptions& options, Input first, JsonStream* document) {
  const scenes::ImportReport seen = *first.import;
  std::printf("%s (%s)\n  %s, %s\n%s", options.input.c_str(), seen.format.c_str(),
              many(seen.clips.size(), "clip").c_str(), rate_text(seen).c_str(), surface_text(seen).c_str());
  Said all;
  if (document != nullptr) {
    document->begin_object();
    document->key("clips");
    document->begin_array();
  }
  AllVerdicts verdicts;
  std::set<std::string> told(seen.notes.begin(), seen.notes.end());
  const auto take = [&](std::size_t clip, Input input) {
    const Said one = say_clip(options, std::move(input), document, seen.clips.size() > 1 ? &told : nullptr);
    verdicts.add(seen.clips[clip].name, clip, one);
    if (collides(one.verdict)) all.verdict = one.verdict;
    all.too_deep = all.too_deep || one.too_deep;
  };
  for_each_clip(options, std::move(first), take,
                [&](std::size_t clip) { verdicts.pass_over(seen.clips[clip].name); });
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
  write_members(*document, {{"import", std::move(import)},
                            {"input", options.input},
                            {"schema", kQuerySchema},
                            {"summary", verdicts.as_json(options.input, is_thick)}});
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
  most_start_pairs(options.start_pairs);
  OutputFile output(options.output, options.force);
  JsonStream document([&](std::string_view piece) { output.write(piece); });
  const bool is_written = !options.output.empty();
  const Said said = say_answers(options, is_written ? &document : nullptr);
  if (is_written) document.finish();
  output.commit();
  const bool fails = said.too_deep || (options.fail_on_contact && collides(said.verdict));
  end_with(fails ? ExitStatus::contact_found : ExitStatus::done);
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
      "cscd.query/4); --json - is standard output, and the text then goes to standard error. A file of\n"
      "several clips is answered as a list, `clips`, unless --clip names one; with --clip all any model\n"
      "file is.\n\n"
      "Each interval is clear, touches, or intersects_at_start; with --thickness, it may also be close:\n"
      "then something comes that near and nothing touches (with --first, as far as is looked). What crosses\n"
      "at rest (eyes in sockets, clothes in skin) is how a character is made: pairs of triangles that cross\n"
      "in the bind pose, or in frame 0 of a point cache, are named once and left out until they part,\n"
      "unless --keep-rest-crossings.\n\n"
      "Where a start is not embedded, the guarantee first_contact is void, and the fastest complete\n"
      "strategy answers that interval instead (--unproven: do not). Whoever wants the earliest contact and\n"
      "no later ones has it sooner with --first.\n\n"
      "Where triangles cross at starts, the text lists the ten places in which the surface lies deepest in\n"
      "itself: which piece in which, how deep, and from when to when. The JSON has all of them.");
  add_answer_options(*command, *options);
  add_output_options(*command, *options, "where the whole answer goes; - is standard output");
  static const OptionRow<QueryOptions> rows[] = {
      {"--start-pairs", &QueryOptions::start_pairs,
       "how many of the pairs of triangles that cross at a start are listed, or all; default 1000"},
      {"--fail-on-contact", &QueryOptions::fail_on_contact,
       "exit with status 3 when anything touches, crosses, or comes within the thickness; with\n"
       "--true-motion, in its true motion"},
      {.name = "--fail-deeper-than",
       .member = &QueryOptions::fail_deeper_than,
       .help = "exit with status 3 when a piece of the surface lies deeper in another in any frame: a length "
               "such "
               "as 0.01, 5mm where the input tells its unit, or 0.2e for mean edges of the pose at rest",
       .type = "LENGTH"}};
  add_options<QueryOptions>(*command, rows, *options);
  command->callback([options] { query(*options); });
}

}  // namespace cscd::bench
