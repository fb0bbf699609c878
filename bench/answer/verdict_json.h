#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/session/interval_verdict.h"

namespace cscd::bench {

// How many intervals, or clips, have each verdict; `close` where it may occur.
inline nlohmann::json counts_json(const VerdictCounts& verdicts, bool may_be_close) {
  using enum IntervalVerdict;
  nlohmann::json out;
  for (const IntervalVerdict verdict : {clear, touches, intersects_at_start, undecided, close})
    if (may_be_close || verdict != close) out[std::string(to_string(verdict))] = verdicts[verdict];
  return out;
}

}  // namespace cscd::bench
