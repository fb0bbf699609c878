#include "core/detect/compose.h"

#include "core/base/stage_clock.h"
#include "core/detect/feature_pair_set.h"
#include "core/detect/filter_block.h"
#include "core/elementary/relative_box.h"

namespace cscd {
namespace {

// Where pairs become contacts: triangle pairs in, contacts out.
class PairTester : public TrianglePairSink {
 public:
  PairTester(const TriangleMesh& mesh, const ElementaryTest& test, PairOptions options, StageClock& clock)
      : mesh_(mesh), test_(test), options_(std::move(options)), clock_(clock) {}

  void start_interval(const Motion& motion, ContactSet& out) {
    restart();
    motion_ = &motion;
    out_ = &out;
    counts_ = {};
    met_.start_interval();
  }
  // Tests what is left of the interval.
  void finish_interval() {
    flush();
    if (!options_.assignment) return;
    clock_.enter(Stage::elementary);
    test(options_.assignment->always());
  }
  const PairCounts& counts() const { return counts_; }

 private:
  void take(const std::vector<TrianglePair>& block) override {
    clock_.enter(Stage::elementary);
    carried_.clear();
    if (options_.assignment)
      options_.assignment->append(block, carried_);
    else
      for (const TrianglePair& pair : block) expand(pair);
    test(carried_);
    clock_.enter(Stage::traversal);
  }

  void expand(const TrianglePair& pair) {
    const Triangle &a = mesh_.corners(pair.a), &b = mesh_.corners(pair.b);
    const bool adjacent = share_vertex(a, b);
    counts_.adjacent_pctp += adjacent;
    if (!adjacent && options_.relative_boxes && relative_boxes_apart(pair)) {
      ++counts_.relative_dropped;
      return;
    }
    for_each_carried(mesh_, pair, adjacent,
                     [&](const FeaturePair& features) { carried_.push_back(features); });
  }

  bool relative_boxes_apart(const TrianglePair& pair) const {
    const Triangle &a = mesh_.corners(pair.a), &b = mesh_.corners(pair.b);
    const Motion& m = *motion_;
    return cscd::relative_boxes_apart({m[a[0]], m[a[1]], m[a[2]]}, {m[b[0]], m[b[1]], m[b[2]]});
  }

  void test(std::span<const FeaturePair> pairs) {
    counts_.feature_pairs += pairs.size();
    left_.clear();
    switch (options_.filter) {
      case PairFilter::certain_sign:
        filter(mesh_, *motion_, pairs, left_);
        break;
      case PairFilter::plain_sign:
        filter_by_plain_sign(mesh_, *motion_, pairs, left_);
        break;
      case PairFilter::none:
        left_.assign(pairs.begin(), pairs.end());
    }
    for (const FeaturePair& pair : left_)
      if (met_.insert(pair)) test(pair);
  }
  void test(const FeaturePair& pair) {
    ++counts_.elementary_tests;
    const Answer answer = ask(test_, mesh_, *motion_, pair);
    if (answer.verdict != Verdict::apart) out_->contacts.push_back({pair, answer.verdict, answer.time});
  }

  const TriangleMesh& mesh_;
  const ElementaryTest& test_;
  PairOptions options_;
  StageClock& clock_;
  const Motion* motion_ = nullptr;
  ContactSet* out_ = nullptr;
  PairCounts counts_;
  std::vector<FeaturePair> carried_;  // by the block's triangle pairs; one may be carried by several
  std::vector<FeaturePair> left_;     // of those, what the filter could not prove apart
  FeaturePairSet met_;                // tested in this interval
};

class ComposedDetector : public Detector {
 public:
  ComposedDetector(std::unique_ptr<Culler> culler, const TriangleMesh& mesh, const ElementaryTest& test,
                   PairOptions options)
      : culler_(std::move(culler)), tester_(mesh, test, std::move(options), clock_) {}

  Report detect(const Motion& motion, const Rig::Interval* bones, ContactSet& out) override {
    out.clear();
    tester_.start_interval(motion, out);
    clock_.reset();

    clock_.enter(Stage::refit);
    culler_->refit(motion);
    clock_.enter(Stage::rv_update);
    const bool classified = culler_->classify(motion, bones);
    clock_.enter(Stage::traversal);
    Report report;
    report.cull = culler_->cull(tester_);
    tester_.finish_interval();
    clock_.stop();

    report.cull.pctp = tester_.count();
    report.pairs = tester_.counts();
    report.ms.refit = clock_.milliseconds(Stage::refit);
    if (classified) report.ms.rv_update = clock_.milliseconds(Stage::rv_update);
    report.ms.traversal = clock_.milliseconds(Stage::traversal);
    report.ms.elementary = clock_.milliseconds(Stage::elementary);
    return report;
  }
  RadialView radial_view() const override { return culler_->radial_view(); }

 private:
  StageClock clock_;
  std::unique_ptr<Culler> culler_;
  PairTester tester_;
};

}  // namespace

std::unique_ptr<Detector> compose(std::unique_ptr<Culler> culler, const TriangleMesh& mesh,
                                  const ElementaryTest& test, PairOptions options) {
  return std::make_unique<ComposedDetector>(std::move(culler), mesh, test, std::move(options));
}

}  // namespace cscd
