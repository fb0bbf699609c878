#include "bench/answer/true_answer.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "bench/inputs/thickness.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"
#include "core/base/number_text.h"
#include "core/base/stopwatch.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

// Frames are that far from keys at most, as a share of the time between frames, where both are meant to be
// one: files hold times in single precision. The spans that are asked about then end at the keys.
constexpr double kAtKey = 1e-5;

// Frames and the paths are computed by different code, and at times that differ by what files round. They may
// differ by this share of the largest coordinate.
constexpr double kSamePlace = 1e-5;

TrueMotionOptions options_of(const Input& input, const RestCrossings& left_out, const AnswerOptions& options,
                             const WrittenLength& resolution) {
  if (input.thickness.length > 0)
    throw InputError("--true-motion: takes no --thickness; leave one of the two out");
  TrueMotionOptions out = true_motion_options(input.thickness.edge);
  require_unit(input, resolution, "--resolution");
  if (resolution.is_given()) out.resolution = resolution.length(length_scale(input));
  out.ignored = input.ignored ? &input.ignored->triangles : nullptr;
  out.left_out = options.keep_rest_crossings ? nullptr : &left_out;
  return out;
}

// How far a frame is from the positions of the motion through it, if that is too far.
std::optional<double> gap_between(const Motion& straight, std::span<const Vec3> positions) {
  double size = 0, off = 0;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    size = std::max(size, positions[v].cwiseAbs().maxCoeff());
    off = std::max(off, (positions[v] - straight.start()[v]).norm());
  }
  return off <= kSamePlace * size ? std::nullopt : std::optional(off);
}

double exact_second_of(const Input& input, std::size_t frame) {
  return second_of_frame(*input.import, frame, input.clip->frame_count());
}

double second_of(const Input& input, std::size_t frame) {
  return input.motion->at_corner(exact_second_of(input, frame), kAtKey / input.import->fps);
}

double at_share(const Input& input, std::size_t interval, double seconds) {
  const double from = second_of(input, interval), to = second_of(input, interval + 1);
  return std::clamp((seconds - from) / (to - from), 0.0, 1.0);
}

// Of a span at whose start something meets no more is asked, and nothing is known of how far it leaves
// straight lines.
TrueAnswer met_at(double time, bool crosses, const CrossingPair& pair) {
  TrueAnswer out{.verdict = crosses ? IntervalVerdict::intersects_at_start : IntervalVerdict::touches,
                 .from = time,
                 .to = time,
                 .pair = pair};
  out.deviation = std::numeric_limits<double>::infinity();
  return out;
}

std::string first_text(const Input& input, const TrueSummary::Meeting& first) {
  const auto frame = [&](double seconds) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.3f", frame_at(*input.import, seconds));
    return std::string(digits);
  };
  const TrueAnswer& answer = first.answer;
  return "at frame " + frame(answer.from) + (answer.to > answer.from ? " to " + frame(answer.to) : "") +
         " (" + short_text(answer.to) + " s): " + meeting_text(first.names, answer.verdict);
}

}  // namespace

TrueAnswerer::TrueAnswerer(const Input& input, const ElementaryTest& elementary, const Crossings& rest,
                           const AnswerOptions& options, const WrittenLength& resolution)
    : input_(input),
      left_out_(input.mesh, rest),
      motion_(*input.motion, input.setup(elementary), complete_fallback(),
              options_of(input, left_out_, options, resolution)) {}

void TrueAnswerer::answer(const Motion& straight, IntervalAnswer& answer) {
  const Stopwatch asking;
  left_out_.follow(all_meetings(answer));
  const double from = second_of(input_, answer.index), to = second_of(input_, answer.index + 1);
  const Crossings& met = answer.start.total > 0 ? answer.start : answer.start_touching;
  if (met.total > 0) {
    answer.motion = met_at(from, answer.start.total > 0, met.pairs.front());
  } else if (gap_between(straight, motion_.positions_at(from))) {
    // The surface moves far between the frame and the key that stands for it: the frame's start is not known
    // to be the key's.
    const double frame = exact_second_of(input_, answer.index);
    if (const std::optional<double> gap = gap_between(straight, motion_.positions_at(frame)))
      throw InputError("--true-motion: frame " + std::to_string(answer.index) +
                       " and the motion through it are " + exact_text(*gap) +
                       " apart, which is a fault of this program; ask about straight lines, without it");
    answer.motion = TrueAnswer{.verdict = IntervalVerdict::undecided,
                               .from = from,
                               .to = to,
                               .deviation = std::numeric_limits<double>::infinity()};
  } else {
    // What ends clear starts the next interval without crossings. Elsewhere the true pose is searched,
    // because that of the frame is another by rounding.
    const auto met_here = clear_until_ == from ? std::nullopt : motion_.meeting_at(from);
    answer.motion = met_here ? met_at(from, met_here->crosses, met_here->pair) : motion_.answer(from, to);
  }
  clear_until_ = answer.motion->verdict == IntervalVerdict::clear ? std::optional(to) : std::nullopt;
  answer.motion_ms = asking.milliseconds();
}

bool differs(const IntervalAnswer& answer) {
  if (!answer.motion) return false;
  const IntervalVerdict own = answer.motion->verdict;
  const bool is_known = meets(own) || own == IntervalVerdict::clear;
  return is_known && meets(own) != meets(answer.verdict);
}

void TrueSummary::add(const IntervalAnswer& answer, const SurfaceNames& names) {
  if (!answer.motion) return;
  const TrueAnswer& own = *answer.motion;
  verdicts.add(own.verdict);
  parts += own.parts, pieces += own.pieces, jumps += own.jumps;
  ms += answer.motion_ms;
  if (own.parts == 0)
    ++not_asked;
  else if (own.deviation < std::numeric_limits<double>::infinity())
    deviation = std::max(deviation, own.deviation);
  else
    ++without_bound;
  if (differs(answer)) ++(meets(own.verdict) ? only_true : only_straight);
  if (!meets(own.verdict) || !own.pair) return;
  const Meeting here{answer.index, own, {names.place_of(own.pair->first), names.place_of(own.pair->second)}};
  if (!first) first = here;
  if (!first_missed && differs(answer)) first_missed = here;
}

std::string true_predicate(const Input& input, const TrueSummary& s, const std::string& frames,
                           const std::string& exceptions) {
  const std::string apart = exceptions.empty() ? "" : ", apart from " + exceptions;
  const auto in = [&](IntervalVerdict verdict) {
    return " in " + std::to_string(s.verdicts[verdict]) + " of " + std::to_string(s.intervals()) +
           " intervals of its true motion";
  };
  const std::size_t touch = s.verdicts[IntervalVerdict::touches];
  std::string text;
  switch (s.verdict()) {
    case IntervalVerdict::intersects_at_start:
      text = "crosses itself" + in(IntervalVerdict::intersects_at_start) +
             (touch > 0 ? " and touches itself in " + std::to_string(touch) + " more" : "");
      break;
    case IntervalVerdict::touches:
      text = "touches itself" + in(IntervalVerdict::touches);
      break;
    case IntervalVerdict::close:
      return "comes too close to itself to tell whether it touches" + in(IntervalVerdict::close) + apart;
    case IntervalVerdict::undecided:
      return "may touch itself, which is undecided" + in(IntervalVerdict::undecided) + apart;
    case IntervalVerdict::clear:
      return (exceptions.empty() ? "does not touch itself" : "touches itself") +
             (" in its true motion" + frames) + (exceptions.empty() ? "" : " only in " + exceptions);
  }
  text += apart;
  return s.first ? text + ", first " + first_text(input, *s.first) : text;
}

std::string true_motion_text(const Input& input, const TrueSummary& s) {
  if (!input.import || input.bone_names.empty() || input.is_one_pose) return {};
  if (!input.motion)
    return "  answered for straight lines between frames; --true-motion asks about the paths on which bones "
           "carry "
           "the surface\n";
  const auto part = [&](IntervalVerdict verdict, const char* words) {
    return s.verdicts[verdict] > 0 ? std::to_string(s.verdicts[verdict]) + " " + words + ", " : std::string();
  };
  std::string out =
      "  true motion: " + part(IntervalVerdict::clear, "clear") + part(IntervalVerdict::touches, "touch") +
      part(IntervalVerdict::close, "too close to tell") + part(IntervalVerdict::undecided, "undecided") +
      part(IntervalVerdict::intersects_at_start, "cross at their start or after a jump");
  out.resize(out.size() - 2);
  out += "\n  straight lines between frames ";
  if (s.only_true > 0) out += "miss contacts in " + std::to_string(s.only_true) + " of these intervals";
  if (s.first_missed && s.first_missed->interval != s.first->interval)
    out += ", first " + first_text(input, *s.first_missed);
  if (s.only_straight > 0)
    out += (s.only_true > 0 ? "; they have contacts in " : "have contacts in ") +
           std::to_string(s.only_straight) + " in which the true motion has none";
  if (s.only_true + s.only_straight == 0) out += "agree with it in every interval that is decided";
  if (s.not_asked == s.intervals()) {
    out += "\n  something meets at the start of every interval, and no more is asked of such";
  } else if (s.bounded() == 0) {
    out += "\n  of no interval as a whole is it known how far the surface leaves straight lines";
  } else {
    out += "\n  the surface leaves straight lines by at most " + distance_text(input, s.deviation) +
           (s.jumps > 0 ? " between jumps" : "");
    if (input.thickness.edge > 0)
      out += " (" + short_text(s.deviation / input.thickness.edge) + " mean edges)";
    if (s.without_bound > 0)
      out += ", apart from " + std::to_string(s.without_bound) + " intervals without a bound";
    if (s.not_asked > 0)
      out += ", apart from " + std::to_string(s.not_asked) + " at whose start something meets";
  }
  if (s.jumps > 0)
    out += "; it jumps " + std::string(s.jumps == 1 ? "once" : std::to_string(s.jumps) + " times") +
           ", and nothing is asked of the way across a jump";
  return out + "; this took " + short_text(s.ms) + " ms more\n";
}

json true_motion_json(const Input& input, const IntervalAnswer& answer) {
  const TrueAnswer& own = *answer.motion;
  const bool bounded = own.deviation < std::numeric_limits<double>::infinity();
  json pair;
  if (own.pair) pair = {static_cast<int>(own.pair->first), static_cast<int>(own.pair->second)};
  return {{"verdict", to_string(own.verdict)},
          {"differs", differs(answer)},
          {"from", at_share(input, answer.index, own.from)},
          {"to", at_share(input, answer.index, own.to)},
          {"within", own.verdict == IntervalVerdict::close ? json(own.within) : json()},
          {"pair", std::move(pair)},
          {"parts_again", own.parts_again},
          {"deviation", bounded ? json(own.deviation) : json()},
          {"parts", own.parts},
          {"pieces", own.pieces},
          {"jumps", own.jumps},
          {"ms", answer.motion_ms}};
}

json true_motion_json(const Input& input, const TrueSummary& s) {
  json first;
  if (s.first)
    first = {{"interval", s.first->interval},
             {"from", at_share(input, s.first->interval, s.first->answer.from)},
             {"to", at_share(input, s.first->interval, s.first->answer.to)},
             {"first", s.first->names.first},
             {"second", s.first->names.second}};
  json out = verdict_counts_json(s.verdicts, true);
  out.update({{"verdict", to_string(s.verdict())},
              {"only_true", s.only_true},
              {"only_straight", s.only_straight},
              {"first", std::move(first)},
              {"deviation", s.bounded() > 0 ? json(s.deviation) : json()},
              {"without_bound", s.without_bound},
              {"not_asked", s.not_asked},
              {"parts", s.parts},
              {"pieces", s.pieces},
              {"jumps", s.jumps},
              {"ms", s.ms}});
  return out;
}

}  // namespace cscd::bench
