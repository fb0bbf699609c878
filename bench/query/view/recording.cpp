#include "bench/query/view/recording.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "bench/answer/answer_json.h"
#include "bench/answer/answer_text.h"
#include "core/base/error.h"
#include "core/detect/contact_geometry.h"
#include "core/detect/start/crossings.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

std::uint16_t share(double of_one) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(of_one, 0.0, 1.0) * 65535));
}

std::uint32_t count(std::uint64_t number) {
  return static_cast<std::uint32_t>(
      std::min<std::uint64_t>(number, std::numeric_limits<std::uint32_t>::max()));
}

}  // namespace

std::uint16_t TextTable::number_of(const std::string& text) {
  if (texts_.size() > std::numeric_limits<std::uint16_t>::max())
    throw InputError("the surface has more than 65536 names of bones and parts; choose a --component");
  const auto [known, added] = known_.try_emplace(text, static_cast<std::uint16_t>(texts_.size()));
  if (added) texts_.push_back(text);
  return known->second;
}

void ViewBits::append(const std::vector<bool>& bits) {
  std::vector<std::uint8_t> packed((bits.size() + 7) / 8);
  for (std::size_t i = 0; i < bits.size(); ++i)
    if (bits[i]) packed[i / 8] = static_cast<std::uint8_t>(packed[i / 8] | 1U << i % 8);
  last_.resize(packed.size());
  for (std::size_t i = 0; i < packed.size(); ++i)
    bytes_.push_back(static_cast<std::uint8_t>(packed[i] ^ last_[i]));
  last_ = std::move(packed);
}

void ObserverRecording::add(const std::vector<RadialView::Observer>& observers, const ViewGrid& grid,
                            const std::function<std::uint16_t(std::int32_t)>& label) {
  count_.push_back(count(observers.size()));
  for (const RadialView::Observer& observer : observers) {
    cluster_.push_back(label(observer.cluster));
    for (const Vec3& x : {observer.head.start, observer.head.end, observer.tail.start, observer.tail.end})
      for (int axis = 0; axis < 3; ++axis)
        place_.push_back(static_cast<std::int16_t>(
            std::clamp((x[axis] - grid.origin()[axis]) / (4 * grid.step()), -32767.0, 32767.0)));
  }
}

void ObserverRecording::write(Sections& sections, const std::string& prefix) const {
  sections.add(prefix + "observer_count", count_);
  sections.add(prefix + "observer_cluster", cluster_);
  sections.add(prefix + "observer_place", place_);
}

StrategyRecording::StrategyRecording(const ClipAnswer& answer, const ViewGrid& grid)
    : answer_(answer), strategy_observers_(answer.input, answer.strategy, answer.elementary), grid_(grid) {
  if (strategy_observers_.preparation().atomic_clusters > std::numeric_limits<std::uint16_t>::max())
    throw InputError("strategy " + std::string(answer_.strategy.name) +
                     ": made more than 65535 clusters, more than a page shows; choose a --component");
}

void StrategyRecording::add(const IntervalAnswer& answer, const scenes::ClipInterval& interval,
                            TextTable& places) {
  const std::string by(answer.strategy->name);
  auto known = std::find(answered_by_.begin(), answered_by_.end(), by);
  if (known == answered_by_.end()) known = answered_by_.insert(known, by);
  answerer_.push_back(static_cast<std::uint8_t>(known - answered_by_.begin()));
  verdict_.push_back(static_cast<std::uint8_t>(answer.verdict));
  proven_.push_back(answer.proven);
  milliseconds_.push_back(static_cast<float>(answer.report.ms.total()));
  start_pairs_.push_back(count(answer.start.total));
  pairs_.push_back(count(answer.report.cull.pctp));
  tests_.push_back(count(answer.report.pairs.elementary_tests));

  std::uint32_t contacts = 0, kept = 0;
  std::vector<bool> touched(answer_.input.mesh.triangle_count()), close(touched);
  for (const Contact& contact : answer.found.contacts) {
    if (contact.verdict != Verdict::contact) continue;
    ++contacts;
    const bool touches = !is_thick() || answer.touching.contains(contact.pair);
    std::vector<bool>& marked = touches ? touched : close;
    for (const auto& [first, second] : carriers(answer_.input.mesh, contact.pair))
      marked[+first] = marked[+second] = true;
    if (kept == kMostContacts) continue;
    ++kept;
    add_contact(contact, interval.motion, places);
    touches_.push_back(touches);
  }
  touched_.append(touched);
  close_.append(close);
  contacts_.push_back(contacts);
  kept_contacts_.push_back(kept);
  undecided_.push_back(count(answer.found.contacts.size()) - contacts);
  const std::size_t pairs = std::min(kMostStartPairs, answer.start.pairs.size());
  for (std::size_t i = 0; i < pairs; ++i)
    for (const TriangleId t : {answer.start.pairs[i].first, answer.start.pairs[i].second})
      crossing_.push_back(static_cast<std::int32_t>(t));
  kept_pairs_.push_back(count(pairs));
  if (has_clusters()) add_view(interval);
}

void StrategyRecording::add_contact(const Contact& contact, const Motion& motion, TextTable& places) {
  const bool face = contact.pair.kind == FeaturePair::Kind::vertex_face;
  kind_.push_back(face ? 0 : 1);
  time_in_.push_back(share(contact.time));
  const auto vertex = [&](VertexId v) { vertex_.push_back(static_cast<std::int32_t>(v)); };
  if (face) {
    vertex(VertexId{contact.pair.a});
    for (const VertexId v : answer_.input.mesh.corners(TriangleId{contact.pair.b})) vertex(v);
  } else {
    for (const std::int32_t edge : {contact.pair.a, contact.pair.b})
      for (const VertexId v : answer_.input.mesh.ends(EdgeId{edge})) vertex(v);
  }
  const ContactGeometry geometry = contact_geometry(answer_.input.mesh, motion, contact.pair, contact.time);
  along_first_.push_back(face ? 0 : share(geometry.weights[0]));
  const Vec3 normal = geometry.normal.value_or(Vec3::Zero());
  for (int axis = 0; axis < 3; ++axis)
    normal_.push_back(static_cast<std::int8_t>(std::lround(127 * normal[axis])));
  for (const bool second : {false, true})
    place_.push_back(places.number_of(answer_.names.place_of(contact.pair, second)));
}

// Asks the observers. A cluster goes by the first of its atomic clusters, so that it keeps its number from
// one interval to the next.
void StrategyRecording::add_view(const scenes::ClipInterval& interval) {
  const Report report = strategy_observers_.look(interval);
  const RadialView view = strategy_observers_.view();
  clusters_.push_back(report.cull.radial ? count(report.cull.radial->clusters) : 0);

  positive_.append(view.positive);
  const Preparation& preparation = strategy_observers_.preparation();
  const std::vector<std::int32_t>& atomic = preparation.atomic_cluster;
  std::map<std::int32_t, std::uint16_t> first;  // of the atomic clusters that have a label
  std::vector<std::int32_t> label(static_cast<std::size_t>(preparation.atomic_clusters), -1);
  for (std::size_t t = 0; t < atomic.size(); ++t) {
    std::int32_t& known = label[static_cast<std::size_t>(atomic[t])];
    if (known < 0) known = view.cluster[t];
    if (known != view.cluster[t])
      throw std::logic_error("an atomic cluster of " + std::string(answer_.strategy.name) +
                             " has two observers");
  }
  for (std::size_t a = 0; a < label.size(); ++a)
    cluster_of_atomic_.push_back(first.try_emplace(label[a], static_cast<std::uint16_t>(a)).first->second);

  observers_.resize(1 + view.further_covers.size());
  observers_[0].add(view.observers, grid_, [&](std::int32_t cluster) { return first.at(cluster); });
  for (std::size_t c = 0; c < view.further_covers.size(); ++c)
    observers_[c + 1].add(view.further_covers[c].observers, grid_,
                          [](std::int32_t cluster) { return static_cast<std::uint16_t>(cluster); });
  if (!further_covers_.empty() || !patch_.empty()) return;
  for (const RadialView::Cover& cover : view.further_covers) further_covers_.push_back(cover.cluster);
  patch_ = view.patch;
}

json StrategyRecording::write(Sections& sections, const std::string& prefix) const {
  const auto put = [&](const std::string& name, const auto& values) { sections.add(prefix + name, values); };
  put("verdict", verdict_);
  put("proven", proven_);
  put("answerer", answerer_);
  put("milliseconds", milliseconds_);
  put("contacts", contacts_);
  put("undecided", undecided_);
  put("start_pairs", start_pairs_);
  put("pairs", pairs_);
  put("tests", tests_);
  put("kept_contacts", kept_contacts_);
  put("kept_pairs", kept_pairs_);
  put("contact_kind", kind_);
  put("contact_time", time_in_);
  put("contact_along", along_first_);
  put("contact_normal", normal_);
  put("contact_vertex", vertex_);
  put("contact_place", place_);
  put("crossing", crossing_);
  put("touched", touched_.bytes());
  if (is_thick()) put("close", close_.bytes()), put("contact_touches", touches_);
  if (has_clusters()) {
    const std::vector<std::int32_t>& atomic = strategy_observers_.preparation().atomic_cluster;
    put("atomic", std::vector<std::uint16_t>(atomic.begin(), atomic.end()));
    put("cluster_of_atomic", cluster_of_atomic_);
    put("positive", positive_.bytes());
    put("clusters", clusters_);
    for (std::size_t c = 0; c < observers_.size(); ++c)
      observers_[c].write(sections, prefix + "cover" + std::to_string(c) + ".");
    for (std::size_t c = 0; c < further_covers_.size(); ++c)
      put("cover" + std::to_string(c + 1) + ".cluster", further_covers_[c]);
    put("patch", patch_);
  }
  return {{"name", answer_.strategy.name},
          {"guarantee", to_string(answer_.strategy.guarantee)},
          {"source", answer_.strategy.source},
          {"answered_by", answered_by_},
          {"atomic_clusters", strategy_observers_.preparation().atomic_clusters},
          {"has_clusters", has_clusters()},
          {"covers", observers_.size()},
          {"has_patches", !patch_.empty()},
          {"summary", summary_json(answer_)},
          {"sentences", verdict_sentences(answer_)},
          {"details", details_text(answer_)},
          {"text", clip_text(answer_)}};
}

}  // namespace cscd::bench
