#include "bench/harness/verification.h"

#include <algorithm>

#include "bench/harness/contestant.h"
#include "bench/output/progress.h"
#include "bench/strategies/catalogue.h"
#include "core/base/stopwatch.h"

namespace cscd::bench {

// The reference with both tests: a contestant where it takes part in the pipeline `today`, which drops no
// contact, else made for the occasion.
class Verifier::Reference {
 public:
  Contestant own;
  Contestant* used;

  Reference(const Input& input, std::span<Contestant> contestants, const ElementaryTest& exact,
            const ElementaryTest& timed) {
    const StrategyRow reference{&complete_reference()};
    const auto among = std::ranges::find(contestants, reference, &Contestant::row);
    used = among != contestants.end() ? &*among : &own;
    if (used == &own) own = std::move(make_contestants(input, {&reference, 1}, exact, timed).front());
  }
};

// A strategy with an elementary test of its own is compared, not judged: nothing is promised.
class Verifier::OwnTest {
 public:
  explicit OwnTest(const Strategy& strategy) : strategy_(strategy) {}

  void compare(const TriangleMesh& mesh, std::size_t interval, const ContactSet& truth,
               const ContactSet& answer) {
    accuracy_.add(compare_elementary(truth, answer));
    for (const Difference& difference : differences(truth, answer)) {
      if (listed_.size() == kListed) return;
      listed_.push_back({{"interval", interval},
                         {"kind", is_vertex_face(difference.pair) ? "vf" : "ee"},
                         {"vertices", VerticesOfPair::of(mesh, difference.pair).vertices},
                         {"said", time(difference.said)},
                         {"true", time(difference.truth)}});
    }
  }
  nlohmann::ordered_json json() const {
    return {{"strategy", strategy_.name},
            {"misses", accuracy_.misses},
            {"false_alarms", accuracy_.false_alarms},
            {"largest_time_error", accuracy_.largest_time_error},
            {"differences", listed_}};
  }

 private:
  static constexpr std::size_t kListed = 200;
  static bool is_vertex_face(const FeaturePair& pair) { return pair.kind == FeaturePair::Kind::vertex_face; }
  static nlohmann::ordered_json time(const std::optional<double>& t) {  // null: apart
    return t ? nlohmann::ordered_json(*t) : nlohmann::ordered_json();
  }

  const Strategy& strategy_;
  Accuracy accuracy_;
  nlohmann::ordered_json listed_ = nlohmann::ordered_json::array();
};

namespace {

TruthRecord held_against(const OutsideTruth& outside, const TriangleMesh& mesh, const ContactSet& found) {
  constexpr std::size_t kListed = 20;
  std::vector<VerticesOfPair> own, missed, invented;
  for (const Contact& contact : found.contacts) own.push_back(VerticesOfPair::of(mesh, contact.pair));
  std::ranges::sort(own);
  std::ranges::set_difference(outside.contacts, own, std::back_inserter(missed));
  std::ranges::set_difference(own, outside.contacts, std::back_inserter(invented));
  TruthRecord out{outside.file, outside.pairs, outside.contacts.size(), missed.size(), invented.size()};
  for (const auto& [what, pairs] : {std::pair("missed ", &missed), std::pair("invented ", &invented)})
    for (const VerticesOfPair& pair : *pairs)
      if (out.differences.size() < kListed) out.differences.push_back(what + text(pair));
  return out;
}

// Leaves the oracle's answers to the pairs that both call contacts.
void keep_shared(const ContactSet& truth, ContactSet& answer) {
  ContactSet shared;
  for (const Contact& contact : truth.contacts)
    if (std::ranges::any_of(answer.contacts, [&](const Contact& said) { return said.pair == contact.pair; }))
      shared.contacts.push_back(contact);
  answer = std::move(shared);
}

bool promises(Guarantee guarantee, bool starts_embedded, const ContactSet& reference) {
  if (reference.contacts.empty()) return false;
  return guarantee == Guarantee::complete || (needs_embedded_start(guarantee) && starts_embedded);
}

void add(const Verification& judgement, bool promised, std::size_t interval, VerifiedStrategy& row) {
  row.contacts_expected += judgement.reference_contacts;
  row.contacts_found += judgement.found_contacts;
  row.intervals_promised += promised;
  if (!judgement.ok)
    row.failures.push_back("interval " + std::to_string(interval) + ": " + judgement.failure);
}

}  // namespace

Verifier::Verifier(Input& input, std::span<Contestant> contestants, const ElementaryTest& exact,
                   const ElementaryTest& timed)
    : input_(input),
      contestants_(contestants),
      reference_(std::make_unique<Reference>(input, contestants, exact, timed)),
      embedding_(std::make_unique<EmbeddingTest>(input.mesh, input.reference)) {
  record_.reference = reference_->used->row.strategy->name;
  record_.elementary = exact.name;
  for (std::size_t c = 0; c < contestants.size(); ++c) {
    const Strategy& strategy = *contestants[c].row.strategy;
    VerifiedStrategy& row = record_.strategies.emplace_back();
    row.name = contestants[c].row.name();
    row.guarantee = to_string(strategy.guarantee);
    if (strategy.own_test) own_tests_.emplace(c, std::make_unique<OwnTest>(strategy));
  }
}

Verifier::~Verifier() = default;

bool Verifier::has_judged(std::size_t interval) const {
  return reports_.contains(interval);
}

bool Verifier::starts_embedded(std::size_t interval) const {
  return !crossing_starts_.contains(interval);
}

const Report& Verifier::report(std::size_t contestant, std::size_t interval) const {
  return reports_.at(interval)[contestant];
}

void Verifier::judge(std::span<const std::size_t> intervals) {
  const Stopwatch judging;
  Progress progress("verifying " + input_.name, intervals.size());
  for (const std::size_t interval : intervals) {
    if (!has_judged(interval)) judge_one(interval);
    progress.advance();
  }
  record_.seconds += judging.milliseconds() / 1000;
}

void Verifier::judge_one(std::size_t i) {
  scenes::ClipInterval interval = input_.clip->load(i);
  const bool starts_embedded = embedding_->embedded(interval.motion.start());
  if (!starts_embedded) crossing_starts_.insert(i);

  ContactSet truth, answer;
  const Report expected = reference_->used->judged->detect(input_.step(interval), truth);
  truth.sort();
  const bool starts_close =
      input_.thickness.length > 0 && !truth.contacts.empty() && truth.contacts.front().time == 0;
  const bool promise_holds = starts_embedded && !starts_close;
  if (!promise_holds) record_.unembedded.push_back(i);
  if (!truth.contacts.empty()) record_.colliding.push_back(i);
  if (input_.truth) record_.truth = held_against(*input_.truth, input_.mesh, truth);
  std::vector<Report>& reports = reports_[i];
  for (std::size_t c = 0; c < contestants_.size(); ++c) {
    const Strategy& strategy = *contestants_[c].row.strategy;
    const bool itself = &contestants_[c] == reference_->used;
    lead_up(strategy, *contestants_[c].judged, input_, i);
    interval = input_.clip->load(i);
    reports.push_back(itself ? expected : contestants_[c].judged->detect(input_.step(interval), answer));
    answer.sort();
    if (contestants_[c].row.first) keep_first(answer);
    if (const auto own = own_tests_.find(c); own != own_tests_.end()) {
      own->second->compare(input_.mesh, i, truth, answer);
      keep_shared(truth, answer);
    }
    add(verify(truth, itself ? truth : answer, contestants_[c].row, promise_holds),
        promises(strategy.guarantee, promise_holds, truth), i, record_.strategies[c]);
  }
  record_.accuracy_tests +=
      reference_->used->timed->detect(input_.step(interval), answer).pairs.elementary_tests;
  record_.accuracy.add(compare_elementary(truth, answer));
}

VerificationRecord Verifier::record() const {
  VerificationRecord out = record_;
  for (const auto& [c, own] : own_tests_) out.own_tests.push_back(own->json());
  for (const auto& [interval, reports] : reports_) out.intervals.push_back(interval);
  std::ranges::sort(out.unembedded);
  std::ranges::sort(out.colliding);
  return out;
}

}  // namespace cscd::bench
