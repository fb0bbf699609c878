#include "bench/benchmark/entry.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "bench/records/environment.h"
#include "bench/statistics/statistics.h"
#include "bench/strategies/strategy_row.h"
#include "core/base/error.h"
#include "core/fast/drvbc_fast.h"

namespace cscd::bench {
namespace {

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

// A mesh of the benchmark, and the strategy made for it.
class Asked {
 public:
  Asked(const scenes::PosedMesh& posed, const StrategyRow& row, const ElementaryTest& elementary)
      : posed_(posed), row_(row), mesh_(posed.triangles, posed.reference.positions.size()) {
    if (!posed.bone_parent.empty()) rig_.emplace(Rig{posed.bone_parent, posed.reference.bones});
    // One reason for all surfaces that are not closed; why_not() names the defect of each.
    if (row.strategy->needs != Needs::any_mesh && !mesh_.closed_and_oriented())
      throw InputError("needs a closed, consistently oriented surface");
    if (const auto reason = why_not(*row.strategy, mesh_, rig_.has_value())) throw InputError(*reason);
    const StrategyInput setup{mesh_,    posed.reference.positions, rig_ ? &*rig_ : nullptr, elementary, 1,
                              row.first};
    detector_ = row.strategy->make(setup).detector;
    // These promises need to know the start, and these strategies do not see it themselves.
    if (needs_embedded_start(row.strategy->guarantee))
      embedding_ = std::make_unique<EmbeddingTest>(make_embedding_test(setup));
  }

  IntervalAnswers answer(std::size_t row, int repetitions) {
    const scenes::PosedMesh::Interval& own = posed_.intervals[row];
    const Motion motion(own.start.positions, own.end.positions);
    const Rig::Interval both{own.start.bones, own.end.bones};
    const Rig::Interval* const bones = rig_ ? &both : nullptr;
    IntervalAnswers out;
    ContactSet found;
    std::vector<double> milliseconds;
    // Intervals of a scene do not follow each other, and each repetition answers as the first.
    for (int i = 0; i < repetitions; ++i) {
      detector_->forget();
      milliseconds.push_back(detector_->detect({motion, bones}, found).ms.total());
    }
    found.sort();
    if (row_.first) keep_first(found);
    out.milliseconds = median(milliseconds);
    out.contacts.emplace();
    for (const Contact& contact : found.contacts)
      out.contacts->push_back({PairName::of(mesh_, contact.pair), contact.verdict == Verdict::contact
                                                                      ? std::optional(contact.time)
                                                                      : std::nullopt});
    see_start(motion, bones, out);
    out.claim = claim(out.starts_embedded.value_or(false));
    return out;
  }

 private:
  void see_start(const Motion& motion, const Rig::Interval* bones, IntervalAnswers& out) {
    Crossings start;
    if (row_.strategy->sees_start) {
      ContactSet ignored;
      detector_->detect({.motion = motion, .bones = bones, .crossings = &start, .most_crossings = kNoLimit},
                        ignored);
    } else if (embedding_) {
      start = embedding_->find_all(motion.start(), kNoLimit);
    } else {
      return;
    }
    out.starts_embedded = start.total == 0;
    out.start_pairs = std::move(start.pairs);
  }

  Claim claim(bool starts_embedded) const {
    switch (row_.strategy->guarantee) {
      case Guarantee::complete:
        return row_.first ? Claim::first_contact : Claim::complete;
      case Guarantee::first_contact:
        return starts_embedded ? Claim::first_contact : Claim::none;
      case Guarantee::all_from_embedded:
        if (!starts_embedded) return Claim::none;
        return row_.first ? Claim::first_contact : Claim::complete;
      case Guarantee::heuristic:
        return Claim::none;
    }
    return Claim::none;
  }

  const scenes::PosedMesh& posed_;
  const StrategyRow& row_;
  TriangleMesh mesh_;
  std::optional<Rig> rig_;
  std::unique_ptr<Detector> detector_;
  std::unique_ptr<EmbeddingTest> embedding_;
};

}  // namespace

Entry answer_benchmark(const Benchmark& benchmark, const StrategyRow& row, const ElementaryTest& elementary,
                       int repetitions, const std::function<void(std::size_t)>& progress) {
  Entry entry;
  const nlohmann::ordered_json here = environment();
  entry.answers.program = "cscd " + row.name();
  if (!row.strategy->own_test) entry.answers.program += " with " + std::string(elementary.name);
  entry.answers.version = here.at("commit");
  entry.answers.benchmark = benchmark.sha256;
  entry.answers.notes = {{"strategy", row.name()},
                         {"elementary", row.strategy->own_test ? "its own" : std::string(elementary.name)},
                         {"guarantee", to_string(row.strategy->guarantee)},
                         {"source", row.strategy->source},
                         {"repetitions", repetitions},
                         {"environment", here}};
  std::vector<std::optional<IntervalAnswers>> answers(benchmark.intervals.size());
  std::size_t done = 0;
  for_each_mesh(benchmark, [&](const scenes::PosedMesh& posed, std::span<const std::size_t> intervals) {
    std::optional<Asked> asked;
    for (const std::size_t i : intervals) {
      // A package that refuses positions throws whatever it likes.
      try {
        if (!asked) asked.emplace(posed, row, elementary);
        answers[i] = asked->answer(benchmark.intervals[i].row, repetitions);
        answers[i]->id = benchmark.intervals[i].id;
      } catch (const std::bad_alloc&) {
        throw;
      } catch (const std::exception& error) {
        ++entry.left_out[error.what()];
        asked.reset();
      }
      progress(++done);
    }
  });
  for (std::optional<IntervalAnswers>& answer : answers)
    if (answer) entry.answers.intervals.push_back(std::move(*answer));
  return entry;
}

}  // namespace cscd::bench
