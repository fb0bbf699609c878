#include "bench/answer/answer.h"

#include <algorithm>

#include "bench/strategies/catalogue.h"
#include "bench/strategies/strategy_row.h"
#include "core/base/error.h"
#include "core/base/memory.h"

namespace cscd::bench {
namespace {

AnswerOptions as_input_says(AnswerOptions options, const Input& input) {
  options.thickness = input.thickness.thickness();
  options.ignored = input.ignored ? &input.ignored->triangles : nullptr;
  return options;
}

// What a user is told who asked for more pairs than memory holds. `where` names the step.
InputError too_many_pairs(const MemoryShortage& shortage, const std::string& where, const Input& input) {
  return InputError(
      where + ": " + std::string(shortage.finding()) + "; give a smaller --thickness, leave " +
      (input.thickness.left_out ? "more neighbours out" : "neighbours out with --exclude-rings") +
      ", ask for the earliest alone with --first, or allow a model file a larger --memory");
}

}  // namespace

IntervalVerdict verdict_of(const IntervalAnswer& answer, bool is_thick) {
  if (answer.start.total > 0) return IntervalVerdict::intersects_at_start;
  if (answer.start_touching.total > 0) return IntervalVerdict::touches;
  if (is_thick ? !answer.touching.empty() : answer.time().has_value()) return IntervalVerdict::touches;
  if (answer.time()) return IntervalVerdict::close;
  return answer.found.contacts.empty() ? IntervalVerdict::clear : IntervalVerdict::undecided;
}

Crossings all_meetings(const IntervalAnswer& answer) {
  Crossings all = answer.start;
  for (const std::vector<CrossingPair>* more :
       {&answer.start_touching.pairs, &answer.explained_pairs, &answer.ignored_pairs}) {
    all.pairs.insert(all.pairs.end(), more->begin(), more->end());
    all.total += more->size();
  }
  std::ranges::sort(all.pairs);
  return all;
}

Answerer::Answerer(const Input& input, const Strategy& strategy, const ElementaryTest& elementary,
                   const AnswerOptions& options)
    : input_(input),
      elementary_(elementary),
      session_(input.name, setup_for(strategy, input.setup(elementary), input.clip->interval_count()),
               strategy, complete_fallback(), input.rest(), as_input_says(options, input)) {}

// A start of which not all pairs are kept crosses.
void Answerer::tell_touching_from_crossing(const Motion& motion, IntervalAnswer& answer) const {
  if (answer.start.total == 0 || !answer.start.all_kept()) return;
  const Stopwatch watch;
  Meetings meetings = tell_meetings_apart(input_.mesh, motion.start(), answer.start);
  answer.start = std::move(meetings.crossing);
  answer.start_touching = std::move(meetings.touching);
  answer.embedding_ms += watch.milliseconds();
}

void Answerer::tell_touching_from_close(const Motion& motion, IntervalAnswer& answer) const {
  constexpr std::size_t kBytesOfTime = 80;  // a node of the map, and what malloc adds
  MemoryWatch memory;
  for (const Contact& close : answer.found.contacts) {
    memory.look(answer.touching.size(), kBytesOfTime);
    if (close.verdict != Verdict::contact) continue;
    answer.close_at_start += close.time == 0;
    const Answer touch = ask(elementary_, input_.mesh, motion, close.pair);
    if (touch.verdict == Verdict::contact) answer.touching.emplace(close.pair, touch.time);
  }
}

IntervalAnswer Answerer::answer(std::size_t index, const scenes::ClipInterval& interval) {
  IntervalAnswer answer;
  answer.index = index;
  const bool is_thick = input_.thickness.length > 0;
  try {
    session_.step(interval.motion, interval.bones ? &*interval.bones : nullptr, answer);
    const Stopwatch telling;
    tell_touching_from_crossing(interval.motion, answer);
    if (is_thick) tell_touching_from_close(interval.motion, answer);
    answer.wall_ms += telling.milliseconds();
  } catch (const MemoryShortage& shortage) {
    const bool rests = interval.motion.start().data() == interval.motion.end().data();
    throw too_many_pairs(shortage, (rests ? "the pose of frame " : "interval ") + std::to_string(index),
                         input_);
  }
  answer.verdict = verdict_of(answer, is_thick);
  return answer;
}

}  // namespace cscd::bench
