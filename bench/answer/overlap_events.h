#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "bench/answer/answer.h"
#include "bench/answer/rest_depths.h"
#include "bench/inputs/surface_names.h"
#include "core/crossing/overlaps.h"
#include "core/crossing/pieces.h"

namespace cscd::bench {

// Two pieces of the surface that lie in each other for some time: "left hand in thigh". It is known at the
// starts of intervals, at each of which it is an Overlap.
struct OverlapEvent {
  NamePair names;                                // which place lies in which, where it is deepest
  std::size_t first = 0, deepest = 0, last = 0;  // intervals
  // All below is said of the start of interval `deepest`.
  CrossingDepth depth;
  Vec3 point = Vec3::Zero();  // the deepest, or where none is known, some point of a curve
  std::size_t pairs = 0, curves = 0;
  // Whether any of these pairs passes through each other. Where none does, the pieces only touch, or they
  // cross along edges of both.
  bool crosses = true;
  // Of the deepest region (CrossingRegion). There is none where no vertex lies in the other sheet.
  std::size_t vertices = 0;
  double area = 0;
  CrossingRegion::Side side = CrossingRegion::Side::behind;
  bool other_is_open = false;
  // Of pieces that cross at rest: how deep they lie there (RestDepths), which is less than `depth.lower`.
  std::optional<double> at_rest;
  std::vector<double> depth_at;  // of intervals first to last; 0 where it pauses
  std::size_t contacts = 0;      // of these intervals, between its pieces
};

// Whether more is known of a depth than what it does not exceed.
bool is_known(const CrossingDepth& depth);

// The numbers of events in the order of their depths, deepest first.
std::vector<std::size_t> deepest_first(std::span<const OverlapEvent> events);

// Follows overlaps from interval to interval. An overlap continues the event with whose regions it shares
// most vertices. An overlap that shares no vertex with any continues the event with which it shares most
// crossing pairs of triangles. If it shares none of these either, it continues an event between the same two
// places that no other overlap continues. Overlaps of which most pairs of triangles are ignored are no
// events. Those of which most pairs are left out because they cross at rest are events where they lie deeper
// than at rest by more than a tenth.
class OverlapEvents {
 public:
  // `answerer` has found what meets at rest. All arguments must outlive it.
  OverlapEvents(const Input& input, const SurfaceNames& names, const Answerer& answerer);

  // `start` are the positions at the interval's start. Intervals come in growing order. Returns what overlaps
  // there, with the number of each one's event.
  struct Here {
    Overlaps overlaps;
    std::vector<std::size_t> event;  // [overlaps.overlaps]; kNone for those that are no events
    OverlapPieces pieces;  // of each event; only where the answer has contacts, or where they are wanted
  };
  static constexpr std::size_t kNone = OverlapPieces::kNone;
  struct Wanted {
    bool displacements = false;  // of all vertices, in the regions
    bool pieces = false;         // also where the answer has no contacts
  };
  // Writes into the answer to which event each contact belongs. Pairs that only touch, by triangles, count as
  // crossing from here on where their pieces cross.
  Here add(IntervalAnswer& answer, std::span<const Vec3> start, const Wanted& wanted);

  // All events, in the order in which they begin.
  const std::vector<OverlapEvent>& all() const { return events_; }
  double milliseconds() const { return milliseconds_; }
  // At how many starts more than kMostPairs pairs of triangles cross: nothing is said of these. A surface
  // with so many has collapsed, and pairs that touch exactly take long.
  static constexpr std::size_t kMostPairs = 100'000;
  std::size_t not_measured() const { return not_measured_; }

 private:
  void tell_crossing_pieces(std::span<const Vec3> start, Overlaps& all, IntervalAnswer& answer) const;

  using Mark =
      std::tuple<std::int32_t, std::int32_t, std::size_t>;  // what two numbers stand for, and the event

  // What an overlap is, by most of its pairs of triangles.
  enum class Kind { counted, crosses_at_rest, ignored };
  Kind kind_of(const Overlaps& all, const Overlap& overlap, const IntervalAnswer& answer) const;
  // How deep the overlap lies at rest.
  double depth_at_rest(const Overlaps& all, const Overlap& overlap);
  std::size_t continued_event(const Overlaps& all, const Overlap& overlap, const NamePair& names);
  NamePair names_of(const Overlaps& all, const Overlap& overlap) const;
  void extend(OverlapEvent& event, const Overlaps& all, const Overlap& overlap, const NamePair& names,
              const IntervalAnswer& answer, std::span<const Vec3> start,
              const std::optional<double>& at_rest);

  const Input& input_;
  const SurfaceNames& names_;
  const Answerer& answerer_;
  OverlapFinder finder_;
  std::optional<RestDepths> rest_;  // once it is asked for
  std::vector<OverlapEvent> events_;
  std::vector<Mark> vertices_, pairs_;  // of the last interval; sorted, pairs only once they are needed
  bool pairs_are_sorted_ = false;
  std::vector<std::size_t> going_on_;  // events of the last interval; sorted
  double milliseconds_ = 0;
  std::size_t not_measured_ = 0;
};

// Leaves out of an answer what lies within events: contacts, and pairs that meet at the start. `pieces` are
// those that lie in each other there.
void keep_new(const Input& input, const OverlapPieces& pieces, IntervalAnswer& answer);

}  // namespace cscd::bench
