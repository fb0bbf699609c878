#include "bench/measure/verification.h"

#include <algorithm>
#include <chrono>
#include <map>

#include "bench/output/progress.h"
#include "bench/rows/catalogue.h"
#include "core/detect/start/embedding.h"

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

// A strategy with an elementary test of its own is compared, not judged: nothing is promised.
class OwnTest {
 public:
  explicit OwnTest(const Strategy& strategy) : strategy_(strategy) {}

  void compare(const TriangleMesh& mesh, std::size_t interval, const ContactSet& truth,
               const ContactSet& answer) {
    accuracy_.add(compare_elementary(truth, answer));
    for (const Difference& difference : differences(truth, answer)) {
      if (listed_.size() == kListed) return;
      listed_.push_back({{"interval", interval},
                         {"kind", is_vertex_face(difference.pair) ? "vf" : "ee"},
                         {"vertices", vertices(mesh, difference.pair)},
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
  static std::vector<int> vertices(const TriangleMesh& mesh, const FeaturePair& pair) {
    std::vector<VertexId> ids;
    if (is_vertex_face(pair)) {
      const Triangle& corner = mesh.corners(TriangleId{pair.b});
      ids = {VertexId{pair.a}, corner[0], corner[1], corner[2]};
    } else {
      const Edge &a = mesh.ends(EdgeId{pair.a}), &b = mesh.ends(EdgeId{pair.b});
      ids = {a[0], a[1], b[0], b[1]};
    }
    std::vector<int> out;
    for (const VertexId id : ids) out.push_back(static_cast<int>(id));
    return out;
  }
  static nlohmann::ordered_json time(const std::optional<double>& t) {  // null: apart
    return t ? nlohmann::ordered_json(*t) : nlohmann::ordered_json();
  }

  const Strategy& strategy_;
  Accuracy accuracy_;
  nlohmann::ordered_json listed_ = nlohmann::ordered_json::array();
};

// Leaves the referee's answers to the pairs that both call contacts.
void keep_shared(const ContactSet& truth, ContactSet& answer) {
  ContactSet shared;
  for (const Contact& contact : truth.contacts)
    if (std::any_of(answer.contacts.begin(), answer.contacts.end(),
                    [&](const Contact& said) { return said.pair == contact.pair; }))
      shared.contacts.push_back(contact);
  answer = std::move(shared);
}

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
  std::map<std::size_t, OwnTest> own_tests;  // by contestant
  for (std::size_t c = 0; c < contestants.size(); ++c)
    if (contestants[c].strategy->own_test) own_tests.emplace(c, *contestants[c].strategy);

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
      if (const auto own = own_tests.find(c); own != own_tests.end()) {
        own->second.compare(input.mesh, i, truth, answer);
        keep_shared(truth, answer);
      }
      add(verify(truth, itself ? truth : answer, strategy.guarantee, starts_embedded),
          promises(strategy.guarantee, starts_embedded, truth), i, record.strategies[c]);
    }

    record.accuracy_tests +=
        reference.used->timed->detect(interval.motion, bones, answer).pairs.elementary_tests;
    record.accuracy.add(compare_elementary(truth, answer));
    progress.advance();
  }
  for (const auto& [c, own] : own_tests) record.own_tests.push_back(own.json());
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
