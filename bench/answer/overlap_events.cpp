#include "bench/answer/overlap_events.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "core/base/sort_unique.h"
#include "core/base/stopwatch.h"
#include "core/elementary/exact/static_contact.h"

namespace cscd::bench {
namespace {

// What crosses at rest and bends is a little deeper in most poses: up to this factor, it is as deep as at
// rest.
constexpr double kDeeper = 1.1;

CrossingPair pair_of(const std::array<TriangleId, 2>& segment) {
  return std::minmax(segment[0], segment[1]);
}

// The event that most of the marks name, among those whose first two numbers are listed; kNone for none.
class Votes {
 public:
  template <class Marks>
  void add(const Marks& marks, std::int32_t a, std::int32_t b) {
    for (auto at = std::ranges::lower_bound(marks, std::tuple(a, b, std::size_t{0}));
         at != marks.end() && std::get<0>(*at) == a && std::get<1>(*at) == b; ++at)
      ++count_[std::get<2>(*at)];
  }
  std::size_t most() const {
    const auto most = std::ranges::max_element(count_, {}, [](const auto& entry) { return entry.second; });
    return most == count_.end() ? OverlapEvents::kNone : most->first;
  }

 private:
  std::map<std::size_t, std::size_t> count_;
};

}  // namespace

OverlapEvents::OverlapEvents(const Input& input, const SurfaceNames& names, const Answerer& answerer)
    : input_(input), names_(names), answerer_(answerer), finder_(input.mesh) {}

OverlapEvents::Kind OverlapEvents::kind_of(const Overlaps& all, const Overlap& overlap,
                                           const IntervalAnswer& answer) const {
  if (answer.explained_pairs.empty() && answer.ignored_pairs.empty()) return Kind::counted;
  std::size_t pairs = 0, counted = 0, ignored = 0;
  for_each_segment(all.crossing, overlap, [&](const auto& segment) {
    const CrossingPair pair = pair_of(segment);
    ++pairs;
    counted += answer.start.contains(pair) || answer.start_touching.contains(pair);
    ignored += std::ranges::binary_search(answer.ignored_pairs, pair_of(segment));
  });
  if (2 * counted > pairs) return Kind::counted;
  return 2 * ignored < pairs ? Kind::crosses_at_rest : Kind::ignored;
}

double OverlapEvents::depth_at_rest(const Overlaps& all, const Overlap& overlap) {
  if (!rest_) {
    std::vector<CrossingPair> met;
    std::ranges::merge(answerer_.rest_crossings().pairs, answerer_.rest_touching().pairs,
                       std::back_inserter(met));
    rest_.emplace(input_.mesh, finder_, input_.rest(), met);
  }
  return rest_->most_near(all.crossing, overlap);
}

NamePair OverlapEvents::names_of(const Overlaps& all, const Overlap& overlap) const {
  // The deepest point lies in the component whose triangle is nearest to it. Within one component, the side
  // of each curve on which the deepest region lies; 0 where that bounds none.
  const TriangleId nearest = overlap.depth.nearest;
  std::map<std::int32_t, std::size_t> side;
  if (!overlap.regions.empty())
    for (const std::int32_t image : overlap.regions.front().image)
      side.try_emplace(image / 2, static_cast<std::size_t>(image % 2));
  std::map<std::pair<std::int32_t, std::int32_t>, std::pair<std::size_t, std::array<TriangleId, 2>>> count;
  auto last = count.end();  // neighbouring segments are mostly between the same places
  const auto add = [&](const std::array<TriangleId, 2>& segment, std::size_t own) {
    const auto component = [&](std::size_t s) { return input_.mesh.component(segment[s]); };
    if (nearest != TriangleId{-1} && component(0) != component(1))
      own = component(0) == input_.mesh.component(nearest) ? 1 : 0;
    const std::pair places(names_.place_number(segment[own]), names_.place_number(segment[1 - own]));
    if (last == count.end() || last->first != places) last = count.try_emplace(places).first;
    auto& [times, example] = last->second;
    ++times;
    example = {segment[own], segment[1 - own]};
  };
  for (const std::int32_t curve : overlap.curves) {
    const auto own = side.find(curve);
    if (!side.empty() && own == side.end()) continue;
    for (const auto& segment : all.crossing.curves[static_cast<std::size_t>(curve)].segments)
      add(segment, own == side.end() ? 0 : own->second);
  }
  for (const auto& segment : overlap.touching) add(segment, 0);
  const auto& [one, other] = std::ranges::max_element(count, {}, [](const auto& entry) {
                               return entry.second.first;
                             })->second.second;
  return {names_.place_of(one), names_.place_of(other)};
}

std::size_t OverlapEvents::continued_event(const Overlaps& all, const Overlap& overlap,
                                           const NamePair& names) {
  Votes by_vertex, by_pair;
  for (const CrossingRegion& region : overlap.regions)
    for (const VertexId v : region.vertices)
      by_vertex.add(vertices_, static_cast<std::int32_t>(v), region.other);
  if (const std::size_t event = by_vertex.most(); event != kNone) return event;
  if (!std::exchange(pairs_are_sorted_, true)) std::ranges::sort(pairs_);
  for_each_segment(all.crossing, overlap, [&](const auto& segment) {
    const auto [a, b] = pair_of(segment);
    by_pair.add(pairs_, static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
  });
  if (const std::size_t event = by_pair.most(); event != kNone) return event;
  const NamePair swapped{names.second, names.first};
  for (const std::size_t event : going_on_)
    if (events_[event].names == names || events_[event].names == swapped) return event;
  return kNone;
}

void OverlapEvents::extend(OverlapEvent& event, const Overlaps& all, const Overlap& overlap,
                           const NamePair& names, const IntervalAnswer& answer, std::span<const Vec3> start,
                           const std::optional<double>& at_rest) {
  const bool is_new = event.depth_at.empty();
  if (is_new) event.first = answer.index;
  event.last = answer.index;
  event.depth_at.resize(answer.index - event.first + 1, 0.0);
  event.depth_at.back() = std::max(event.depth_at.back(), overlap.depth.lower);
  const auto order = [](const CrossingDepth& depth) { return std::tuple(depth.lower, depth.upper); };
  if (!is_new && order(overlap.depth) <= order(event.depth)) return;
  event.names = names;
  event.deepest = answer.index;
  event.depth = overlap.depth;
  event.curves = overlap.curves.size();
  event.pairs = event.vertices = 0;
  event.area = 0;
  event.at_rest = at_rest;
  event.crosses = at_rest.has_value() || overlap.curves.empty();  // one lies in the other altogether
  for_each_segment(all.crossing, overlap, [&](const auto& segment) {
    event.crosses = event.crosses || !answer.start_touching.contains(pair_of(segment));
  });
  const auto curve = [&](std::int32_t c) -> const CrossingCurve& {
    return all.crossing.curves[static_cast<std::size_t>(c)];
  };
  for (const std::int32_t c : overlap.curves) event.pairs += curve(c).segments.size();
  if (!overlap.regions.empty()) {
    const CrossingRegion& deepest = overlap.regions.front();
    event.vertices = deepest.vertices.size();
    event.area = deepest.area;
    event.side = deepest.side;
    event.other_is_open = deepest.other_is_open;
  }
  event.point = event.depth.nearest != TriangleId{-1}
                    ? event.depth.point
                    : all.crossing.point(curve(overlap.curves.front()).nodes.front(), start);
}

// Pieces may cross along edges of both alone, so that no two triangles pass through each other. A point of
// one then lies off the other's skin, inside of it. Where faces rest on each other, that proves nothing,
// because what lies inside there follows from how ties are broken.
void OverlapEvents::tell_crossing_pieces(std::span<const Vec3> start, Overlaps& all,
                                         IntervalAnswer& answer) const {
  if (answer.start_touching.total == 0) return;
  double largest = 0;
  for (const Vec3& x : start) largest = std::max(largest, x.cwiseAbs().maxCoeff());
  std::vector<CrossingPair> crossing = answer.start.pairs;
  for (Overlap& overlap : all.overlaps) {
    if (overlap.depth.lower <= kOnSheet * largest) overlap.depth.lower = 0;
    std::vector<CrossingPair> pairs;
    for_each_segment(all.crossing, overlap, [&](const auto& segment) { pairs.push_back(pair_of(segment)); });
    const auto crosses = [&](const CrossingPair& pair) { return answer.start.contains(pair); };
    const auto rests = [&](const CrossingPair& pair) {
      return lie_on_each_other(input_.mesh, start, pair.first, pair.second) == -1;
    };
    if (std::ranges::none_of(pairs, crosses) && std::ranges::any_of(pairs, rests)) overlap.depth.lower = 0;
    if (overlap.depth.lower > 0 || std::ranges::any_of(pairs, crosses))
      std::ranges::copy_if(pairs, std::back_inserter(crossing),
                           [&](const CrossingPair& pair) { return answer.start_touching.contains(pair); });
  }
  sort_unique(crossing);
  std::erase_if(answer.start_touching.pairs,
                [&](const CrossingPair& pair) { return std::ranges::binary_search(crossing, pair); });
  answer.start_touching.total = answer.start_touching.pairs.size();
  answer.start.pairs = std::move(crossing);
  answer.start.total = answer.start.pairs.size();
  answer.verdict = verdict_of(answer, input_.thickness.length > 0);
}

OverlapEvents::Here OverlapEvents::add(IntervalAnswer& answer, std::span<const Vec3> start,
                                       const Wanted& wanted) {
  const Stopwatch watch;
  Here here;
  std::vector<Mark> vertices, pairs;
  std::vector<std::size_t> going_on;
  const Crossings all = all_meetings(answer);
  not_measured_ += all.total > kMostPairs;
  if (all.total > answer.ignored_pairs.size() && all.total <= kMostPairs) {
    here.overlaps = finder_.find(start, all.pairs, wanted.displacements);
    tell_crossing_pieces(start, here.overlaps, answer);
    for (const Overlap& overlap : here.overlaps.overlaps) {
      here.event.push_back(kNone);
      const Kind kind = kind_of(here.overlaps, overlap, answer);
      if (kind == Kind::ignored) continue;
      std::optional<double> at_rest;
      if (kind == Kind::crosses_at_rest) {
        at_rest = depth_at_rest(here.overlaps, overlap);
        if (!(overlap.depth.lower > kDeeper * *at_rest)) continue;
      }
      const NamePair names = names_of(here.overlaps, overlap);
      std::size_t event = continued_event(here.overlaps, overlap, names);
      if (event == kNone) {
        event = events_.size();
        events_.emplace_back();
      }
      extend(events_[event], here.overlaps, overlap, names, answer, start, at_rest);
      here.event.back() = event;
      going_on.push_back(event);
      for (const CrossingRegion& region : overlap.regions)
        for (const VertexId v : region.vertices)
          vertices.emplace_back(static_cast<std::int32_t>(v), region.other, event);
      for_each_segment(here.overlaps.crossing, overlap, [&](const auto& segment) {
        const auto [a, b] = pair_of(segment);
        pairs.emplace_back(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b), event);
      });
    }
  }
  if (wanted.pieces || !answer.found.contacts.empty())
    here.pieces = OverlapPieces(input_.mesh, here.overlaps, here.event);
  for (const Contact& contact : answer.found.contacts) {
    const std::size_t event = here.pieces.empty() ? kNone : here.pieces.find(input_.mesh, contact.pair);
    answer.event_of_contact.push_back(event);
    if (event != kNone) ++events_[event].contacts;
  }
  std::ranges::sort(vertices);
  std::ranges::sort(going_on);
  vertices_ = std::move(vertices);
  pairs_ = std::move(pairs);
  pairs_are_sorted_ = false;
  going_on_ = std::move(going_on);
  milliseconds_ += watch.milliseconds();
  return here;
}

void keep_new(const Input& input, const OverlapPieces& pieces, IntervalAnswer& answer) {
  for (Crossings* const met : {&answer.start, &answer.start_touching}) {
    const std::size_t old = std::erase_if(met->pairs, [&](const CrossingPair& pair) {
      return pieces.find(pair.first, pair.second) != OverlapEvents::kNone;
    });
    met->total -= old;
    answer.old_pairs += old;
  }
  answer.old_contacts = std::erase_if(answer.found.contacts, [&](const cscd::Contact& contact) {
    if (pieces.find(input.mesh, contact.pair) == OverlapEvents::kNone) return false;
    answer.touching.erase(contact.pair);
    return true;
  });
  answer.event_of_contact.clear();
  answer.verdict = verdict_of(answer, input.thickness.length > 0);
}

bool is_known(const CrossingDepth& depth) {
  constexpr double kRounding = 1e-9;  // a share of the bound below which a depth is nothing but rounding
  return depth.lower > kRounding * depth.upper;
}

std::vector<std::size_t> deepest_first(std::span<const OverlapEvent> events) {
  std::vector<std::size_t> order(events.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t i) {
    return std::tuple(events[i].depth.lower, events[i].depth.upper);
  });
  return order;
}

}  // namespace cscd::bench
