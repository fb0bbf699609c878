#pragma once

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "bench/query/answer/answer.h"
#include "bench/query/answer/answer_json.h"
#include "bench/query/answer/surface_names.h"

// Sums up all answers of a clip, for people and in JSON.
namespace cscd::bench {

struct AnswerSummary {
  std::array<std::size_t, 4> verdicts{};          // by IntervalVerdict
  std::map<std::string, std::size_t> strategies;  // how many intervals each answered
  std::size_t proven = 0;
  std::size_t with_left_out = 0;                // intervals from which something was left out
  bool moves = false;                           // more than by rounding
  std::size_t first_index = 0, last_index = 0;  // of the intervals, which come in growing order
  // The first moment at which something touches or crosses, and the names of what meets.
  struct Meeting {
    ClipMoment moment;
    bool crosses = false;  // else touches
    std::pair<std::string, std::string> names;
  };
  std::optional<Meeting> first;
  // The interval in which most goes wrong: most pairs of triangles that cross at its start, or, where none
  // cross anywhere, most contacts.
  struct Worst {
    ClipMoment moment;
    std::size_t start_pairs = 0, contacts = 0;
  };
  std::optional<Worst> worst;
  // Bones, or else parts, that met: in how many intervals.
  std::map<std::pair<std::string, std::string>, std::size_t> met;
  // What is ignored, by bones or else parts.
  struct IgnoredHere {
    std::size_t intervals = 0, start_pairs = 0, contacts = 0;
  };
  std::map<std::pair<std::string, std::string>, IgnoredHere> ignored;
  std::size_t with_ignored = 0;  // intervals in which something is
  double embedding_ms = 0, query_ms = 0, load_ms = 0, wall_ms = 0;
  double preparation_ms = 0;  // set by the caller

  std::size_t intervals() const;
  std::size_t count(IntervalVerdict verdict) const { return verdicts[static_cast<std::size_t>(verdict)]; }
  bool collides() const {
    return count(IntervalVerdict::touches) + count(IntervalVerdict::intersects_at_start) > 0;
  }
  // The worst verdict of any interval.
  IntervalVerdict verdict() const;
  // `motion` is that of the interval.
  void add(const IntervalAnswer& answer, const Motion& motion, const SurfaceNames& names);

 private:
  void add_ignored(const IntervalAnswer& answer, const SurfaceNames& names);
};

// One sentence that says what was asked about, does it touch or cross itself, how often, and when first.
// Texts, pages and JSON all show this sentence.
std::string verdict_sentence(const Input& input, const AnswerSummary& summary);

// What is said below the verdict, without full stops; empty where there is nothing to say.
struct SummarySentences {
  std::string counts, worst, met, ignored, rest, proven, rate, choice;
};
SummarySentences summary_sentences(const Input& input, const SurfaceNames& names,
                                   const AnswerSummary& summary, const Crossings& rest, bool left_out);
// The same as one paragraph, for a page that lists by itself what met.
std::string details_text(const SummarySentences& said);

nlohmann::json summary_json(const Input& input, const AnswerSummary& summary);

// Several lines, the verdict first. `rest` is what crosses at rest; `left_out` says whether it is left out.
std::string summary_text(const Input& input, const SurfaceNames& names, const AnswerSummary& summary,
                         const Crossings& rest, bool left_out);

}  // namespace cscd::bench
