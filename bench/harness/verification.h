#pragma once

#include <map>
#include <memory>
#include <set>
#include <span>
#include <vector>

#include "bench/harness/contestant.h"
#include "bench/inputs/input.h"
#include "bench/records/record.h"
#include "core/detect/start/embedding.h"

namespace cscd::bench {

// Judges every contestant's contacts on intervals, each once, against those of the complete reference, both
// with the exact elementary test; and the timed elementary test on the reference's pairs. The reference
// itself is held against truth from outside where the input has some.
class Verifier {
 public:
  // `exact` and `timed` are the tests that the contestants were made with. Everything given must outlive the
  // verifier.
  Verifier(Input& input, std::span<Contestant> contestants, const ElementaryTest& exact,
           const ElementaryTest& timed);
  ~Verifier();

  // Judges those of the intervals that have not been judged before.
  void judge(std::span<const std::size_t> intervals);

  bool has_judged(std::size_t interval) const;
  // Whether an interval that was judged starts embedded, by a test that shares no culling with the timed one.
  bool starts_embedded(std::size_t interval) const;
  // A contestant's counters on an interval that was judged: whatever is timed has to repeat them.
  const Report& report(std::size_t contestant, std::size_t interval) const;
  // What was judged so far. Intervals are ascending.
  VerificationRecord record() const;

 private:
  class Reference;
  class OwnTest;
  void judge_one(std::size_t interval);

  Input& input_;
  std::span<Contestant> contestants_;
  std::unique_ptr<Reference> reference_;
  std::unique_ptr<EmbeddingTest> embedding_;
  std::map<std::size_t, std::vector<Report>> reports_;         // by interval: [contestants]
  std::map<std::size_t, std::unique_ptr<OwnTest>> own_tests_;  // by contestant
  std::set<std::size_t> crossing_starts_;                      // intervals that do not start embedded
  VerificationRecord record_;
};

}  // namespace cscd::bench
