#include "bench/benchmark/entry.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "bench/harness/interval_source.h"
#include "bench/harness/measurement.h"
#include "bench/records/environment.h"
#include "bench/statistics/statistics.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"
#include "core/fast/drvbc_fast.h"

namespace cscd::bench {
namespace {

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

Input input_of(const scenes::PosedMesh& posed) {
  const auto load = [&posed](std::size_t i) {
    const scenes::PosedMesh::Interval& own = posed.intervals[i];
    scenes::ClipInterval out{Motion(own.start.positions, own.end.positions), std::nullopt};
    if (!posed.bone_parent.empty()) out.bones = Rig::Interval{own.start.bones, own.end.bones};
    return out;
  };
  const std::size_t vertices = posed.reference.positions.size();
  Input input{
      "an interval",
      std::make_unique<IntervalSource>(scenes::ClipHeader{posed.triangles, vertices, posed.bone_parent},
                                       posed.intervals.size(), load),
      TriangleMesh(posed.triangles, vertices), posed.reference.positions, std::nullopt};
  if (!posed.bone_parent.empty()) input.rig.emplace(Rig{posed.bone_parent, posed.reference.bones});
  return input;
}

// A mesh of the benchmark, and the strategy made for it.
class Asked {
 public:
  Asked(const scenes::PosedMesh& posed, const StrategyRow& row, const ElementaryTest& elementary)
      : row_(row), input_(input_of(posed)) {
    // One reason for all surfaces that are not closed; why_not() names the defect of each.
    if (row.strategy->needs != Needs::any_mesh && !input_.mesh.closed_and_oriented())
      throw InputError("needs a closed, consistently oriented surface");
    if (const auto reason = why_not(*row.strategy, input_.mesh, input_.rig.has_value()))
      throw InputError(*reason);
    contestants_.push_back(make_contestant(input_, row, judging(), elementary));
    // Intervals of a mesh do not follow each other, so none leads up to another.
    const std::vector<IntervalRange> alone(input_.clip->interval_count(), IntervalRange{0, 0});
    measurement_.emplace(Measurement::Setup{input_, contestants_, judging(), elementary, alone,
                                            [this](std::size_t) { return id_; }});
    // These promises need to know the start, and these strategies do not see it themselves.
    if (needs_embedded_start(row.strategy->guarantee))
      embedding_ = std::make_unique<EmbeddingTest>(
          make_embedding_test(measured_setup(input_, *row.strategy, elementary)));
  }

  IntervalAnswers answer(std::size_t row, const std::string& id, std::size_t repetitions,
                         std::vector<std::string>& failures) {
    IntervalAnswers out;
    out.id = id_ = id;
    const SectionResult& result =
        measurement_->count({{row}, {row}, {row}}, [&](std::size_t, std::size_t, const ContactSet& found) {
          out.contacts.emplace();
          for (const Contact& contact : found.contacts)
            out.contacts->push_back(
                {PairName::of(input_.mesh, contact.pair),
                 contact.verdict == Verdict::contact ? std::optional(contact.time) : std::nullopt});
        });
    std::mt19937_64 order;
    measurement_->time({repetitions, order});
    const VerificationRecord& verified = result.verification;
    if (verified.ok()) {
      std::vector<double> times;
      for (const std::vector<double>& query : query_times(result.rows[0].ms)) times.push_back(query.front());
      out.milliseconds = median(times);
    }
    for (const std::string& failure : verified.strategies[0].failures) failures.push_back(failure);
    see_start(row, out);
    out.claim = claim(out.starts_embedded.value_or(false));
    return out;
  }

 private:
  // Right in every case, and quick enough to judge every interval.
  static const ElementaryTest& judging() { return elementary_test_named("filtered_exact"); }

  void see_start(std::size_t row, IntervalAnswers& out) {
    const scenes::ClipInterval interval = input_.clip->load(row);
    Crossings start;
    if (row_.strategy->sees_start) {
      ContactSet ignored;
      Step step = input_.step(interval);
      step.crossings = &start;
      step.most_crossings = kNoLimit;
      contestants_[0].timed->detect(step, ignored);
    } else if (embedding_) {
      start = embedding_->find_all(interval.motion.start(), kNoLimit);
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

  const StrategyRow& row_;
  Input input_;
  std::vector<Contestant> contestants_;
  std::unique_ptr<EmbeddingTest> embedding_;
  std::optional<Measurement> measurement_;
  std::string id_;  // of the interval that is asked about
};

}  // namespace

Entry answer_benchmark(const Benchmark& benchmark, const StrategyRow& row, const ElementaryTest& elementary,
                       std::size_t repetitions, const std::function<void(std::size_t)>& progress) {
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
        const ListedInterval& listed = benchmark.intervals[i];
        answers[i] = asked->answer(listed.row, listed.id, repetitions, entry.failures);
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
