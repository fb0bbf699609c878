#include <algorithm>

#include "bench/harness/measurement.h"
#include "bench/strategies/catalogue.h"
#include "core/base/stopwatch.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

// A strategy with an elementary test of its own is compared, not judged: nothing is promised.
ordered_json own_test_of(const Strategy& strategy) {
  return {{"strategy", strategy.name},
          {"misses", std::uint64_t{0}},
          {"false_alarms", std::uint64_t{0}},
          {"largest_time_error", 0.0},
          {"differences", ordered_json::array()}};
}

void compare_own_test(const TriangleMesh& mesh, std::size_t interval, const ContactSet& truth,
                      const ContactSet& answer, ordered_json& row) {
  constexpr std::size_t kListed = 200;
  const auto time = [](const std::optional<double>& t) { return t ? ordered_json(*t) : ordered_json(); };
  const Accuracy own = compare_elementary(truth, answer);
  row["misses"] = row["misses"].get<std::uint64_t>() + own.misses;
  row["false_alarms"] = row["false_alarms"].get<std::uint64_t>() + own.false_alarms;
  row["largest_time_error"] = std::max(row["largest_time_error"].get<double>(), own.largest_time_error);
  ordered_json& listed = row["differences"];
  for (const Difference& difference : differences(truth, answer)) {
    if (listed.size() == kListed) return;
    listed.push_back({{"interval", interval},
                      {"kind", difference.pair.kind == FeaturePair::Kind::vertex_face ? "vf" : "ee"},
                      {"vertices", VerticesOfPair::of(mesh, difference.pair).vertices},
                      {"said", time(difference.said)},  // null: apart
                      {"true", time(difference.truth)}});
  }
}

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

}  // namespace

bool same_culling(const Report& a, const Report& b) {
  return a.cull.bvot == b.cull.bvot && a.cull.pctp == b.cull.pctp &&
         a.cull.contour_box_tests == b.cull.contour_box_tests &&
         a.pairs.adjacent_pctp == b.pairs.adjacent_pctp &&
         a.pairs.relative_dropped == b.pairs.relative_dropped &&
         a.pairs.feature_pairs == b.pairs.feature_pairs;
}

VerificationRecord Measurement::unjudged() const {
  VerificationRecord record;
  record.reference = reference_->row.strategy->name;
  record.elementary = setup_.exact.name;
  for (const Contestant& contestant : setup_.contestants) {
    const Strategy& strategy = *contestant.row.strategy;
    VerifiedStrategy& row = record.strategies.emplace_back();
    row.name = contestant.row.name();
    row.guarantee = to_string(strategy.guarantee);
    if (strategy.own_test) record.own_tests.push_back(own_test_of(strategy));
  }
  return record;
}

std::optional<double> Measurement::verify(std::size_t i, const Answers& answers, VerificationRecord& record) {
  const Stopwatch judging;
  Input& input = setup_.input;
  const std::span<Contestant> contestants = setup_.contestants;
  const bool embedded = starts_embedded(i);
  scenes::ClipInterval interval = input.clip->load(i);
  const auto reference_of = [&](Detector& detector) {
    Answered out;
    ask(detector, reference_->row, input.step(interval), out);
    return out;
  };
  const Answered* counted = nullptr;
  for (std::size_t c = 0; c < contestants.size(); ++c)
    if (is_reference(c) && answers[c]) counted = &*answers[c];
  const Answered timed = counted ? *counted : reference_of(*reference_->timed);
  const Answered expected =
      reference_->judged == reference_->timed ? timed : reference_of(*reference_->judged);
  const ContactSet& truth = expected.found;

  const bool starts_close = input.thickness.length > 0 && expected.first_time() == 0.0;
  const bool promise_holds = embedded && !starts_close;
  record.intervals.push_back(i);
  if (!promise_holds) record.unembedded.push_back(i);
  if (!truth.contacts.empty()) record.colliding.push_back(i);
  if (input.truth) record.truth = held_against(*input.truth, input.mesh, truth);
  auto own_test = record.own_tests.begin();
  Answered answer;
  for (std::size_t c = 0; c < contestants.size(); ++c) {
    Contestant& contestant = contestants[c];
    const StrategyRow& asked = contestant.row;
    ordered_json* const own = asked.strategy->own_test ? &*own_test++ : nullptr;
    if (!answers[c]) continue;
    if (&contestant == reference_) {
      answer = expected;
    } else if (contestant.judged == contestant.timed) {
      answer = *answers[c];
    } else {
      interval = lead_to(i, asked, *contestant.judged);
      ask(*contestant.judged, asked, input.step(interval), answer);
    }
    VerifiedStrategy& row = record.strategies[c];
    if (!asked.first && !same_culling(answer.report, answers[c]->report))
      row.failures.push_back(setup_.where(i) + ": culls otherwise than when it was verified");
    if (own != nullptr) {
      compare_own_test(input.mesh, i, truth, answer.found, *own);
      keep_shared(truth, answer.found);
    }
    const Verification judgement = bench::verify(truth, answer.found, asked, promise_holds);
    row.contacts_expected += judgement.reference_contacts;
    row.contacts_found += judgement.found_contacts;
    row.intervals_promised += promises(asked.strategy->guarantee, promise_holds, truth);
    if (!judgement.ok) row.failures.push_back(setup_.where(i) + ": " + judgement.failure);
  }
  record.accuracy_tests += timed.report.pairs.elementary_tests;
  record.accuracy.add(compare_elementary(truth, timed.found));
  record.seconds += judging.milliseconds() / 1000;
  return expected.first_time();
}

}  // namespace cscd::bench
