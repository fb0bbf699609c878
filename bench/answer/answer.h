#pragma once

#include <map>
#include <optional>

#include "bench/inputs/input.h"
#include "core/session/interval_verdict.h"
#include "core/session/session.h"
#include "core/session/true_motion.h"

namespace cscd::bench {

// The answer to one interval of a clip.
struct IntervalAnswer : StepAnswer {
  std::size_t index = 0;
  // Pairs of triangles that meet at the start and only touch there (Meetings); `start` holds those that
  // cross.
  Crossings start_touching;
  IntervalVerdict verdict = IntervalVerdict::clear;
  double load_ms = 0;  // what it took to read both frames, outside of `wall_ms`
  // With a thickness, contacts are close pairs. `touching` holds the earliest times at which those of them
  // touch that do. `close_at_start` counts those that are close when the interval starts.
  std::map<FeaturePair, double> touching;
  std::size_t close_at_start = 0;
  // [contacts], the numbers of the events to which they belong, because they are between pieces that lie in
  // each other when the interval starts; OverlapEvents::kNone for new contacts.
  std::vector<std::size_t> event_of_contact;
  // With --new-contacts: what is left out because it lies within events.
  std::size_t old_pairs = 0, old_contacts = 0;
  // What is known of the true motion, where that was asked for (TrueAnswerer). Everything else is about
  // straight lines.
  std::optional<TrueAnswer> motion = std::nullopt;
  double motion_ms = 0;
};

// The verdict that goes by what the answer holds.
IntervalVerdict verdict_of(const IntervalAnswer& answer, bool is_thick);

// All pairs that meet at the start, whether they cross or touch, and whether they are left out of the answer
// or not.
Crossings all_meetings(const IntervalAnswer& answer);

using AnswerOptions = SessionOptions;

// Answers the intervals of an input, best in growing order (see Session).
class Answerer {
 public:
  // Prepares the strategy. What the input says is ignored is no part of answers. Throws InputError where the
  // input lacks what the strategy needs, where options do not go together, and where too many triangles cross
  // at rest. `input` must outlive it.
  Answerer(const Input& input, const Strategy& strategy, const ElementaryTest& elementary,
           const AnswerOptions& options);

  // `interval` is the one with that number; or the pose of that frame, in which nothing moves, best after the
  // interval that ends there.
  IntervalAnswer answer(std::size_t index, const scenes::ClipInterval& interval);

  // Returns what preparing the strategy has found out; empty where it saves nothing.
  std::vector<std::byte> saved_preparation() const { return session_.saved_preparation(); }
  // Milliseconds that it took to prepare the strategy and to find what crosses at rest.
  double preparation_ms() const { return session_.preparation_ms(); }
  // How many triangles the preparation of the input did not know.
  std::size_t new_triangles() const { return session_.new_triangles(); }
  // The triangles that cross at rest, which are left out of answers until they part, and those that only
  // touch there, which are not (Session).
  const Crossings& rest_crossings() const { return session_.rest_crossings(); }
  const Crossings& rest_touching() const { return session_.rest_touching(); }
  int threads() const { return session_.threads(); }

 private:
  void tell_touching_from_crossing(const Motion& motion, IntervalAnswer& answer) const;
  void tell_touching_from_close(const Motion& motion, IntervalAnswer& answer) const;

  const Input& input_;
  const ElementaryTest& elementary_;
  Session session_;
};

}  // namespace cscd::bench
