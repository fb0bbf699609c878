// Exact answers at the price of floating-point answers.
//
// There are four stages. Each stage passes the queries that it cannot prove on to the next:
//   filter    proves that the four points are coplanar at no time, or that the relative boxes are apart
//             (the row `exact` of the catalogue has the same filter);
//   doubles   uses certain signs in double precision (doubles_stage.h), and pairs of doubles for the time
//             of a contact (contact_time.h);
//   integers  uses exact integers of fixed capacity (integer_contact.h, and at a distance close_integers.h);
//   oracle   answers queries that the integer stage gives up on (exact.h).
// Only the last stage allocates.
#include "core/elementary/certified/filtered_exact.h"

#include <algorithm>
#include <cmath>

#include "core/elementary/certified/close_doubles.h"
#include "core/elementary/certified/close_integers.h"
#include "core/elementary/certified/contact_time.h"
#include "core/elementary/certified/doubles_stage.h"
#include "core/elementary/certified/exact_lanes.h"
#include "core/elementary/certified/integer_contact.h"
#include "core/elementary/exact/closeness.h"
#include "core/elementary/exact/exact.h"
#include "core/elementary/question/query_scale.h"
#include "core/elementary/question/relative_box.h"

namespace cscd {
namespace {

struct Decision {
  Answer answer;
  ExactStage stage;
};
constexpr Answer kApart{Verdict::apart, 0};

template <class Query>
Decision by_oracle(const Query& query) {
  const auto time = exact::first_contact(query);
  return {time ? Answer{Verdict::contact, time->lo} : kApart, ExactStage::oracle};
}

template <class Query>
Decision by_integers(const Query& query) {
  const integer::Result result = integer::first_contact(query);
  if (result.outcome == integer::Outcome::gave_up) return by_oracle(query);
  const bool touch = result.outcome == integer::Outcome::contact;
  return {touch ? Answer{Verdict::contact, result.time} : kApart, ExactStage::integers};
}

template <class Query>
Decision time_by_integers(const Query& query, const DoublesResult& contact) {
  const integer::Result result = integer::contact_time(query, contact.low, contact.high);
  if (result.outcome == integer::Outcome::gave_up) return by_oracle(query);
  return {{Verdict::contact, result.time}, ExactStage::integers};
}

// Decides a query whose products of coordinates may underflow or overflow: scales the query's axes to the
// size of 1 first.
template <class Query>
Decision decide_beyond_range(const Query& query) {
  const Query scaled = axes_scaled_to_unit(query);
  const Triple v = triple(triple_points(scaled));
  const BernsteinCubic f = triple_product(v.p, v.q, v.r);
  if (certain_sign(f) != 0) return {kApart, ExactStage::filter};
  if (!std::isfinite(f.error)) return by_integers(query);
  const DoublesResult found = decide_in_doubles<Query>(v, f);
  if (found.kind == DoublesResult::apart) return {kApart, ExactStage::doubles};
  return found.kind == DoublesResult::contact ? time_by_integers(query, found) : by_integers(query);
}

template <class Query>
Decision decide(const Query& query) {
  const TriplePoints<MovingPoint> points = triple_points(query);
  const Triple v = triple(points);
  const BernsteinCubic f = triple_product(v.p, v.q, v.r);
  if (certain_sign(f) != 0 || relative_boxes_apart(query)) return {kApart, ExactStage::filter};
  if (!std::isfinite(f.error)) return decide_beyond_range(query);
  const DoublesResult found = decide_in_doubles<Query>(v, f);
  if (found.kind == DoublesResult::apart) return {kApart, ExactStage::doubles};
  if (found.kind == DoublesResult::unclear) return by_integers(query);
  const CertainTime<double> certain =
      time_in_pairs(points, v.sizes(), Cubic(f, ProvenBounds::cubic), found.low, found.high);
  if (!certain.known) return time_by_integers(query, found);
  return {{Verdict::contact, certain.time}, ExactStage::doubles};
}

constexpr std::size_t kWorthLanes = 2;  // the fewest queries for which lanes are faster than scalar code

// Queries that wait for one stage of the lanes until there are eight of them.
template <class Query>
struct Waiting {
  const Query* query[kLanes];
  Lane8 low = {}, high = {};  // of contacts
  std::size_t count = 0;

  std::span<const Query* const> all() const { return {query, count}; }
  bool full() const { return count == kLanes; }
  void add(const Query* of) { query[count++] = of; }
  void add(const Query* of, double lowest, double highest) {
    low[count] = lowest, high[count] = highest;
    add(of);
  }
};

// Sends queries through three stages of lanes, each of which has its lanes full: those whose cubic has one
// root at most, those with several, and the times of contacts. What a stage leaves undecided goes on to the
// next, and in the end to scalar code.
template <class Query>
class LaneStages {
 public:
  LaneStages(std::span<const Query> queries, std::span<Answer> answers)
      : first_(queries.data()), answers_(answers) {}

  void decide(std::span<const Query> queries) {
    for (const Query& query : queries) {
      once_.add(&query);
      if (once_.full()) find_once();
    }
    find_once(), find_in_parts(), find_times();
  }

 private:
  void find_once() {
    if (once_.count < kWorthLanes) return decide_one_by_one(once_);
    const LaneFindings found = find_once_in_lanes<Query>(once_.all());
    take(once_, found, [&](const Query* query) {
      several_.add(query);
      if (several_.full()) find_in_parts();
    });
  }
  void find_in_parts() {
    if (several_.count < kWorthLanes) return decide_one_by_one(several_);
    const LaneFindings found = find_in_parts_in_lanes<Query>(several_.all());
    take(several_, found, [&](const Query* query) { decide_by_itself(query); });
  }
  void find_times() {
    if (met_.count < kWorthLanes) return decide_one_by_one(met_);
    const CertainTime<Lane8> time = times_in_lanes<Query>(met_.all(), met_.low, met_.high);
    for (std::size_t l = 0; l < met_.count; ++l)
      if (time.known[l])
        answer(met_.query[l]) = {Verdict::contact, time.time[l]};
      else
        decide_by_itself(met_.query[l]);
    met_.count = 0;
  }
  template <class Undecided>
  void take(Waiting<Query>& asked, const LaneFindings& found, const Undecided& undecided) {
    for (std::size_t l = 0; l < asked.count; ++l) {
      const Query* const query = asked.query[l];
      if ((found.apart >> l & 1) != 0) {
        answer(query) = kApart;
      } else if ((found.contact >> l & 1) != 0) {
        met_.add(query, found.low[l], found.high[l]);
        if (met_.full()) find_times();
      } else {
        undecided(query);
      }
    }
    asked.count = 0;
  }
  void decide_one_by_one(Waiting<Query>& waiting) {
    for (const Query* query : waiting.all()) decide_by_itself(query);
    waiting.count = 0;
  }
  void decide_by_itself(const Query* query) { answer(query) = cscd::decide(*query).answer; }
  Answer& answer(const Query* query) { return answers_[static_cast<std::size_t>(query - first_)]; }

  const Query* const first_;
  const std::span<Answer> answers_;
  Waiting<Query> once_, several_, met_;
};

template <class Query>
bool rests(const Query& query) {
  bool rests = true;
  for_each_point(query, [&](const MovingPoint& p) { rests = rests && p.start == p.end; });
  return rests;
}

template <class Query>
Decision close_by_oracle(const Query& query, double r) {
  const auto time = exact::first_closeness(query, r);
  return {time ? Answer{Verdict::contact, time->lo} : kApart, ExactStage::oracle};
}
bool is_decided(const CloseResult& found) {
  return found.kind == CloseResult::apart || found.kind == CloseResult::close;
}
Decision close_of(const CloseResult& found, ExactStage stage) {
  return {found.kind == CloseResult::close ? Answer{Verdict::contact, found.time} : kApart, stage};
}

// Doubles leave open whether features are close at the start if their distance is r, or r up to rounding, as
// that of many pairs of a regular grid. Once integers have told, doubles decide most motions.
template <class Query>
Decision close_by_integers(const Query& query, double r, const CloseResult& found) {
  CloseResult later = found;
  if (found.time == 0) {
    const integer::Outcome start = integer::closeness_at_start(query, r, found.likely_case);
    if (start == integer::Outcome::gave_up) return close_by_oracle(query, r);
    if (start == integer::Outcome::contact) return {{Verdict::contact, 0}, ExactStage::integers};
    if (rests(query)) return {kApart, ExactStage::integers};
    if (found.kind == CloseResult::unclear_start) later = close_in_doubles(query, r, true);
    if (is_decided(later)) return close_of(later, ExactStage::integers);
  }
  const EndOfMotion end = end_of_motion(query, r);
  if (end.from_afar && integer::at_distance_at_end(query, r, end.likely_case))
    return {{Verdict::contact, 1}, ExactStage::integers};
  const integer::Result result = integer::first_closeness(query, r, possible_cases(query, r, later.time));
  if (result.outcome == integer::Outcome::gave_up) return close_by_oracle(query, r);
  const bool close = result.outcome == integer::Outcome::contact;
  return {close ? Answer{Verdict::contact, result.time} : kApart, ExactStage::integers};
}

template <class Query>
Decision decide_close(const Query& query, double r) {
  if (relative_boxes_apart(query, r)) return {kApart, ExactStage::filter};
  const CloseResult found = close_in_doubles(query, r);
  return is_decided(found) ? close_of(found, ExactStage::doubles) : close_by_integers(query, r, found);
}
template <class Query>
void decide_all_close(std::span<const Query> queries, std::span<const double> distances,
                      std::span<Answer> answers) {
  for (std::size_t i = 0; i < queries.size(); ++i) answers[i] = decide_close(queries[i], distances[i]).answer;
}

}  // namespace

Answer filtered_exact_vertex_face(const MovingVertexFace& query) {
  return decide(query).answer;
}
Answer filtered_exact_edge_edge(const MovingEdgeEdge& query) {
  return decide(query).answer;
}
void filtered_exact(std::span<const MovingVertexFace> queries, std::span<Answer> answers) {
  LaneStages(queries, answers).decide(queries);
}
void filtered_exact(std::span<const MovingEdgeEdge> queries, std::span<Answer> answers) {
  LaneStages(queries, answers).decide(queries);
}
void filtered_exact_close(std::span<const MovingVertexFace> queries, std::span<const double> distances,
                          std::span<Answer> answers) {
  decide_all_close(queries, distances, answers);
}
void filtered_exact_close(std::span<const MovingEdgeEdge> queries, std::span<const double> distances,
                          std::span<Answer> answers) {
  decide_all_close(queries, distances, answers);
}
ExactStage filtered_exact_close_stage(const MovingVertexFace& query, double r) {
  return decide_close(query, r).stage;
}
ExactStage filtered_exact_close_stage(const MovingEdgeEdge& query, double r) {
  return decide_close(query, r).stage;
}
ExactStage filtered_exact_stage(const MovingVertexFace& query) {
  return decide(query).stage;
}
ExactStage filtered_exact_stage(const MovingEdgeEdge& query) {
  return decide(query).stage;
}

}  // namespace cscd
