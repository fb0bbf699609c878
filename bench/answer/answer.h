#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "bench/input/input.h"
#include "core/detect/contact.h"
#include "core/detect/detector.h"
#include "core/detect/start/crossings.h"
#include "core/detect/start/pose_crossings.h"
#include "core/detect/start/rest_crossings.h"
#include "core/detect/strategy.h"

namespace cscd::bench {

enum class IntervalVerdict {
  clear,                // nothing crosses at the start, and nothing touches
  touches,              // nothing crosses at the start, and something touches
  intersects_at_start,  // triangles cross at the start
  undecided  // nothing crosses, and an inexact elementary test could not tell whether something touches
};
std::string_view to_string(IntervalVerdict verdict);

// The answer to one interval. Contacts and crossings that crossings at rest explain (see RestCrossings) are
// left out of everything but the two counts that say so.
struct IntervalAnswer {
  std::size_t index = 0;
  IntervalVerdict verdict = IntervalVerdict::clear;
  ContactSet found;                    // sorted
  Crossings start;                     // pairs of triangles that cross at the start
  std::size_t rest_pairs = 0;          // of the pairs that cross at rest, how many cross at this start
  std::size_t rest_contacts = 0;       // contacts left out, as a pair that crosses at rest carries them
  bool starts_embedded = true;         // nothing crosses at the start, pairs that cross at rest included
  const Strategy* strategy = nullptr;  // that answered
  bool proven = false;  // contacts and time are right by the strategy's guarantee and the elementary test
  Report report;
  double embedding_ms = 0;  // what it took to know which triangles cross at the start
  double load_ms = 0;       // what it took to read both frames
  double wall_ms = 0;       // from the call to the answer, without the reading of frames

  std::optional<double> time() const;  // of the earliest decided contact
};

struct AnswerOptions {
  bool first = false;                // only the contacts of the earliest time
  bool unproven = false;             // no stand-in where the strategy's guarantee is void
  bool keep_rest_crossings = false;  // nothing is left out
};

// Answers the intervals of an input, best in growing order: what one interval proves says which triangles
// cross at the start of the next (see PoseCrossings).
class Answerer {
 public:
  // Prepares the strategy. Throws InputError where the input lacks what the strategy needs, where options do
  // not go together, and where too many triangles cross at rest. `input` must outlive it.
  Answerer(Input& input, const Strategy& strategy, const ElementaryTest& elementary,
           const AnswerOptions& options);

  IntervalAnswer answer(std::size_t interval);

  // Milliseconds that it took to prepare the strategy and to find what crosses at rest.
  double preparation_ms() const { return preparation_ms_ + rest_ms_; }
  // The triangles that cross at rest. They are left out of answers unless the options keep them.
  const Crossings& rest_crossings() const { return rest_; }
  int threads() const { return main_.threads; }

 private:
  struct Row {
    const Strategy* strategy = nullptr;
    std::unique_ptr<Detector> detector;
    int threads = 1;
  };
  Row make(const Strategy& strategy) const;
  Row& stand_in();
  // Whether the answers of a row hold all contacts of a motion whose start is embedded or not.
  bool finds_all(const Row& row) const;
  // Finds from nothing which triangles cross in a pose.
  void find_crossings(std::span<const Vec3> pose);
  void know_start(const scenes::ClipInterval& interval);
  void know_end(const scenes::ClipInterval& interval, const Row& row, const ContactSet& found);
  std::size_t leave_out(ContactSet& found) const;

  Input& input_;
  const ElementaryTest& elementary_;
  AnswerOptions options_;
  Row main_;
  std::optional<Row> stand_in_;
  double preparation_ms_ = 0;  // of the strategy
  PoseCrossings poses_;
  double searched_ms_ = 0;  // that find_crossings() took so far
  double rest_ms_ = 0;      // that it took for the pose at rest
  bool searches_fast_ = false;
  Crossings rest_;
  RestCrossings left_out_;
  std::vector<Bone> pose_bones_;   // of the pose that poses_ knows
  std::vector<Vec3> touched_end_;  // the end of the last interval, where contacts kept it from being known
};

}  // namespace cscd::bench
