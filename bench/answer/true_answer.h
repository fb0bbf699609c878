#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "bench/answer/answer.h"
#include "bench/answer/verdicts.h"
#include "bench/inputs/surface_names.h"
#include "core/session/true_motion.h"

// Answers about the true motion of a model file beside those about straight lines between its frames.
namespace cscd::bench {

class TrueAnswerer {
 public:
  // Throws InputError where the input or the elementary test does not fit. `rest` is what crosses at rest.
  // All arguments must outlive it.
  TrueAnswerer(const Input& input, const ElementaryTest& elementary, const Crossings& rest,
               const AnswerOptions& options, const WrittenLength& resolution = {});

  // Adds to an answer about straight lines, whose motion is given, what is known of the true motion.
  // Intervals come in growing order.
  void answer(const Motion& straight, IntervalAnswer& answer);
  // Where all vertices are at a second of the clip.
  std::span<const Vec3> positions_at(double seconds) { return motion_.positions_at(seconds); }

 private:
  const Input& input_;
  RestCrossings left_out_;
  TrueMotion motion_;
  std::optional<double> clear_until_;  // the end of the last interval, if that is clear
};

// Whether the true motion touches or crosses and straight lines do not, or the other way round, as far as the
// true motion is known to do one or the other.
bool differs(const IntervalAnswer& answer);

// Sums up the true motion of a clip.
struct TrueSummary {
  VerdictCounts verdicts;
  // Intervals that touch or cross by one motion alone: by the true one, and by straight lines.
  std::size_t only_true = 0, only_straight = 0;
  std::size_t parts = 0, pieces = 0, jumps = 0;
  double deviation = 0, ms = 0;   // deviation: the largest bound that is finite
  std::size_t without_bound = 0;  // intervals of which a vertex has none as a whole
  std::size_t not_asked = 0;      // intervals at whose start something meets
  // The first contact or crossing of all, and the first that straight lines do not have.
  struct Meeting {
    std::size_t interval = 0;
    TrueAnswer answer;
    NamePair names;
  };
  std::optional<Meeting> first, first_missed;

  std::size_t intervals() const { return verdicts.total(); }
  std::size_t bounded() const { return intervals() - without_bound - not_asked; }
  IntervalVerdict verdict() const { return verdicts.worst(); }
  void add(const IntervalAnswer& answer, const SurfaceNames& names);
};

// What the clip does in its true motion, as the predicate of a sentence. `frames` are those that were asked
// about, and `exceptions` says what is left out; empty for nothing.
std::string true_predicate(const Input& input, const TrueSummary& summary, const std::string& frames,
                           const std::string& exceptions);
// Lines for people, of two blanks and a sentence each; empty where no true motion was asked for and none is
// known.
std::string true_motion_text(const Input& input, const TrueSummary& summary);
// Of an interval, and of the whole clip.
nlohmann::json true_motion_json(const Input& input, const IntervalAnswer& answer);
nlohmann::json true_motion_json(const Input& input, const TrueSummary& summary);

}  // namespace cscd::bench
