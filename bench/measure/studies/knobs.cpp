#include "bench/measure/studies/knobs.h"

#include <algorithm>
#include <functional>
#include <random>
#include <set>

#include "bench/compare/statistics/statistics.h"
#include "bench/measure/replay/interval_choice.h"
#include "bench/measure/strategies/catalogue.h"
#include "bench/measure/studies/knob_volumes.h"
#include "bench/query/input/input.h"
#include "core/base/random.h"
#include "core/detect/start/embedding.h"
#include "core/drvbc/drvbc.h"
#include "core/elementary/catalogue.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

struct Setting {
  std::string knob, value;
  std::function<Prepared(const StrategyInput&)> make;
  const ElementaryTest* elementary = nullptr;  // instead of the study's
};

Setting varied(const char* knob, const std::string& value, const std::function<void(DrvbcOptions&)>& change) {
  DrvbcOptions options;
  change(options);
  return {knob, value, [options](const StrategyInput& setup) { return make_drvbc(setup, options); }};
}

std::string text(double value) {
  return ordered_json(value).dump();
}

// The first is the default.
std::vector<Setting> settings() {
  std::vector<Setting> all = {varied("default", "drvbc", [](DrvbcOptions&) {})};
  const auto add = [&](Setting setting) { all.push_back(std::move(setting)); };
  for (const ElementaryTest& row : all_elementary_tests()) {
    add(varied("elementary", std::string(row.name), [](DrvbcOptions&) {}));
    all.back().elementary = &row;
  }
  add(varied("filter", "certain sign", [](DrvbcOptions&) {}));
  add(varied("filter", "plain sign", [](DrvbcOptions& o) { o.filter = PairFilter::plain_sign; }));
  add(varied("filter", "none", [](DrvbcOptions& o) { o.filter = PairFilter::none; }));
  add(varied("relative boxes", "on", [](DrvbcOptions&) {}));
  add(varied("relative boxes", "off", [](DrvbcOptions& o) { o.relative_boxes = false; }));
  add(varied("segment seen from", "3 corners", [](DrvbcOptions&) {}));
  add(varied("segment seen from", "1 corner",
             [](DrvbcOptions& o) { o.segment_test = radial::SegmentTest::first_corner; }));
  add(varied("orientation by", "certain sign", [](DrvbcOptions&) {}));
  add(varied("orientation by", "plain sign",
             [](DrvbcOptions& o) { o.orientation_sign = radial::SignTest::plain; }));
  add(varied("orientation by", "sign of halves",
             [](DrvbcOptions& o) { o.orientation_sign = radial::SignTest::halved; }));
  for (const double gamma : {0.0, 0.02, 0.05, 0.1, 0.2, 0.3})
    add(varied("gamma", text(gamma), [&](DrvbcOptions& o) { o.gamma = gamma; }));
  for (const double theta : {2.0, 5.0, 10.0, 20.0, 45.0})
    add(varied("theta (degrees)", text(theta), [&](DrvbcOptions& o) { o.bones.theta_degrees = theta; }));
  for (const int cells : {2, 4, 8})
    add(varied("field cells (edges)", std::to_string(cells),
               [&](DrvbcOptions& o) { o.bones.coarsening = cells; }));
  for (const char* name : {"drvbc", "base"}) {
    const Strategy& strategy = strategy_named(name);
    add({"guarantee", std::string(to_string(strategy.guarantee)), strategy.make});
  }
  for (const VolumeRow& row : volume_rows())
    add({"volumes (no radial culling)", std::string(row.name), row.make});
  return all;
}

struct Subject {
  Setting setting;
  std::unique_ptr<Detector> detector;
  std::uint64_t contacts = 0, invented = 0, lost_first = 0;
  std::vector<double> ms;  // of each interval, the median over repetitions
};

std::set<FeaturePair> pairs_of(const ContactSet& found) {
  std::set<FeaturePair> pairs;
  for (const Contact& contact : found.contacts) pairs.insert(contact.pair);
  return pairs;
}

// Contacts are rare, and where there are none nothing can be lost.
std::vector<std::size_t> chosen_intervals(Input& input, Detector& detector, const KnobStudy& study) {
  const IntervalRange range{0, input.clip->interval_count()};
  return with_contacts(every_kth(range, study.every), intervals_with_contacts(input, detector, range),
                       study.colliding);
}

}  // namespace

nlohmann::ordered_json study_knobs(const std::string& scene, const KnobStudy& study) {
  Input input = open_input(scene);
  const ElementaryTest& exact = elementary_test_named("filtered_exact");
  std::vector<Subject> subjects;
  for (Setting& setting : settings()) {
    Subject& subject = subjects.emplace_back();
    subject.detector = setting.make(input.setup(setting.elementary ? *setting.elementary : exact)).detector;
    subject.setting = std::move(setting);
  }
  const std::unique_ptr<Detector> reference =
      complete_reference().make(input.setup(elementary_test_named("exact"))).detector;
  EmbeddingTest embedding(input.mesh, input.reference);
  const std::vector<std::size_t> intervals = chosen_intervals(input, *subjects.front().detector, study);

  std::uint64_t contacts = 0, colliding = 0, embedded_colliding = 0;
  std::mt19937_64 random(study.seed);
  std::vector<std::size_t> order(subjects.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  ContactSet truth, answer;
  for (const std::size_t i : intervals) {
    const scenes::ClipInterval interval = input.clip->load(i);
    const Rig::Interval* bones = interval.bones ? &*interval.bones : nullptr;
    const bool embedded = embedding.embedded(interval.motion.start());
    reference->detect({interval.motion, bones}, truth);
    truth.sort();
    const std::set<FeaturePair> expected = pairs_of(truth);
    contacts += expected.size();
    colliding += !expected.empty();
    embedded_colliding += embedded && !expected.empty();
    for (Subject& subject : subjects) {
      subject.detector->detect({interval.motion, bones}, answer);
      const std::set<FeaturePair> found = pairs_of(answer);
      for (const FeaturePair& pair : found) ++(expected.contains(pair) ? subject.contacts : subject.invented);
      const bool has_first = std::any_of(truth.contacts.begin(), truth.contacts.end(), [&](const Contact& c) {
        return c.time == truth.contacts.front().time && found.contains(c.pair);
      });
      subject.lost_first += embedded && !expected.empty() && !has_first;
    }
    std::vector<std::vector<double>> samples(subjects.size());
    for (int repetition = 0; repetition < study.repetitions; ++repetition) {
      shuffle(order, random);
      for (const std::size_t k : order)
        samples[k].push_back(subjects[k].detector->detect({interval.motion, bones}, answer).ms.total());
    }
    for (std::size_t k = 0; k < subjects.size(); ++k) subjects[k].ms.push_back(median(samples[k]));
  }

  ordered_json rows = ordered_json::array();
  double default_ms = 0;
  for (const Subject& subject : subjects) {
    const double ms = mean(subject.ms);
    if (&subject == &subjects.front()) {
      default_ms = ms;
      continue;
    }
    rows.push_back({{"knob", subject.setting.knob},
                    {"value", subject.setting.value},
                    {"ms", ms},
                    {"contacts", subject.contacts},
                    {"invented", subject.invented},
                    {"lost_first", subject.lost_first}});
  }
  return {{"scene", scene},
          {"elementary", exact.name},
          {"intervals", intervals.size()},
          {"colliding", colliding},
          {"colliding_embedded", embedded_colliding},
          {"contacts", contacts},
          {"default_ms", default_ms},
          {"settings", std::move(rows)}};
}

}  // namespace cscd::bench
