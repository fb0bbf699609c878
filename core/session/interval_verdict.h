#pragma once

#include <cstddef>
#include <map>
#include <string_view>

namespace cscd {

// What is known of an interval: of straight lines, or of the true paths of a span of time (core/soundness.md,
// "The true motion"). Pages of the viewer know verdicts by their numbers (page/src/words.js).
enum class IntervalVerdict {
  clear,  // nothing crosses at the start, and nothing touches
  // Nothing crosses at the start, and something touches, at the start or later. Of true paths it is proven by
  // an edge that pierces a face at one moment and is apart from it at another, or by triangles that touch at
  // the start or after a jump.
  touches,
  intersects_at_start,  // triangles cross at the start, or of true paths, after a jump within the span
  // Nothing crosses, and it cannot be told whether something touches: by an inexact elementary test, or by
  // the bounds on true paths.
  undecided,
  // Nothing crosses or touches, and something comes within the thickness. Of true paths: two features come
  // within a distance, and what they do there cannot be told apart.
  close
};
std::string_view to_string(IntervalVerdict verdict);

// Whether something touches or crosses.
constexpr bool meets(IntervalVerdict verdict) {
  return verdict == IntervalVerdict::touches || verdict == IntervalVerdict::intersects_at_start;
}
// Whether something touches, crosses, or comes within the thickness.
constexpr bool collides(IntervalVerdict verdict) {
  return meets(verdict) || verdict == IntervalVerdict::close;
}

// How many intervals have each verdict.
class VerdictCounts {
 public:
  void add(IntervalVerdict verdict) { ++counts_[verdict], ++total_; }
  std::size_t operator[](IntervalVerdict verdict) const {
    const auto found = counts_.find(verdict);
    return found == counts_.end() ? 0 : found->second;
  }
  std::size_t total() const { return total_; }
  // The worst verdict of any interval: intersects_at_start, then touches, close, undecided and clear.
  IntervalVerdict worst() const;

 private:
  std::map<IntervalVerdict, std::size_t> counts_;
  std::size_t total_ = 0;
};

}  // namespace cscd
