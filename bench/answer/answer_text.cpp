#include "bench/answer/answer_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <vector>

#include "bench/answer/event_text.h"
#include "bench/answer/verdicts.h"
#include "bench/inputs/input_options.h"
#include "bench/inputs/thickness.h"
#include "core/base/number_text.h"
#include "scenes/base/joined.h"

namespace cscd::bench {
namespace {

constexpr std::size_t kMostListed = 5;  // of pairs of names, in a text
constexpr std::size_t kMostEvents = 10;

// "eye_l in head: 96 pairs, teeth in head: 12 pairs, and 3 more".
template <class Text>
std::string listed(const std::map<NamePair, std::size_t>& counts, const Text& text) {
  std::string out;
  const auto sorted = most_first(counts);
  for (std::size_t i = 0; i < std::min(kMostListed, sorted.size()); ++i)
    out += (i > 0 ? ", " : "") + text(sorted[i].first, sorted[i].second);
  if (sorted.size() > kMostListed) out += ", and " + std::to_string(sorted.size() - kMostListed) + " more";
  return out;
}

// "LeftLeg and LeftUpLeg (24 intervals)".
std::string met_text(const NamePair& both, std::size_t intervals) {
  return meeting_text(both, "and") + " (" + many(intervals, "interval") + ")";
}

std::string ignored_text(const Input& input, const AnswerSummary& s) {
  std::vector<std::string> words;
  echo_options(ignore_options(), input.ignored->asked, words);
  const std::string asked = " (" + joined(words, " ") + ")";
  if (s.with_ignored == 0) return "ignored: nothing that touches" + asked;
  std::map<NamePair, std::size_t> intervals;
  std::size_t contacts = 0, pairs = 0;
  for (const auto& [both, here] : s.ignored) {
    intervals[both] = here.intervals;
    contacts += here.contacts;
    pairs += here.start_pairs;
  }
  return "ignored: " + listed(intervals, met_text) + "; " + many(contacts, "contact") + " and " +
         many(pairs, "crossing pair") + " of triangles in " + many(s.with_ignored, "interval") + asked;
}

std::string of_intervals(std::size_t count, const AnswerSummary& s) {
  return std::to_string(count) + " of " + many(s.intervals(), "interval");
}

// "0.2e (1.34 cm)", or "0.01".
std::string length_text(const Input& input, const WrittenLength& written) {
  return written.text +
         (written.in_edges ? " (" + distance_text(input, written.length(length_scale(input))) + ")" : "");
}

// "thickness 0.2e (0.0134); pairs of features that are near by construction are left out (--exclude-rings 2),
// and 34 others are this close at rest". Empty where nothing of this was asked.
std::string thickness_text(const ClipAnswer& answer) {
  const InputThickness& own = answer.input.thickness;
  const bool is_thick = own.length > 0;
  std::string out = is_thick ? "thickness " + length_text(answer.input, own.asked.thickness) : "";
  if (const AnswerSummary& s = answer.summary; s.close_at_start > 0)
    out += "; " + many(s.close_at_start, "pair") + " of features " + (s.close_at_start == 1 ? "is" : "are") +
           " this close at the start of " + many(s.with_close_at_start, "interval");
  if (!own.left_out) return out;
  out += std::string(is_thick ? "; " : "") + "pairs of features that are near by construction are left out (";
  const int rings = own.asked.rings.value_or(0);
  if (rings > 0) out += "--exclude-rings " + std::to_string(rings);
  if (own.asked.near_rest.number > 0)
    out += (rings > 0 ? ", --exclude-near-rest " : "--exclude-near-rest ") +
           length_text(answer.input, own.asked.near_rest);
  const bool is_one = answer.kept_at_rest == 1;
  return out + "), and " + std::to_string(answer.kept_at_rest) + (is_one ? " other " : " others ") +
         (!is_thick ? (is_one ? "touches" : "touch")
          : is_one  ? "is this close"
                    : "are this close") +
         " at rest";
}

// What crosses at rest, in two kinds: parts that cross, and copies of one surface that lie on each other.
struct AtRest {
  std::map<NamePair, std::size_t> crossing, coinciding;  // pairs of triangles
  std::map<NamePair, std::size_t> same;                  // pairs of triangles with the same three corners
};

AtRest at_rest(const ClipAnswer& answer) {
  const Input& input = answer.input;
  const auto corners = [&](TriangleId t) {
    std::array<std::array<double, 3>, 3> out;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& x = input.rest()[static_cast<std::size_t>(+input.mesh.corners(t)[k])];
      out[k] = {x[0], x[1], x[2]};
    }
    std::ranges::sort(out);
    return out;
  };
  Crossings same;
  for (const CrossingPair& pair : answer.rest.pairs)
    if (corners(pair.first) == corners(pair.second)) same.pairs.push_back(pair);
  AtRest out{pairs_by_part(answer.names, input.mesh, answer.rest),
             {},
             pairs_by_part(answer.names, input.mesh, same)};
  // A triangle meets its copy and the copies of its neighbours, which are a dozen on most surfaces.
  constexpr std::size_t kMostNeighbours = 32;
  for (const auto& [both, count] : out.same)
    if (kMostNeighbours * count >= out.crossing.at(both)) out.coinciding.insert(out.crossing.extract(both));
  return out;
}

std::string with_itself_or_in(const NamePair& both, const char* in) {
  return both.first + (both.first == both.second ? " with itself: " : in + both.second + ": ");
}

std::string exceptions_text(const ClipAnswer& answer) {
  std::string out;
  for (const std::string& each : verdict_exceptions(answer)) out += (out.empty() ? "" : " and ") + each;
  return out;
}

// Behind a verdict that says that something touches.
std::string apart_text(const ClipAnswer& answer) {
  const std::string exceptions = exceptions_text(answer);
  return exceptions.empty() ? "" : ", apart from " + exceptions;
}

std::string frames_text(const ClipAnswer& answer) {
  const AnswerSummary& s = answer.summary;
  return " in frames " + frame_text(answer.input, {s.first_index, 0}) + " to " +
         frame_text(answer.input, {s.last_index, 1});
}

constexpr char kFold[] = "less deep than a tenth of the limb's girth";
static_assert(Joints::kShare == 0.1);

// Behind a verdict: whether all that meets does so at joints.
std::string joints_alone_text(const ClipAnswer& answer) {
  const bool alone = answer.only_folds(answer.first_named()->names);
  return alone ? std::string(", only at joints and ") + kFold : "";
}

// What meets at joints, as ignored_text() says what is ignored. Empty where nothing does.
std::string joints_text(const ClipAnswer& answer) {
  std::map<NamePair, std::size_t> intervals;
  std::size_t contacts = 0, pairs = 0;
  for (const auto& [both, here] : answer.summary.met) {
    if (!answer.only_folds(both)) continue;
    intervals[both] = here.intervals;
    contacts += here.contacts;
    pairs += here.start_pairs;
  }
  if (intervals.empty()) return {};
  return std::string("at joints, ") + kFold + ": " + listed(intervals, met_text) + "; " +
         many(contacts, answer.summary.is_thick ? "close pair" : "contact") +
         (pairs > 0 ? " and " + many(pairs, "crossing pair") + " of triangles" : std::string()) +
         (answer.input.clip->header().bone_parent.empty() ? ""
                                                          : " (--ignore-neighbours 1 ignores such pairs)");
}

// The predicate of a verdict about straight lines: one class a line.
std::string verdict_predicate(const ClipAnswer& answer) {
  const Input& input = answer.input;
  const AnswerSummary& s = answer.summary;
  const bool is_thick = input.thickness.length > 0;
  const std::size_t touch = s.verdicts[IntervalVerdict::touches], close = s.verdicts[IntervalVerdict::close],
                    cross = s.verdicts[IntervalVerdict::intersects_at_start],
                    undecided = s.verdicts[IntervalVerdict::undecided];
  const std::string apart = apart_text(answer);
  if (input.is_one_pose && s.first) {
    const std::string what = cross > 0 ? "crosses itself"
                             : touch > 0
                                 ? "touches itself"
                                 : "comes within " + input.thickness.asked.thickness.text + " of itself";
    const std::string pairs =
        cross > 0 ? many(s.worst->start_pairs, "pair") + " of triangles, " : std::string();
    const AnswerSummary::Meeting& named = *answer.first_named();
    return what + " in its one pose" + joints_alone_text(answer) + apart + ": " + pairs +
           meeting_text(named.names, named.how);
  }
  if (!collides(s.verdict())) {
    const std::string frames = input.is_one_pose ? " in its one pose" : frames_text(answer);
    if (undecided > 0)
      return "may touch itself" + frames + apart + ": the elementary test could not tell in " +
             of_intervals(undecided, s) + "; ask again with another --elementary";
    const std::string near =
        is_thick ? "within " + input.thickness.asked.thickness.text + " of itself" : "itself";
    const std::string exceptions = exceptions_text(answer);
    const std::string where = s.moves || input.is_one_pose ? frames : "";
    const std::string clear =
        exceptions.empty() ? (is_thick ? "does not come " : "does not touch ") + near + where
                           : (is_thick ? "comes " : "touches ") + near + where + " only in " + exceptions;
    return (where.empty() ? "does not move" + frames + ", and " : "") + clear;
  }
  std::string text;
  if (cross > 0) text = "crosses itself at the start of " + of_intervals(cross, s);
  if (touch > 0)
    text += cross > 0 ? " and touches itself in " + std::to_string(touch) + " more"
                      : "touches itself in " + of_intervals(touch, s);
  if (close > 0)
    text += (text.empty() ? "comes within " : " and comes within ") + input.thickness.asked.thickness.text +
            " of itself in " + (text.empty() ? of_intervals(close, s) : std::to_string(close) + " more");
  const AnswerSummary::Meeting& first = *answer.first_named();
  text += joints_alone_text(answer) + apart + (&first == &*s.first ? ", first" : ", first away from joints") +
          " at " + moment_text(input, first.moment) + ": " + meeting_text(first.names, first.how);
  // Of what meets in the first frame, the next time that it meets is news.
  const bool at_start = first.moment.interval == s.first_index && first.moment.time == 0;
  if (const auto& again = s.first_after_parting; at_start && again && !answer.only_folds(again->names))
    text += "; once it had parted, again at " + moment_text(input, again->moment) + ": " +
            meeting_text(again->names, again->how);
  return text;
}

// "These only touch: hand_l and hips, thigh_r and itself, and 2 more pairs." What has a thickness is close
// before it touches, and there nothing is said.
std::string only_touching_text(const ClipAnswer& answer) {
  constexpr std::size_t kMost = 3;
  if (answer.input.thickness.length > 0) return {};
  std::map<NamePair, std::size_t> touching;
  // What crosses in the last pose alone has no start at which it does.
  const auto crosses = [&](const NamePair& both) {
    return std::ranges::any_of(answer.events, [&](const OverlapEvent& event) {
      return event.crosses && (event.names == both || event.names == NamePair{both.second, both.first});
    });
  };
  for (const auto& [both, here] : answer.summary.met)
    if (here.start_pairs == 0 && !answer.only_folds(both) && !crosses(both)) touching[both] = here.intervals;
  const auto sorted = most_first(touching);
  std::string out;
  for (std::size_t i = 0; i < std::min(kMost, sorted.size()); ++i)
    out += (i > 0 ? ", " : "") + meeting_text(sorted[i].first, "and");
  if (sorted.size() > kMost) out += ", and " + many(sorted.size() - kMost, "more pair");
  return out.empty() ? out : "These only touch: " + out + ".";
}

// What is said below the verdict, without full stops; empty where there is nothing to say.
struct Sentences {
  std::string lines, counts, thickness, worst, met, joints, ignored, rest, touching, coinciding, last,
      identical, proven, rate, choice;
};

Sentences sentences(const ClipAnswer& answer) {
  const Input& input = answer.input;
  const AnswerSummary& s = answer.summary;
  Sentences out;
  if (input.motion)
    out.lines = "straight lines between frames, of which the rest speaks: it " + verdict_predicate(answer);
  out.thickness = thickness_text(answer);
  if (answer.last_pose && answer.last_pose->start.total > 0)
    out.last = "ends crossed: " + many(answer.last_pose->start.total, "pair") +
               " of triangles cross in its last pose, " + moment_text(input, {answer.last_pose->index, 0});
  if (const std::size_t twins = identical_triangles(input.mesh); twins > 0)
    out.identical = identical_text(twins);
  out.counts =
      many(s.intervals(), "interval") + ": " + std::to_string(s.verdicts[IntervalVerdict::clear]) +
      " clear, " +
      (input.thickness.length > 0 ? std::to_string(s.verdicts[IntervalVerdict::close]) + " close, " : "") +
      std::to_string(s.verdicts[IntervalVerdict::touches]) + " touch, " +
      std::to_string(s.verdicts[IntervalVerdict::intersects_at_start]) + " cross at their start";
  if (s.verdicts[IntervalVerdict::undecided] > 0)
    out.counts += ", " + std::to_string(s.verdicts[IntervalVerdict::undecided]) + " undecided";
  if (s.worst) {
    out.worst = "worst: interval " + std::to_string(s.worst->moment.interval) + ", from " +
                moment_text(input, {s.worst->moment.interval, 0}) + ": ";
    if (s.worst->start_pairs > 0)
      out.worst += many(s.worst->start_pairs, "pair") + " of triangles cross at its start, and ";
    out.worst += many(s.worst->contacts, input.thickness.length > 0 ? "close pair" : "contact");
  }
  if (!s.met.empty()) {
    std::map<NamePair, std::size_t> intervals;
    for (const auto& [both, here] : s.met)
      if (!answer.only_folds(both)) intervals[both] = here.intervals;
    if (!intervals.empty()) out.met = "met: " + listed(intervals, met_text);
    out.joints = joints_text(answer);
  }
  if (input.ignored) out.ignored = ignored_text(input, s);
  // A simulation that starts crossed has no pose at rest, and what it begins with may be what is looked
  // for. One pose alone is told by the verdict.
  const std::string at = input.clip->header().rest.empty()
                             ? "at rest (the first frame, as the input names no pose at rest): "
                             : "at rest: ";
  if (answer.rest.total > 0) {
    const AtRest rest = at_rest(answer);
    const std::string counted = answer.rest_left_out ? "; left out of " + many(s.with_left_out, "interval") +
                                                           ", with " + many(s.left_out_contacts, "contact") +
                                                           " (--keep-rest-crossings counts both)"
                                : input.is_one_pose ? ""
                                                    : "; counted, as asked";
    if (!rest.crossing.empty() && (!input.is_one_pose || answer.rest_left_out))
      out.rest = "crosses " + at +
                 listed(rest.crossing,
                        [](const NamePair& both, std::size_t count) {
                          return with_itself_or_in(both, " in ") + many(count, "pair");
                        }) +
                 counted;
    if (!rest.coinciding.empty())
      out.coinciding = "lies on itself at rest, as copies of one surface do: " +
                       listed(rest.coinciding,
                              [&](const NamePair& both, std::size_t count) {
                                return with_itself_or_in(both, " on ") +
                                       many(rest.same.at(both), "triangle") + " in one place, " +
                                       many(count, "pair") + " that meet";
                              }) +
                       (out.rest.empty() || !answer.rest_left_out ? counted : "; left out with those");
  }
  if (answer.rest_touching.total > 0 && !input.is_one_pose)
    out.touching = "only touches " + at +
                   listed(pairs_by_part(answer.names, input.mesh, answer.rest_touching),
                          [](const NamePair& both, std::size_t count) {
                            return with_itself_or_in(both, " on ") + many(count, "pair");
                          }) +
                   "; counted (--ignore A:B leaves two parts out)";
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

}  // namespace

std::string subject_text(const Input& input) {
  const std::string name = short_name(input.name);
  if (!input.import) return name;
  const scenes::ImportReport& report = *input.import;
  std::string rest;
  if (const std::string clip = clip_title(report); !clip.empty()) rest += ", " + clip;
  if (const std::size_t chosen = report.chosen_components.size(); chosen < report.components)
    rest += (chosen == 1 ? ", component " + std::to_string(report.chosen_components[0])
                         : ", " + std::to_string(chosen) + " components") +
            " of " + std::to_string(report.components) + " alone";
  return name + rest;
}

std::vector<std::string> verdict_exceptions(const ClipAnswer& answer) {
  const AnswerSummary& s = answer.summary;
  std::vector<std::string> out;
  const bool is_deeper =
      std::ranges::any_of(answer.events, [](const OverlapEvent& event) { return event.at_rest.has_value(); });
  if (s.with_left_out > 0 || is_deeper)
    out.push_back(is_deeper ? "what crosses at rest, which comes to lie deeper than there"
                            : "what crosses at rest");
  if (s.with_ignored > 0) out.push_back("what is ignored");
  if (s.with_old > 0) out.push_back("what lies in itself already");
  return out;
}

std::string identical_text(std::size_t triangles) {
  return many(triangles, "triangle") + (triangles == 1 ? " has" : " have") +
         " the same three corners as another one: two such are never held against each other";
}

DepthCheck check_depth(const ClipAnswer& answer, const WrittenLength& most) {
  const double length = most.length(length_scale(answer.input));
  const std::string limit = "--fail-deeper-than " + length_text(answer.input, most) + ": ";
  // A start of which nothing is known may be too deep.
  if (answer.not_measured > 0) return {true, limit + "fails, because some starts were not measured"};
  // Triangles with the same three corners leave bounds of depths in doubt.
  const bool is_bound_in_doubt = identical_triangles(answer.input.mesh) > 0;
  double lower = 0, upper = 0, unknown = -1;
  for (const OverlapEvent& event : answer.events) {
    if (!event.crosses) continue;  // what only touches lies in nothing
    lower = std::max(lower, event.depth.lower), upper = std::max(upper, event.depth.upper);
    if (!is_known(event.depth) && (is_bound_in_doubt || event.depth.upper > length))
      unknown = std::max(unknown, event.depth.upper);
  }
  if (lower > length)
    return {true, limit + "fails, because something lies deeper: " + distance_text(answer.input, lower)};
  if (unknown >= 0)
    return {true, limit + "fails, because a depth is not known" +
                      (is_bound_in_doubt ? ", as triangles have the same three corners"
                                         : ": at most " + distance_text(answer.input, unknown))};
  std::string text = limit + "passes: nothing is known to lie deeper";
  if (upper > length) text += ", and something may lie up to " + distance_text(answer.input, upper) + " deep";
  if (answer.rest.total > 0 && answer.rest_left_out)
    text += "; what crosses at rest counts where it lies deeper than there";
  if (answer.rest_left_out && !at_rest(answer).coinciding.empty())
    text += "; how far copies that lie on each other at rest slide before they part is not measured";
  return {false, text};
}

std::vector<std::string> verdict_sentences(const ClipAnswer& answer) {
  const std::string predicate =
      answer.input.motion
          ? true_predicate(answer.input, answer.true_motion, frames_text(answer), exceptions_text(answer))
          : verdict_predicate(answer);
  const std::string subject = subject_text(answer.input);
  const std::optional<std::size_t> worst = worst_event(answer);
  if (!worst) return {subject + (subject == short_name(answer.input.name) ? " " : ", ") + predicate + "."};
  std::vector<std::string> out{subject + ": " + worst_text(answer.input, answer.events[*worst]) + "."};
  if (const std::string touching = only_touching_text(answer); !touching.empty()) out.push_back(touching);
  out.push_back("It " + predicate + ".");
  return out;
}

std::string verdict_text(const ClipAnswer& answer) {
  return joined(verdict_sentences(answer), " ");
}

namespace {

// Each sentence on a line of its own.
std::string verdict_lines(const ClipAnswer& answer) {
  return joined(verdict_sentences(answer), "\n  ") + "\n";
}

std::string not_measured_text(const ClipAnswer& answer) {
  if (answer.not_measured == 0) return {};
  return "  at the start of " + many(answer.not_measured, "interval") + " more than " +
         std::to_string(OverlapEvents::kMostPairs) + " pairs cross, too many to say what lies in what\n";
}

// Events, deepest first: those that are no folds at joints, and those that are.
struct ToldApart {
  std::vector<std::size_t> others, folds;
};

ToldApart told_apart(const ClipAnswer& answer) {
  ToldApart out;
  for (const std::size_t i : deepest_first(answer.events))
    (answer.joints.fold(answer.events[i]) ? out.folds : out.others).push_back(i);
  return out;
}

// "lies in itself in 2 places and touches itself at starts in 1 place, and at joints in 3 more".
std::string places_text(const ClipAnswer& answer) {
  const ToldApart events = told_apart(answer);
  const auto crossing = static_cast<std::size_t>(
      std::ranges::count_if(events.others, [&](std::size_t i) { return answer.events[i].crosses; }));
  const std::size_t touching = events.others.size() - crossing;
  const std::string places = (crossing > 0 ? "lies in itself in " + many(crossing, "place") : "") +
                             (crossing > 0 && touching > 0 ? " and " : "") +
                             (touching > 0 ? "touches itself at starts in " + many(touching, "place") : "");
  if (events.folds.empty()) return places;
  return places.empty() ? "folds onto itself at joints in " + many(events.folds.size(), "place")
                        : places + ", and at joints in " + std::to_string(events.folds.size()) + " more";
}

std::string events_text(const ClipAnswer& answer) {
  const std::vector<OverlapEvent>& events = answer.events;
  std::string out = not_measured_text(answer);
  if (events.empty()) return out;
  const std::vector<std::size_t> order = told_apart(answer).others;
  out += "  " + places_text(answer) +
         (order.size() > kMostEvents ? "; deepest in:"
          : order.empty()            ? ""
                                     : ":") +
         "\n";
  for (std::size_t i = 0; i < std::min(kMostEvents, order.size()); ++i)
    out += "    " + event_text(answer.input, events[order[i]]) + "\n";
  std::size_t within = 0;
  for (const OverlapEvent& event : events) within += event.contacts;
  if (answer.summary.with_old > 0)
    out += "    left out, as asked: " + many(answer.summary.old_contacts, "contact") + " and " +
           many(answer.summary.old_pairs, "crossing pair") + " of triangles within these, in " +
           many(answer.summary.with_old, "interval") + "\n";
  else if (within > 0)
    out += "    " + many(within, "contact") + " within these; all others are new\n";
  return out;
}

}  // namespace

std::string clip_text(const ClipAnswer& answer) {
  const AnswerSummary& s = answer.summary;
  const Sentences said = sentences(answer);
  std::string out = verdict_lines(answer) + true_motion_text(answer.input, answer.true_motion);
  for (const std::string* line :
       {&said.lines, &said.counts, &said.thickness, &said.worst, &said.met, &said.joints, &said.ignored,
        &said.rest, &said.touching, &said.coinciding, &said.last, &said.identical, &said.proven})
    if (!line->empty()) out += "  " + *line + "\n";
  out += events_text(answer);
  return out + "  took " + short_text(s.wall_ms) + " ms: " + short_text(s.query_ms) + " to find contacts, " +
         short_text(s.embedding_ms) + " to know what crosses at the starts; " +
         (s.overlap_ms > 0 ? short_text(s.overlap_ms) + " ms to measure what lies in what, " : "") +
         short_text(answer.preparation_ms) + " ms to prepare and " + short_text(s.load_ms) +
         " ms to read frames came on top\n";
}

std::string brief_clip_text(const ClipAnswer& answer) {
  std::string out = verdict_lines(answer) + not_measured_text(answer);
  const Sentences said = sentences(answer);
  if (answer.summary.proven < answer.summary.intervals()) out += "  " + said.proven + "\n";
  for (const std::string* line :
       {&said.ignored, &said.rest, &said.touching, &said.coinciding, &said.last, &said.identical})
    if (!line->empty()) out += "  " + *line + "\n";
  if (!answer.events.empty()) {
    const std::vector<std::size_t> others = told_apart(answer).others;
    const bool is_news = !others.empty() && worst_event(answer) != others.front();
    out += "  " + places_text(answer) +
           (is_news ? "; deepest: " + event_text(answer.input, answer.events[others.front()]) : "") + "\n";
  }
  if (answer.input.motion) out += true_motion_text(answer.input, answer.true_motion);
  return out;
}

std::string details_text(const ClipAnswer& answer) {
  const Sentences said = sentences(answer);
  std::string out;
  for (const std::string* sentence :
       {&said.lines, &said.counts, &said.thickness, &said.worst, &said.ignored, &said.rest, &said.touching,
        &said.coinciding, &said.last, &said.identical, &said.proven, &said.rate, &said.choice}) {
    if (sentence->empty()) continue;
    std::string capital = *sentence;
    capital[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(capital[0])));
    out += (out.empty() ? "" : " ") + capital + ".";
  }
  return out;
}

}  // namespace cscd::bench
