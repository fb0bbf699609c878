#include "bench/verification.h"

#include <algorithm>
#include <chrono>

#include "bench/catalogue.h"
#include "bench/progress.h"
#include "core/detect/embedding.h"

namespace cscd::bench {
namespace {

using Clock = std::chrono::steady_clock;

// The reference with both tests: a contestant where it takes part, else made for the occasion.
struct Reference {
  Contestant own;
  Contestant* used;

  Reference(const Input& input, std::span<Contestant> contestants, const ElementaryTest& exact,
            const ElementaryTest& timed) {
    const Strategy* strategy = &complete_reference();
    const auto row = std::find_if(contestants.begin(), contestants.end(),
                                  [&](const Contestant& c) { return c.strategy == strategy; });
    used = row != contestants.end() ? &*row : &own;
    if (used == &own) own = std::move(make_contestants(input, {&strategy, 1}, exact, timed).front());
  }
};

bool promises(Guarantee guarantee, bool starts_embedded, const ContactSet& reference) {
  if (reference.contacts.empty()) return false;
  return guarantee == Guarantee::complete || (guarantee == Guarantee::first_contact && starts_embedded);
}

void add(const Verification& judgement, bool promised, std::size_t interval, VerifiedStrategy& row) {
  row.contacts_expected += judgement.reference_contacts;
  row.contacts_found += judgement.found_contacts;
  row.intervals_promised += promised;
  if (!judgement.ok)
    row.failures.push_back("interval " + std::to_string(interval) + ": " + judgement.failure);
}

}  // namespace

VerificationOutcome verify_contestants(Input& input, std::span<Contestant> contestants,
                                       const ElementaryTest& exact, const ElementaryTest& timed,
                                       std::vector<std::size_t> intervals) {
  const Clock::time_point begin = Clock::now();
  const Reference reference(input, contestants, exact, timed);
  VerificationOutcome outcome;
  VerificationRecord& record = outcome.record;
  outcome.reports.resize(contestants.size());
  record.reference = reference.used->strategy->name;
  record.elementary = exact.name;
  for (const Contestant& contestant : contestants) {
    VerifiedStrategy& row = record.strategies.emplace_back();
    row.name = contestant.strategy->name;
    row.guarantee = to_string(contestant.strategy->guarantee);
  }

  EmbeddingTest embedding(input.mesh, input.reference);
  Progress progress("verifying " + input.name, intervals.size());
  ContactSet truth, answer;
  for (const std::size_t i : intervals) {
    const scenes::ClipInterval interval = input.clip->load(i);
    const Rig::Interval* bones = interval.bones ? &*interval.bones : nullptr;
    const bool starts_embedded = embedding.embedded(interval.motion.start());
    if (!starts_embedded) record.unembedded.push_back(i);

    const Report expected = reference.used->judged->detect(interval.motion, bones, truth);
    truth.sort();
    if (!truth.contacts.empty()) record.colliding.push_back(i);
    for (std::size_t c = 0; c < contestants.size(); ++c) {
      const Strategy& strategy = *contestants[c].strategy;
      const bool itself = &contestants[c] == reference.used;
      const Report report = itself ? expected : contestants[c].judged->detect(interval.motion, bones, answer);
      outcome.reports[c].push_back(report);
      answer.sort();
      add(verify(truth, itself ? truth : answer, strategy.guarantee, starts_embedded),
          promises(strategy.guarantee, starts_embedded, truth), i, record.strategies[c]);
    }

    record.accuracy_tests +=
        reference.used->timed->detect(interval.motion, bones, answer).pairs.elementary_tests;
    record.accuracy.add(compare_elementary(truth, answer));
    progress.advance();
  }
  record.intervals = std::move(intervals);
  record.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return outcome;
}

std::vector<std::size_t> every_kth(const IntervalRange& range, std::size_t k) {
  std::vector<std::size_t> intervals;
  for (std::size_t i = range.first; i < range.last; i += k) intervals.push_back(i);
  return intervals;
}

}  // namespace cscd::bench
