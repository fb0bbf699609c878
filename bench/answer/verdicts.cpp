#include "bench/answer/verdicts.h"

#include <nlohmann/json.hpp>
#include <string>

namespace cscd::bench {

IntervalVerdict VerdictCounts::worst() const {
  using enum IntervalVerdict;
  for (const IntervalVerdict verdict : {intersects_at_start, touches, close, undecided})
    if ((*this)[verdict] > 0) return verdict;
  return clear;
}

std::string meeting_text(const NamePair& both, const std::string& verb) {
  return both.first + " " + verb + " " + (both.first == both.second ? "itself" : both.second);
}

std::string meeting_text(const NamePair& both, IntervalVerdict how) {
  return meeting_text(both, how == IntervalVerdict::intersects_at_start ? "crosses"
                            : how == IntervalVerdict::close             ? "comes close to"
                                                                        : "touches");
}

nlohmann::json verdict_counts_json(const VerdictCounts& verdicts, bool may_be_close) {
  using enum IntervalVerdict;
  nlohmann::json out;
  for (const IntervalVerdict verdict : {clear, touches, intersects_at_start, undecided, close})
    if (may_be_close || verdict != close) out[std::string(to_string(verdict))] = verdicts[verdict];
  return out;
}

}  // namespace cscd::bench
