#include "core/detect/compose.h"

#include "core/base/stage_clock.h"
#include "core/detect/feature_pair_set.h"
#include "core/detect/filter_block.h"
#include "core/elementary/relative_box.h"

namespace cscd {
namespace {

bool contains(const Triangle& triangle, VertexId vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

bool share_vertex(const Triangle& a, const Triangle& b) {
  return contains(a, b[0]) || contains(a, b[1]) || contains(a, b[2]);
}

bool share_vertex(const Edge& a, const Edge& b) {
  return a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
}

// Where pairs become contacts: triangle pairs in, contacts out.
class PairTester : public TrianglePairSink {
 public:
  PairTester(const TriangleMesh& mesh, const ElementaryTest& test, PairOptions options, StageClock& clock)
      : mesh_(mesh), test_(test), options_(options), clock_(clock) {}

  void start_interval(const Motion& motion, ContactSet& out) {
    restart();
    motion_ = &motion;
    out_ = &out;
    counts_ = {};
    met_.start_interval();
  }
  const PairCounts& counts() const { return counts_; }

 private:
  void take(const std::vector<TrianglePair>& block) override {
    clock_.enter(Stage::elementary);
    carried_.clear();
    for (const TrianglePair& pair : block) expand(pair);
    counts_.feature_pairs += carried_.size();
    left_.clear();
    filter(mesh_, *motion_, carried_, left_);
    for (const FeaturePair& pair : left_)
      if (met_.insert(pair)) test(pair);
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
    for (const VertexId vertex : a)
      if (!contains(b, vertex)) carried_.push_back(FeaturePair::of(vertex, pair.b));
    for (const VertexId vertex : b)
      if (!contains(a, vertex)) carried_.push_back(FeaturePair::of(vertex, pair.a));
    for (const EdgeId e : mesh_.edges_of(pair.a))
      for (const EdgeId f : mesh_.edges_of(pair.b))
        if (!adjacent || !share_vertex(mesh_.ends(e), mesh_.ends(f)))
          carried_.push_back(FeaturePair::of(e, f));
  }

  bool relative_boxes_apart(const TrianglePair& pair) const {
    const Triangle &a = mesh_.corners(pair.a), &b = mesh_.corners(pair.b);
    const Motion& m = *motion_;
    return cscd::relative_boxes_apart({m[a[0]], m[a[1]], m[a[2]]}, {m[b[0]], m[b[1]], m[b[2]]});
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
      : culler_(std::move(culler)), tester_(mesh, test, options, clock_) {}

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
    tester_.flush();
    clock_.stop();

    report.cull.pctp = tester_.count();
    report.pairs = tester_.counts();
    report.ms.refit = clock_.milliseconds(Stage::refit);
    if (classified) report.ms.rv_update = clock_.milliseconds(Stage::rv_update);
    report.ms.traversal = clock_.milliseconds(Stage::traversal);
    report.ms.elementary = clock_.milliseconds(Stage::elementary);
    return report;
  }
  std::vector<std::int32_t> clusters() const override { return culler_->clusters(); }

 private:
  StageClock clock_;
  std::unique_ptr<Culler> culler_;
  PairTester tester_;
};

}  // namespace

std::unique_ptr<Detector> compose(std::unique_ptr<Culler> culler, const TriangleMesh& mesh,
                                  const ElementaryTest& test, PairOptions options) {
  return std::make_unique<ComposedDetector>(std::move(culler), mesh, test, options);
}

}  // namespace cscd
