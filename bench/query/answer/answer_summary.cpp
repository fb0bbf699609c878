#include "bench/query/answer/answer_summary.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <set>
#include <tuple>
#include <vector>

namespace cscd::bench {
namespace {

using nlohmann::json;
using Names = std::pair<std::string, std::string>;

constexpr std::size_t kMostListed = 5;  // of pairs of names, in a text

std::string number(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.4g", value);
  return digits;
}

// Frames of a long clip keep their hundredths.
std::string frame_text(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.10g", std::round(100 * value) / 100);
  return digits;
}

std::string many(std::size_t count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

std::string moment_text(const Input& input, const ClipMoment& moment) {
  const std::optional<double> seconds = second_of(input, moment);
  std::string text = "frame " + frame_text(frame_of(input, moment));
  // Seconds count from the start of the clip, and frames from the start of the file's time line.
  const bool late = input.import && frame_at(*input.import, 0) != 0;
  if (seconds) text += " (" + number(*seconds) + (late ? " s into the clip)" : " s)");
  return text;
}

// "hand_l touches hips", "tail touches itself".
std::string meeting_text(const Names& both, const std::string& verb) {
  return both.first + " " + verb + " " + (both.first == both.second ? "itself" : both.second);
}

std::vector<std::pair<Names, std::size_t>> most_first(const std::map<Names, std::size_t>& counts) {
  std::vector<std::pair<Names, std::size_t>> sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return sorted;
}

// "eye_l in head: 96 pairs, teeth in head: 12 pairs, and 3 more".
template <class Text>
std::string listed(const std::map<Names, std::size_t>& counts, const Text& text) {
  std::string out;
  const auto sorted = most_first(counts);
  for (std::size_t i = 0; i < std::min(kMostListed, sorted.size()); ++i)
    out += (i > 0 ? ", " : "") + text(sorted[i].first, sorted[i].second);
  if (sorted.size() > kMostListed) out += ", and " + std::to_string(sorted.size() - kMostListed) + " more";
  return out;
}

Names in_order(std::string a, std::string b) {
  if (b < a) std::swap(a, b);
  return {std::move(a), std::move(b)};
}

// "LeftLeg and LeftUpLeg (24 intervals)".
std::string met_text(const Names& both, std::size_t intervals) {
  return both.first + " and " + (both.first == both.second ? "itself" : both.second) + " (" +
         many(intervals, "interval") + ")";
}

std::string ignored_text(const Input& input, const AnswerSummary& s) {
  std::string asked;
  for (const Names& both : input.ignored->names) asked += " --ignore " + both.first + ":" + both.second;
  if (input.ignored->neighbours)
    asked += " --ignore-neighbours " + std::to_string(*input.ignored->neighbours);
  if (s.with_ignored == 0) return "ignored: nothing that touches (" + asked.substr(1) + ")";
  std::map<Names, std::size_t> intervals;
  std::size_t contacts = 0, pairs = 0;
  for (const auto& [both, here] : s.ignored) {
    intervals[both] = here.intervals;
    contacts += here.contacts;
    pairs += here.start_pairs;
  }
  return "ignored: " + listed(intervals, met_text) + "; " + many(contacts, "contact") + " and " +
         many(pairs, "crossing pair") + " of triangles in " + many(s.with_ignored, "interval") + " (" +
         asked.substr(1) + ")";
}

// "horse.glb, clip 'Walk' (14th of 14 clips), component 2 of 5 alone": what exactly a verdict is about.
std::string subject_of(const Input& input) {
  const std::string name = std::filesystem::path(input.name).filename().string();
  if (!input.import) return name;
  const scenes::ImportReport& report = *input.import;
  std::string rest;
  if (const std::string clip = clip_title(report); !clip.empty()) rest += ", " + clip;
  if (const std::size_t chosen = report.chosen_components.size(); chosen < report.components)
    rest += (chosen == 1 ? ", component " + std::to_string(report.chosen_components[0])
                         : ", " + std::to_string(chosen) + " components") +
            " of " + std::to_string(report.components) + " alone";
  return name + rest + (rest.empty() ? "" : ",");
}

std::string of_intervals(std::size_t count, const AnswerSummary& s) {
  return std::to_string(count) + " of " + many(s.intervals(), "interval");
}

// Whether any vertex moves by more than rounding. A clip may drive a camera alone, or hold a pose.
bool is_moving(const Motion& motion) {
  constexpr double kRounding = 1e-9;  // of the largest coordinate
  double most = 0, farthest = 0;
  for (std::size_t v = 0; v < motion.start().size(); ++v) {
    most = std::max(most, motion.start()[v].cwiseAbs().maxCoeff());
    farthest = std::max(farthest, (motion.end()[v] - motion.start()[v]).cwiseAbs().maxCoeff());
  }
  return farthest > kRounding * most;
}

// The predicate of a verdict: one class a line.
std::string verdict_predicate(const Input& input, const AnswerSummary& s) {
  const std::size_t touch = s.count(IntervalVerdict::touches),
                    cross = s.count(IntervalVerdict::intersects_at_start),
                    undecided = s.count(IntervalVerdict::undecided);
  if (!s.collides()) {
    const std::string frames = " in frames " + frame_text(frame_of(input, {s.first_index, 0})) + " to " +
                               frame_text(frame_of(input, {s.last_index, 1}));
    const std::string rest = s.with_left_out > 0 ? "what crosses at rest" : "";
    const std::string ignored = s.with_ignored > 0 ? "what is ignored" : "";
    const std::string both = rest + (rest.empty() || ignored.empty() ? "" : " and ") + ignored;
    const std::string apart = both.empty() ? "" : ", apart from " + both;
    if (undecided > 0)
      return "may touch itself" + frames + apart + ": the elementary test could not tell in " +
             of_intervals(undecided, s) + "; ask again with another --elementary";
    return s.moves ? "does not touch itself" + frames + apart
                   : "does not move" + frames + ", and does not touch itself" + apart;
  }
  std::string text;
  if (cross > 0) text = "crosses itself at the start of " + of_intervals(cross, s);
  if (touch > 0)
    text += cross > 0 ? " and touches itself in " + std::to_string(touch) + " more"
                      : "touches itself in " + of_intervals(touch, s);
  const AnswerSummary::Meeting& first = *s.first;
  return text + ", first at " + moment_text(input, first.moment) + ": " +
         meeting_text(first.names, first.crosses ? "crosses" : "touches");
}

}  // namespace

std::size_t AnswerSummary::intervals() const {
  return std::accumulate(verdicts.begin(), verdicts.end(), std::size_t{0});
}

void AnswerSummary::add(const IntervalAnswer& answer, const Motion& motion, const SurfaceNames& names) {
  moves = moves || is_moving(motion);
  if (intervals() == 0) first_index = answer.index;
  last_index = answer.index;
  ++verdicts[static_cast<std::size_t>(answer.verdict)];
  ++strategies[std::string(answer.strategy->name)];
  proven += answer.proven;
  with_left_out += answer.rest_pairs + answer.rest_contacts > 0;
  add_ignored(answer, names);
  embedding_ms += answer.embedding_ms;
  query_ms += answer.report.ms.total();
  load_ms += answer.load_ms;
  wall_ms += answer.wall_ms;
  if (answer.verdict == IntervalVerdict::clear || answer.verdict == IntervalVerdict::undecided) return;

  const bool crosses = answer.verdict == IntervalVerdict::intersects_at_start;
  const ClipMoment moment{answer.index, crosses ? 0 : answer.time().value_or(0)};
  const std::size_t contacts =
      static_cast<std::size_t>(std::count_if(answer.found.contacts.begin(), answer.found.contacts.end(),
                                             [](const Contact& c) { return c.verdict == Verdict::contact; }));
  if (!worst || std::tie(answer.start.total, contacts) > std::tie(worst->start_pairs, worst->contacts))
    worst = Worst{moment, answer.start.total, contacts};

  std::set<Names> here;
  const auto meet = [&](TriangleId a, TriangleId b) {
    std::string x = names.place_of(a), y = names.place_of(b);
    if (!first) first = Meeting{moment, crosses, {x, y}};
    here.insert(in_order(std::move(x), std::move(y)));
  };
  for (const CrossingPair& pair : answer.start.pairs) meet(pair.first, pair.second);
  for (const Contact& contact : answer.found.contacts)
    if (contact.verdict == Verdict::contact)
      meet(names.triangle_of(contact.pair, false), names.triangle_of(contact.pair, true));
  if (!first) first = Meeting{moment, crosses, {"the surface", "the surface"}};
  for (const Names& both : here) ++met[both];
}

void AnswerSummary::add_ignored(const IntervalAnswer& answer, const SurfaceNames& names) {
  std::set<Names> here;
  const auto meet = [&](TriangleId a, TriangleId b) -> IgnoredHere& {
    const auto [one, added] = here.insert(in_order(names.place_of(a), names.place_of(b)));
    IgnoredHere& entry = ignored[*one];
    entry.intervals += added;
    return entry;
  };
  for (const CrossingPair& pair : answer.ignored_pairs) ++meet(pair.first, pair.second).start_pairs;
  for (const Contact& contact : answer.ignored.contacts)
    if (contact.verdict == Verdict::contact)
      ++meet(names.triangle_of(contact.pair, false), names.triangle_of(contact.pair, true)).contacts;
  with_ignored += !here.empty();
}

json summary_json(const Input& input, const AnswerSummary& s) {
  json strategies = json::array(), met = json::array(), ignored = json::array(), first, worst;
  for (const auto& [name, count] : s.strategies) strategies.push_back({{"name", name}, {"intervals", count}});
  for (const auto& [names, count] : most_first(s.met))
    met.push_back({{"first", names.first}, {"second", names.second}, {"intervals", count}});
  for (const auto& [names, here] : s.ignored)
    ignored.push_back({{"first", names.first},
                       {"second", names.second},
                       {"intervals", here.intervals},
                       {"start_pairs", here.start_pairs},
                       {"contacts", here.contacts}});
  if (s.first) first = moment_json(input, s.first->moment);
  if (s.worst) {
    worst = moment_json(input, s.worst->moment);
    worst["start_pairs"] = s.worst->start_pairs;
    worst["contacts"] = s.worst->contacts;
  }
  return {{"verdict", to_string(s.verdict())},
          {"sentence", verdict_sentence(input, s)},
          {"intervals", s.intervals()},
          {"clear", s.count(IntervalVerdict::clear)},
          {"touches", s.count(IntervalVerdict::touches)},
          {"intersects_at_start", s.count(IntervalVerdict::intersects_at_start)},
          {"undecided", s.count(IntervalVerdict::undecided)},
          {"proven", s.proven},
          {"ms",
           {{"query", s.query_ms},
            {"embedding", s.embedding_ms},
            {"wall", s.wall_ms},
            {"load", s.load_ms},
            {"preparation", s.preparation_ms}}},
          {"with_left_out", s.with_left_out},
          {"strategies", std::move(strategies)},
          {"first", std::move(first)},
          {"worst", std::move(worst)},
          {"met", std::move(met)},
          {"with_ignored", s.with_ignored},
          {"ignored", std::move(ignored)}};
}

std::string verdict_sentence(const Input& input, const AnswerSummary& s) {
  return subject_of(input) + " " + verdict_predicate(input, s) + ".";
}

IntervalVerdict AnswerSummary::verdict() const {
  for (const IntervalVerdict worst :
       {IntervalVerdict::intersects_at_start, IntervalVerdict::touches, IntervalVerdict::undecided})
    if (count(worst) > 0) return worst;
  return IntervalVerdict::clear;
}

SummarySentences summary_sentences(const Input& input, const SurfaceNames& names, const AnswerSummary& s,
                                   const Crossings& rest, bool left_out) {
  SummarySentences out;
  out.counts = many(s.intervals(), "interval") + ": " + std::to_string(s.count(IntervalVerdict::clear)) +
               " clear, " + std::to_string(s.count(IntervalVerdict::touches)) + " touch, " +
               std::to_string(s.count(IntervalVerdict::intersects_at_start)) + " cross at their start";
  if (s.count(IntervalVerdict::undecided) > 0)
    out.counts += ", " + std::to_string(s.count(IntervalVerdict::undecided)) + " undecided";
  if (s.worst) {
    out.worst = "worst: interval " + std::to_string(s.worst->moment.interval) + ", from " +
                moment_text(input, {s.worst->moment.interval, 0}) + ": ";
    if (s.worst->start_pairs > 0)
      out.worst += many(s.worst->start_pairs, "pair") + " of triangles cross at its start, and ";
    out.worst += many(s.worst->contacts, "contact");
  }
  if (!s.met.empty()) out.met = "met: " + listed(s.met, met_text);
  if (input.ignored) out.ignored = ignored_text(input, s);
  if (rest.total > 0) {
    out.rest = "crosses at rest: " +
               listed(pairs_by_part(names, input.mesh, rest), [](const Names& both, std::size_t count) {
                 return both.first +
                        (both.first == both.second ? " with itself: " : " in " + both.second + ": ") +
                        many(count, "pair");
               });
    out.rest +=
        left_out ? "; left out of " + many(s.with_left_out, "interval") + " (--keep-rest-crossings counts it)"
                 : "; counted, as asked";
  }
  std::string answered;
  for (const auto& [name, count] : s.strategies)
    answered += (answered.empty() ? "" : ", ") + name +
                (s.strategies.size() > 1 ? " (" + std::to_string(count) + ")" : "");
  out.proven = "answered by " + answered + ", " +
               (s.proven == s.intervals()
                    ? "every answer proven"
                    : std::to_string(s.proven) + " of " + std::to_string(s.intervals()) + " proven");
  if (input.import) out.rate = rate_text(*input.import);
  if (!input.clip_was_named)
    out.choice =
        "this is the first clip that moves the surface; --clip names another, and --clip all takes every one";
  return out;
}

std::string summary_text(const Input& input, const SurfaceNames& names, const AnswerSummary& s,
                         const Crossings& rest, bool left_out) {
  const SummarySentences said = summary_sentences(input, names, s, rest, left_out);
  std::string out = verdict_sentence(input, s) + "\n";
  for (const std::string* line :
       {&said.counts, &said.worst, &said.met, &said.ignored, &said.rest, &said.proven})
    if (!line->empty()) out += "  " + *line + "\n";
  return out + "  took " + number(s.wall_ms) + " ms: " + number(s.query_ms) + " to find contacts, " +
         number(s.embedding_ms) + " to know what crosses at the starts; " + number(s.preparation_ms) +
         " ms to prepare and " + number(s.load_ms) + " ms to read frames came on top\n";
}

std::string details_text(const SummarySentences& said) {
  std::string out;
  for (const std::string* sentence :
       {&said.counts, &said.worst, &said.ignored, &said.rest, &said.proven, &said.rate, &said.choice}) {
    if (sentence->empty()) continue;
    std::string capital = *sentence;
    capital[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(capital[0])));
    out += (out.empty() ? "" : " ") + capital + ".";
  }
  return out;
}

}  // namespace cscd::bench
