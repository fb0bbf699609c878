#include "core/detect/compose.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <tuple>

#include "core/base/error.h"
#include "core/base/memory.h"
#include "core/base/stage_clock.h"
#include "core/base/thread_pool.h"
#include "core/detect/exclusions.h"
#include "core/detect/feature_owners.h"
#include "core/detect/feature_pair_set.h"
#include "core/detect/filter_block.h"
#include "core/elementary/exact/static_contact.h"
#include "core/elementary/question/apart_before.h"
#include "core/elementary/question/relative_box.h"
#include "core/hierarchy/loose_vertices.h"

namespace cscd {
namespace {

// A slack that exceeds the error of a contact time (2^-50, core/elementary/exact/exact.h), so that all
// feature pairs that touch at the earliest time are tested.
constexpr double kTimeSlack = 0x1p-48;

// Where the time alone is asked for, contacts need not be told apart that differ by this share of it.
constexpr double kTimeAloneShare = 0x1p-42;

// So many feature pairs are remembered. To test them takes some microseconds.
constexpr std::size_t kRemembered = 8;

// So many triangle pairs are filtered together, and so many feature pairs are tested together. Either takes
// some microseconds.
constexpr std::size_t kFilteredTogether = 64, kAskedTogether = 16;

// Feature pairs of one kind, and their queries, that are tested together.
template <class Query>
struct Tests {
  std::vector<FeaturePair> pairs;
  std::vector<Query> queries;
  std::vector<double> thickness;
  std::vector<Answer> answers;

  void clear() { pairs.clear(), queries.clear(), thickness.clear(); }
  void add(const FeaturePair& pair, const Query& query, double thick) {
    pairs.push_back(pair);
    queries.push_back(query);
    thickness.push_back(thick);
  }
};

// Turns triangle pairs into contacts. It is the sink of the culler.
class PairTester : public TrianglePairSink {
 public:
  PairTester(const StrategyInput& setup, PairOptions options, StageClock& clock)
      : mesh_(setup.mesh),
        test_(setup.elementary),
        first_only_(setup.first_only),
        exclusions_(setup.exclusions),
        options_(std::move(options)),
        pool_(options_.threads),
        clock_(clock),
        plain_sign_(setup.pipeline == Pipeline::published),
        loose_(mesh_, setup.reference, options_.own_vertices) {
    if (options_.owners && may_own()) owners_.emplace(mesh_);
  }

  void start_interval(const Step& step, ContactSet& out) {
    restart();
    motion_ = &step.motion;
    thickness_ = step.thickness;
    start_ = step.crossings;
    most_ = step.most_crossings;
    any_contact_ = step.any_contact && step.crossings == nullptr;
    time_alone_ = step.time_alone && first_only_;
    stops_at_start_ = time_alone_ && step.crossings == nullptr;
    first_ = first_only_ || any_contact_;
    if (start_ != nullptr) start_->pairs.clear(), start_->total = 0;
    out_ = &out;
    memory_.start();
    counts_ = {};
    met_.start_interval();
    earliest_ = 1;
    found_any_ = false;
    left_out_from_ = 2;
  }
  // Tests the feature pairs that touched first in the last step in which any did. Those that touch bound the
  // time until which the culler has to look.
  void test_remembered() {
    if (remembered_.empty()) return;
    left_ = remembered_;
    test_left();
  }
  // Tests the feature pairs of loose vertices, which no pair of triangles carries.
  void test_loose() {
    if (loose_.empty()) return;
    left_.clear();
    loose_.for_each_near(*motion_, thickness_.largest(),
                         [&](VertexId v, TriangleId t) { left_.push_back(FeaturePair::of(v, t)); });
    counts_.feature_pairs += left_.size();
    test_left();
  }
  void forget() { remembered_.clear(); }
  // Whether every pair of triangles that is not passed on from here on carries no contact.
  void trust_owners(bool trust) { by_owners_ = owners_ && trust; }
  // Tests what is left of the interval.
  void finish_interval() {
    flush();
    if (options_.remembers && first_only_ && !out_->contacts.empty()) remember();
    if (!options_.assignment) return;
    clock_.enter(Stage::elementary);
    test_always(options_.assignment->always());
  }
  const PairCounts& counts() const { return counts_; }
  // What was left out may touch a little earlier than what was found.
  void settle_time() {
    if (!(left_out_from_ < earliest_)) return;
    const auto first = std::ranges::min_element(out_->contacts, {}, [](const Contact& contact) {
      return contact.verdict == Verdict::contact ? contact.time : 2;
    });
    first->time = left_out_from_;
  }

  void leave_start() override {
    flush();
    start_ = nullptr;
  }
  void test_owned(bool alone) override {
    flush();
    if (alone && may_own() && !owners_) owners_.emplace(mesh_);
    owned_alone_ = alone && owners_;
  }
  bool first_only() const override { return first_; }
  double until() const override { return first_ ? cut() : 1; }
  void begin_again() override {
    flush();
    if (start_ != nullptr) start_->pairs.clear(), start_->total = 0;
  }

 private:
  void take(const std::vector<TrianglePair>& whole) override {
    if (start_ != nullptr) test_start(whole);
    clock_.enter(Stage::elementary);
    // A feature pair is assigned to one of the triangle pairs that carry it. An excluded triangle pair may
    // have to be tested for a feature pair that others carry too, so only feature pairs are dropped then.
    const bool drop = exclusions_ != nullptr && !options_.assignment;
    const std::vector<TrianglePair>& block = drop ? without_excluded(whole) : whole;
    if (options_.assignment) {
      carried_.clear();
      options_.assignment->append(block, carried_);
      test_carried();
    } else if (first_) {
      test_in_order(block);
    } else {
      carried_.clear();
      for (const TrianglePair& pair : block) take_all_carried(pair);
      test_carried();
    }
    clock_.enter(Stage::traversal);
  }

  // An excluded triangle pair may own feature pairs that others, which are not excluded, carry too.
  bool may_own() const { return exclusions_ == nullptr && !plain_sign_; }

  // Visits the triangle pairs that may come near enough no later than the earliest contact that matters.
  template <class Take>
  void for_each_near(const std::vector<TrianglePair>& block, const Take& take) const {
    for (std::size_t first = 0; first < block.size(); first += kLanes16) {
      const auto pairs = std::span(block).subspan(first, std::min(kLanes16, block.size() - first));
      const auto before = no_contact_before(mesh_, *motion_, pairs, thickness_.largest());
      for (std::size_t i = 0; i < pairs.size(); ++i)
        if (matters({before[i], pairs[i]})) take(Bounded{before[i], pairs[i]});
    }
  }
  struct Bounded {
    float before;  // time before which the two certainly do not touch
    TrianglePair pair;
  };
  bool matters(const Bounded& pair) const { return pair.before <= (first_ ? earliest_ + kTimeSlack : 1); }

  // Whatever touches at the earliest time found so far touches before this time.
  double cut() const { return std::min(1.0, earliest_ + 2 * kTimeSlack); }

  void test_start(const std::vector<TrianglePair>& block) {
    clock_.enter(Stage::start);
    for (const TrianglePair& pair : block) {
      if (!triangles_meet(mesh_, motion_->start(), pair.a, pair.b)) continue;
      if (start_->total++ < most_) start_->pairs.emplace_back(std::minmax(pair.a, pair.b));
    }
  }

  const std::vector<TrianglePair>& without_excluded(const std::vector<TrianglePair>& block) {
    kept_.clear();
    std::ranges::copy_if(block, std::back_inserter(kept_),
                         [&](const TrianglePair& pair) { return !exclusions_->excludes(mesh_, pair); });
    return kept_;
  }

  void remember() {
    std::vector<Contact>& contacts = out_->contacts;
    const auto last = contacts.begin() + static_cast<std::ptrdiff_t>(std::min(kRemembered, contacts.size()));
    std::ranges::partial_sort(contacts, last, {},
                              [](const Contact& c) { return std::tuple(c.time, c.pair); });
    remembered_.clear();
    std::transform(contacts.begin(), last, std::back_inserter(remembered_),
                   [](const Contact& c) { return c.pair; });
  }

  // Tests triangle pairs in the order of the times before which they certainly do not touch, a few at a time,
  // up to the earliest contact found so far.
  void test_in_order(const std::vector<TrianglePair>& block) {
    constexpr std::size_t kTogether = 16;  // more would be tested in vain; fewer leave lanes idle
    order_.clear();
    for_each_near(block, [&](const Bounded& pair) { order_.push_back(pair); });
    const auto later = [](const Bounded& a, const Bounded& b) { return a.before > b.before; };
    std::make_heap(order_.begin(), order_.end(), later);
    while (!order_.empty() && matters(order_.front())) {
      carried_.clear();
      for (std::size_t i = 0; i < kTogether && !order_.empty(); ++i) {
        take_all_carried(order_.front().pair);
        std::pop_heap(order_.begin(), order_.end(), later);
        order_.pop_back();
      }
      test_carried();
    }
  }

  // Tests feature pairs that no triangle pair is tested for.
  void test_always(std::span<const FeaturePair> pairs) {
    counts_.feature_pairs += pairs.size();
    left_.clear();
    if (plain_sign_) {
      left_.assign(pairs.begin(), pairs.end());
      drop_by_plain_sign(mesh_, *motion_, left_);
    } else {
      filter(mesh_, *motion_, pairs, left_);
    }
    test_left();
  }

  void test_carried() {
    for (const CarriedPairs& carried : carried_)
      counts_.feature_pairs += static_cast<unsigned>(std::popcount(carried.places));
    left_.clear();
    if (!thickness_.is_zero()) {
      for (CarriedPairs carried : carried_) {
        const TrianglePair& pair = carried.pair;
        carried.places = not_farther_than(thickness_.largest(), *motion_, mesh_.corners(pair.a),
                                          mesh_.corners(pair.b), carried.places);
        for_each_carried(mesh_, carried, [&](const FeaturePair& left) { left_.push_back(left); });
      }
    } else if (plain_sign_) {
      for (const CarriedPairs& carried : carried_)
        for_each_carried(mesh_, carried, [&](const FeaturePair& pair) { left_.push_back(pair); });
      drop_by_plain_sign(mesh_, *motion_, left_);
    } else {
      filter_carried();
    }
    test_left();
  }

  // Each range of pairs is filtered into a list of its own, and the lists are joined in order.
  void filter_carried() {
    const std::span<const CarriedPairs> carried = carried_;
    const std::size_t ranges = pool_.ranges_of(carried.size(), kFilteredTogether);
    if (lists_.size() < ranges) lists_.resize(ranges);  // lists that are not needed keep their memory
    pool_.ranges(carried.size(), kFilteredTogether,
                 [&](std::size_t first, std::size_t last, std::size_t part) {
                   lists_[part].clear();
                   filter(mesh_, *motion_, carried.subspan(first, last - first), test_.single_precision_first,
                          until(), lists_[part]);
                 });
    for (const std::vector<FeaturePair>& list : std::span(lists_).first(ranges))
      left_.insert(left_.end(), list.begin(), list.end());
  }

  void take_all_carried(const TrianglePair& pair) {
    CarriedPlaces places = carried_by(mesh_.corners(pair.a), mesh_.corners(pair.b));
    const bool adjacent = places != kAllCarried;
    counts_.adjacent_pctp += adjacent;
    if (!adjacent && options_.relative_boxes && thickness_.is_zero() && relative_boxes_apart(pair)) {
      ++counts_.relative_dropped;
      return;
    }
    if (by_owners_ || owned_alone_) {
      // What others own is carried all the same.
      const auto owned = static_cast<CarriedPlaces>(places & owners_->owned_by(pair));
      counts_.feature_pairs += static_cast<unsigned>(std::popcount(static_cast<unsigned>(places ^ owned)));
      places = owned;
    }
    if (places != 0) carried_.push_back({pair, places});
  }

  bool relative_boxes_apart(const TrianglePair& pair) const {
    const Triangle &a = mesh_.corners(pair.a), &b = mesh_.corners(pair.b);
    const Motion& m = *motion_;
    return cscd::relative_boxes_apart({m[a[0]], m[a[1]], m[a[2]]}, {m[b[0]], m[b[1]], m[b[2]]});
  }

  void test_left() {
    // A block of triangle pairs carries up to half a million feature pairs, and lists double: the old one and
    // the new one are there at a time.
    constexpr std::size_t kBytesOfTest =
        3 * (sizeof(FeaturePair) + sizeof(MovingEdgeEdge) + sizeof(double) + sizeof(Answer));
    if (left_.size() > room_of_tests_) {
      const std::size_t room = left_.size() + left_.size() / 8;
      require_memory(out_->contacts.size(), kBytesOfTest * room);
      room_of_tests_ = room;
    }
    vertex_faces_.clear(), edge_edges_.clear();
    constexpr std::size_t kAhead = 16;  // pairs that are looked up while one is fetched
    for (std::size_t i = 0; i < left_.size(); ++i) {
      if (i + kAhead < left_.size()) met_.fetch(left_[i + kAhead]);
      const FeaturePair& pair = left_[i];
      if (!met_.insert(pair) || (exclusions_ != nullptr && exclusions_->excludes(mesh_, pair))) continue;
      if (pair.kind == FeaturePair::Kind::vertex_face)
        add(vertex_faces_, pair, vertex_face(mesh_, *motion_, VertexId{pair.a}, TriangleId{pair.b}));
      else
        add(edge_edges_, pair, edge_edge(mesh_, *motion_, EdgeId{pair.a}, EdgeId{pair.b}));
    }
    test_all(vertex_faces_), test_all(edge_edges_);
  }
  // Whoever wants the time alone needs no pair that cannot touch earlier than what was found.
  template <class Query>
  void add(Tests<Query>& tests, const FeaturePair& pair, const Query& query) {
    const double thick = thickness_.of(mesh_, pair);
    if (time_alone_ && found_any_) {
      const double enough = (1 - kTimeAloneShare) * earliest_, before = apart_before(query, thick, enough);
      if (before >= enough) {
        left_out_from_ = std::min(left_out_from_, before);
        return;
      }
    }
    tests.add(pair, query, thick);
  }
  template <class Query>
  void test_all(Tests<Query>& tests) {
    tests.answers.resize(tests.pairs.size());
    const std::span<const Query> queries = tests.queries;
    const std::span<const double> thickness = tests.thickness;
    const std::span<Answer> answers = tests.answers;
    pool_.ranges(queries.size(), kAskedTogether, [&](std::size_t first, std::size_t last, std::size_t) {
      const std::size_t count = last - first;
      if (thickness_.is_zero())
        test_.answer(queries.subspan(first, count), answers.subspan(first, count));
      else
        test_.answer_close(queries.subspan(first, count), thickness.subspan(first, count),
                           answers.subspan(first, count));
    });
    for (std::size_t i = 0; i < tests.pairs.size(); ++i) take_answer(tests.pairs[i], tests.answers[i]);
  }
  void take_answer(const FeaturePair& pair, const Answer& answer) {
    ++counts_.elementary_tests;
    if (answer.verdict != Verdict::apart) {
      memory_.look(out_->contacts);
      out_->contacts.push_back({pair, answer.verdict, answer.time});
    }
    if (answer.verdict != Verdict::contact) return;
    earliest_ = std::min(earliest_, answer.time);
    found_any_ = true;
    if (any_contact_ || (stops_at_start_ && earliest_ <= 0)) close();
  }

  const TriangleMesh& mesh_;
  const ElementaryTest& test_;
  const bool first_only_;
  const Exclusions* const exclusions_;
  PairOptions options_;
  ThreadPool pool_;
  StageClock& clock_;
  const bool plain_sign_;  // the published filter
  LooseVertices loose_;
  const Motion* motion_ = nullptr;
  Thickness thickness_;
  ContactSet* out_ = nullptr;
  MemoryWatch memory_;
  Crossings* start_ = nullptr;
  std::size_t most_ = 0;      // crossings that are kept
  bool any_contact_ = false;  // one is enough
  bool time_alone_ = false;   // Step::time_alone
  bool stops_at_start_ = false, found_any_ = false;
  double left_out_from_ = 2;  // with time_alone_, no pair that was left out touches before
  bool first_ = false;        // only the contacts of the earliest time, or any one, are asked for
  PairCounts counts_;
  std::vector<TrianglePair> kept_;     // the block without what is excluded
  std::vector<CarriedPairs> carried_;  // by the block's triangle pairs; one pair may be carried repeatedly
  std::vector<std::vector<FeaturePair>> lists_;  // [ranges]: what the filter left of each
  std::vector<FeaturePair> left_;                // feature pairs that the filter could not prove apart
  std::size_t room_of_tests_ = 0;                // for so many of them there is memory
  FeaturePairSet met_;                           // feature pairs met in this interval
  std::optional<FeatureOwners> owners_;
  bool by_owners_ = false, owned_alone_ = false;
  std::vector<FeaturePair> remembered_;   // those that touched first in an earlier step
  Tests<MovingVertexFace> vertex_faces_;  // those left that are met for the first time
  Tests<MovingEdgeEdge> edge_edges_;
  double earliest_ = 1;  // contact so far
  std::vector<Bounded> order_;
};

class ComposedDetector : public Detector {
 public:
  ComposedDetector(std::unique_ptr<Culler> culler, const StrategyInput& setup, PairOptions options)
      : starts_embedded_(options.starts_embedded),
        excludes_(setup.exclusions != nullptr),
        culler_(std::move(culler)),
        tester_(setup, std::move(options), clock_) {}

  Report detect(const Step& step, ContactSet& out) override {
    out.clear();
    if (!step.thickness.is_zero() && !culler_->knows_distance(step.thickness))
      throw InputError(step.thickness.is_uniform()
                           ? "this strategy has no proof for a thickness above 0; take base, drvbc, "
                             "drvbc_fast, drvbc_fast_all or drvbc_fast_complete"
                           : "this strategy has no proof for pairs of different thickness; take base or "
                             "drvbc_fast_complete");
    Step known = step;
    // A start that is to be looked at is not taken for granted. The first contact may be an excluded one, and
    // then says nothing of the others.
    known.starts_embedded = (step.starts_embedded || starts_embedded_) && !step.crossings && !excludes_;
    tester_.start_interval(step, out);
    clock_.reset();

    Report report;
    bool classified = false;
    clock_.enter(Stage::elementary);
    tester_.test_remembered();
    tester_.test_loose();
    if (!tester_.closed()) {
      clock_.enter(Stage::refit);
      culler_->refit_beginning(step, tester_.until());
      clock_.enter(Stage::classify);
      classified = culler_->classify(known);
      tester_.trust_owners(culler_->keeps_all());
      clock_.enter(Stage::traversal);
      report.cull = culler_->cull(tester_);
      tester_.finish_interval();
    }
    tester_.trust_owners(true);
    if (!out.contacts.empty() && !tester_.first_only())
      if (const auto rest = culler_->cull_rest(tester_)) {
        *report.cull.bvot += *rest;
        tester_.finish_interval();
      }
    tester_.settle_time();
    clock_.stop();

    report.cull.pctp = tester_.count();
    report.pairs = tester_.counts();
    report.ms.refit = clock_.milliseconds(Stage::refit);
    if (classified) report.ms.classify = clock_.milliseconds(Stage::classify);
    report.ms.traversal = clock_.milliseconds(Stage::traversal);
    report.ms.elementary = clock_.milliseconds(Stage::elementary);
    report.start_ms = clock_.milliseconds(Stage::start);
    if (step.crossings) std::ranges::sort(step.crossings->pairs);
    return report;
  }
  bool pass_on(const Step& step, TrianglePairSink& sink) override {
    if (!culler_->knows_distance(step.thickness)) return false;
    culler_->refit(step);
    culler_->classify(step);
    culler_->cull(sink);
    sink.flush();
    return true;
  }
  void forget() override { culler_->forget(), tester_.forget(); }
  std::vector<std::byte> saved_preparation() const override { return culler_->saved_preparation(); }
  const fast::PatchTree* patches() const override { return culler_->patches(); }
  RadialView radial_view() const override { return culler_->radial_view(); }

 private:
  const bool starts_embedded_, excludes_;
  StageClock clock_;
  std::unique_ptr<Culler> culler_;
  PairTester tester_;
};

}  // namespace

std::unique_ptr<Detector> compose(std::unique_ptr<Culler> culler, const StrategyInput& setup,
                                  PairOptions options) {
  return std::make_unique<ComposedDetector>(std::move(culler), setup, std::move(options));
}

}  // namespace cscd
