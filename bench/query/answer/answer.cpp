#include "bench/query/answer/answer.h"

#include <algorithm>

#include "bench/measure/strategies/catalogue.h"

namespace cscd::bench {
namespace {

IntervalVerdict verdict_of(const StepAnswer& answer) {
  if (answer.start.total > 0) return IntervalVerdict::intersects_at_start;
  if (answer.time()) return IntervalVerdict::touches;
  return answer.found.contacts.empty() ? IntervalVerdict::clear : IntervalVerdict::undecided;
}

AnswerOptions with_ignored(AnswerOptions options, const Input& input) {
  options.ignored = input.ignored ? &input.ignored->triangles : nullptr;
  return options;
}

}  // namespace

std::string_view to_string(IntervalVerdict verdict) {
  switch (verdict) {
    case IntervalVerdict::clear:
      return "clear";
    case IntervalVerdict::touches:
      return "touches";
    case IntervalVerdict::intersects_at_start:
      return "intersects_at_start";
    case IntervalVerdict::undecided:
      return "undecided";
  }
  return "";
}

Answerer::Answerer(Input& input, const Strategy& strategy, const ElementaryTest& elementary,
                   const AnswerOptions& options)
    : input_(input),
      session_(input.name, input.setup(elementary), strategy, complete_fallback(), input.rest(),
               with_ignored(options, input)) {}

IntervalAnswer Answerer::answer(std::size_t index) {
  IntervalAnswer answer;
  answer.index = index;
  const Stopwatch loading;
  const scenes::ClipInterval interval = input_.clip->load(index);
  answer.load_ms = loading.milliseconds();
  session_.step(interval.motion, interval.bones ? &*interval.bones : nullptr, answer);
  answer.verdict = verdict_of(answer);
  return answer;
}

}  // namespace cscd::bench
