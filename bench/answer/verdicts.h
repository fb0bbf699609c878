#pragma once

#include <array>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bench/inputs/surface_names.h"
#include "core/session/interval_verdict.h"

namespace cscd::bench {

// Whether something touches or crosses.
constexpr bool meets(IntervalVerdict verdict) {
  return verdict == IntervalVerdict::touches || verdict == IntervalVerdict::intersects_at_start;
}
// Whether something touches, crosses, or comes within the thickness.
constexpr bool collides(IntervalVerdict verdict) {
  return meets(verdict) || verdict == IntervalVerdict::close;
}

// How many intervals, or clips, have each verdict.
class VerdictCounts {
 public:
  void add(IntervalVerdict verdict) { ++counts_[static_cast<std::size_t>(verdict)], ++total_; }
  std::size_t operator[](IntervalVerdict verdict) const { return counts_[static_cast<std::size_t>(verdict)]; }
  std::size_t total() const { return total_; }
  // The worst verdict of any interval: intersects_at_start, then touches, close, undecided and clear.
  IntervalVerdict worst() const;

 private:
  std::array<std::size_t, 5> counts_{};  // [verdicts]
  std::size_t total_ = 0;
};

// "hand_l touches hips", "tail crosses itself", "tail comes close to hand_l".
std::string meeting_text(const NamePair& both, IntervalVerdict how);
// "hand_l and hips", "tail and itself".
std::string meeting_text(const NamePair& both, const std::string& verb);

// The counts by the names of the verdicts; that of `close` where it may occur.
nlohmann::json verdict_counts_json(const VerdictCounts& verdicts, bool may_be_close);

}  // namespace cscd::bench
