#include "core/session/true_motion.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/base/error.h"
#include "core/base/rounding.h"
#include "core/detect/contact_geometry.h"
#include "core/detect/start/crossings.h"
#include "core/fast/drvbc_fast.h"
#include "core/hierarchy/loose_vertices.h"

namespace cscd {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Grows a length by more than a few roundings shorten it.
constexpr double kGrown = 1 + 32 * kUnitRoundoff;

// A part of an interval is searched at kRoom times the distance that it needs. If its end is clear at that
// larger distance, the next part begins with a clear start, which is quicker to ask about. If it is not,
// kWaits parts pass before the larger distance is tried again. kWaitsForSigns parts pass where signs left
// more pairs of triangles than boxes do.
constexpr double kRoom = 1.25;
constexpr int kWaits = 4, kWaitsForSigns = 256;
// A bound for all vertices at once that is too large by less than this is looked at vertex by vertex.
constexpr double kLooser = 4;
// What is nearer than this share of the resolution mostly lies on each other for long, and shorter pieces say
// no more of it. A few are tried all the same: what flies straight through a face is as near for a moment.
constexpr double kFinest = 1e-9;
constexpr std::size_t kPiecesLyingOn = 12;
// A contact at the very end of a piece is looked for from this share of the piece before that end to the same
// share behind it, which no halving divides. What lies on something for long has many such ends, so a span
// looks round few of them.
constexpr double kAround = 0.618;
constexpr std::size_t kMostEnds = 64;
// No square of a length below this overflows.
constexpr double kMostLength = 1e150;

// Whether an edge and a triangle meet, known for all places within some distance of those that are given.
enum class Meets { no, unknown, yes };

int sign(double value, double tolerance) {
  return value > tolerance ? 1 : value < -tolerance ? -1 : 0;
}

// The edge p, q and the triangle a, b, c, whose places are known up to `error`. The determinants of three
// differences are off by at most 6 error L^2 for differences of at most L after they are moved, and by fewer
// than 32 roundings of L^3.
Meets edge_meets_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c,
                          double error) {
  double longest = 0;
  for (const Vec3& x : {q, a, b, c}) longest = std::max(longest, (x - p).norm());
  longest = 2 * (longest + 2 * error) * kGrown;  // of any two of the points
  const double tolerance =
      (6 * error * longest * longest + 32 * kUnitRoundoff * longest * longest * longest) * kGrown;
  const auto side = [tolerance](const Vec3& o, const Vec3& u, const Vec3& v, const Vec3& w) {
    return sign((u - o).dot((v - o).cross(w - o)), tolerance);
  };
  const int above_p = side(p, a, b, c), above_q = side(q, a, b, c);
  if (above_p != 0 && above_p == above_q) return Meets::no;
  // The sides on which the line through p and q passes the sides of the triangle.
  const int ab = side(p, q, a, b), bc = side(p, q, b, c), ca = side(p, q, c, a);
  if (ab * bc < 0 || bc * ca < 0 || ca * ab < 0) return Meets::no;
  return above_p * above_q < 0 && ab * bc > 0 && bc * ca > 0 ? Meets::yes : Meets::unknown;
}

bool all_finite(std::span<const double> errors) {
  return std::ranges::all_of(errors, [](double error) { return error < kInfinity; });
}

TrianglePair triangles_of(const CrossingPair& pair) {
  return {pair.first, pair.second};
}

}  // namespace

// The vertices that are looked at in pieces: those of all triangles that have one of the features.
struct TrueMotion::Piece {
  std::vector<VertexId> vertices;  // sorted
  std::vector<double> deviation;   // [vertices] over the piece at hand
};

TrueMotion::TrueMotion(const VertexPaths& paths, const StrategyInput& setup, const Strategy& strategy,
                       const TrueMotionOptions& options)
    : paths_(paths), setup_(setup), options_(options) {
  if (strategy.guarantee != Guarantee::complete || !strategy.sees_start || !strategy.knows_distance ||
      !setup.elementary.knows_distance() || !setup.elementary.apart_is_proof)
    throw InputError(
        "true motion: needs a complete strategy and an elementary test that know distances, such as "
        "drvbc_fast_complete with filtered_exact");
  const std::size_t vertices = setup.mesh.vertex_count();
  if (paths.vertex_count() != vertices)
    throw InputError("true motion: the paths are those of " + std::to_string(paths.vertex_count()) +
                     " vertices, and the mesh has " + std::to_string(vertices));
  if (const LooseCount loose = count_loose_vertices(setup.mesh); loose.count > 0)
    throw InputError("true motion: knows surfaces alone, and " + std::to_string(loose.count) +
                     (loose.count == 1 ? " vertex is" : " vertices are") + " of no face, the first of them " +
                     std::to_string(+loose.first) + "; leave them out");
  detector_ = strategy.make(setup_).detector;
  for (std::size_t v = 0; v < vertices; ++v) everything_.push_back(VertexId{static_cast<std::int32_t>(v)});
  if (strategy.drops_by_signs && setup.mesh.closed_and_oriented() && setup.exclusions == nullptr)
    by_signs_ = kDrvbcFast.make(setup_).detector;
  a_.resize(vertices), b_.resize(vertices), wide_.resize(vertices);
}

void TrueMotion::place_all(double time, Places& out) const {
  out.time = time;
  out.at.resize(everything_.size()), out.error.resize(everything_.size());
  paths_.positions(time, everything_, out.at, out.error);
  require_finite(out.at, "positions of the true motion");
}

std::span<const Vec3> TrueMotion::positions_at(double time) {
  if (last_.time != time) place_all(time, last_);
  return last_.at;
}

bool TrueMotion::is_out(const TrianglePair& pair) const {
  return (options_.ignored != nullptr && options_.ignored->excludes(setup_.mesh, pair)) ||
         (setup_.exclusions != nullptr && setup_.exclusions->excludes(setup_.mesh, pair)) ||
         (options_.left_out != nullptr && options_.left_out->explains(CrossingPair{pair.a, pair.b}));
}

bool TrueMotion::is_out(const FeaturePair& pair) const {
  return (options_.ignored != nullptr && options_.ignored->excludes(setup_.mesh, pair)) ||
         (options_.left_out != nullptr && options_.left_out->explains(pair));
}

std::optional<TrueMotion::Meeting> TrueMotion::meeting_at(double time) {
  Places here;
  place_all(time, here);
  Crossings crossings;
  detector_->detect({.motion = Motion(here.at, here.at),
                     .crossings = &crossings,
                     .most_crossings = std::numeric_limits<std::size_t>::max()},
                    found_);
  std::erase_if(crossings.pairs, [&](const CrossingPair& pair) { return is_out(triangles_of(pair)); });
  const Meetings met = tell_meetings_apart(setup_.mesh, here.at, crossings);
  if (met.crossing.total > 0) return Meeting{met.crossing.pairs.front(), true};
  if (met.touching.total > 0) return Meeting{met.touching.pairs.front(), false};
  return std::nullopt;
}

TrueAnswer TrueMotion::answer(double from, double to) {
  answer_ = {.from = from, .to = to};
  narrow_ = options_.narrow * (to - from);
  more_left_ = options_.most_more_pieces;
  ends_left_ = kMostEnds;
  Places start, end;
  if (last_.time == from)
    start = std::move(last_);
  else
    place_all(from, start);
  double begin = from;
  for (bool more = true; more;) {
    const std::optional<VertexPaths::Jump> jump = paths_.next_jump(begin, to);
    const double stop = jump ? jump->before : to;
    stretch_from_ = begin, stretch_to_ = stop;
    if (stop > begin) {
      place_all(stop, end);
      const double widest = largest_width(start, end);
      answer_.deviation = std::max(answer_.deviation, widest);
      more = look_at(start, end, widest);
    }
    if (!jump) break;
    ++answer_.jumps;
    begin = std::min(jump->after, to);
    Places& after = begin < to ? start : end;
    place_all(begin, after);
    if (more && !all_finite(after.error)) {
      more = give_up(begin, begin);
    } else if (const auto met = more ? meeting_at(begin) : std::nullopt) {
      answer_.verdict = met->crosses ? IntervalVerdict::intersects_at_start : IntervalVerdict::touches;
      answer_.from = answer_.to = begin;
      answer_.pair = met->pair;
      more = false;
    }
    more = more && begin < to;
  }
  last_ = std::move(end);
  if (last_.time != to) last_.time = std::numeric_limits<double>::quiet_NaN();
  return answer_;
}

bool TrueMotion::give_up(double from, double to) {
  answer_.verdict = IntervalVerdict::undecided;
  answer_.from = from, answer_.to = to;
  answer_.pair.reset();
  return false;
}

void TrueMotion::say_close(double from, double to, double within, const std::vector<FeaturePair>& pairs) {
  answer_.within = std::max(answer_.within, within);
  if (answer_.verdict == IntervalVerdict::close) return;
  answer_.verdict = IntervalVerdict::close;
  answer_.from = from, answer_.to = to;
  answer_.pair = carriers(setup_.mesh, pairs.front()).front();
}

bool TrueMotion::look_on(double within) {
  const bool lies_on = within <= kFinest * options_.resolution;
  if (!looks_on_)
    more_ = std::min({lies_on ? kPiecesLyingOn : options_.more_pieces, options_.more_pieces, more_left_});
  if (more_ == 0) return false;
  --more_, --more_left_;
  return true;
}

double TrueMotion::largest_width(const Places& from, const Places& to) const {
  double error = 0;
  for (const Places* places : {&from, &to})
    for (const double e : places->error) error = std::max(error, e);
  const double widest = (paths_.largest_deviation(from.time, to.time) + error) * kGrown;
  if (widest <= options_.coarse || widest >= kLooser * options_.coarse) return widest;
  const std::vector<double> wide = widths(from, to);
  return *std::ranges::max_element(wide);
}

bool TrueMotion::look_at(const Places& from, const Places& to, double widest) {
  if (++answer_.parts > options_.most_parts) return give_up(from.time, to.time);
  if (!(widest <= options_.coarse)) {
    const double middle = paths_.split(from.time, to.time);
    if (!(from.time < middle && middle < to.time)) return give_up(from.time, to.time);
    Places between;
    place_all(middle, between);
    return look_at(from, between, largest_width(from, between)) &&
           look_at(between, to, largest_width(between, to));
  }
  find_close(from, to, widest);
  std::vector<FeaturePair> pairs;
  for (const Contact& contact : found_.contacts)
    if (!is_out(contact.pair)) pairs.push_back(contact.pair);
  return pairs.empty() || look_closer(from, to, pairs);
}

std::vector<double> TrueMotion::widths(const Places& from, const Places& to) const {
  std::vector<double> wide(everything_.size());
  paths_.deviations(from.time, to.time, everything_, wide);
  for (std::size_t v = 0; v < wide.size(); ++v) {
    wide[v] = (wide[v] + std::max(from.error[v], to.error[v])) * kGrown;
    if (!(wide[v] <= kInfinity)) wide[v] = kInfinity;
  }
  return wide;
}

// Finds all pairs that come close on the lines: within the widths of their vertices, or within one distance
// for all that is more. A part that ends with nothing so close starts the next one clear, and a clear start
// of a closed surface is answered in a fraction of the time. Where something stays close, that is tried again
// after some parts.
void TrueMotion::find_close(const Places& from, const Places& to, double widest) {
  const double distance = 2 * widest * kGrown;
  // What crosses need not be close. So a part is no clear start where something may cross: where pairs that
  // cross are left out, or where two features have come together in this span and cannot be told apart.
  const bool may_cross = answer_.verdict != IntervalVerdict::clear || options_.ignored != nullptr ||
                         (options_.left_out != nullptr && !options_.left_out->empty());
  const bool starts_clear = !may_cross && clear_time_ == from.time && distance <= clear_at_;
  const bool by_one = starts_clear || (setup_.exclusions == nullptr && waits_ == 0);
  const double asked = starts_clear ? std::min(clear_at_, kRoom * distance) : kRoom * distance;
  // After a clear start the first contact alone is enough to know that there is none, and soon known.
  if (starts_clear && by_signs_) {
    const Report report = by_signs_->detect({.motion = Motion(from.at, to.at),
                                             .starts_embedded = true,
                                             .thickness = Thickness(asked),
                                             .any_contact = true},
                                            found_);
    if (found_.contacts.empty()) {
      // Where spikes are thin, signs leave more pairs of triangles than boxes do.
      const bool pays = report.cull.pctp <= pairs_without_start_;
      clear_time_ = to.time;
      clear_at_ = pays ? asked : 0;
      if (!pays) waits_ = kWaitsForSigns;
      return;
    }
  }
  const std::vector<double> wide = by_one ? std::vector<double>() : widths(from, to);
  const Report report = detector_->detect({.motion = Motion(from.at, to.at),
                                           .starts_embedded = starts_clear,
                                           .thickness = by_one ? Thickness(asked) : Thickness(0, wide)},
                                          found_);
  if (!starts_clear) pairs_without_start_ = report.cull.pctp;
  clear_time_ = to.time;
  clear_at_ = 0;
  if (!by_one) {
    --waits_;
    return;
  }
  const Motion end(to.at, to.at);
  const bool ends_clear = std::ranges::all_of(found_.contacts, [&](const Contact& contact) {
    return ask_close(setup_.elementary, setup_.mesh, end, contact.pair, asked).verdict == Verdict::apart;
  });
  if (ends_clear)
    clear_at_ = asked;
  else
    waits_ = kWaits;
}

bool TrueMotion::look_closer(const Places& from, const Places& to, const std::vector<FeaturePair>& pairs) {
  Piece piece;
  std::vector<bool> is_wanted(everything_.size());
  for (const FeaturePair& pair : pairs)
    for (const CrossingPair& both : carriers(setup_.mesh, pair))
      for (const TriangleId triangle : {both.first, both.second})
        for (const VertexId v : setup_.mesh.corners(triangle)) is_wanted[+v] = true;
  std::ranges::copy_if(everything_, std::back_inserter(piece.vertices),
                       [&](VertexId v) { return is_wanted[+v]; });
  piece.deviation.resize(piece.vertices.size());
  const auto of_piece = [&](const Places& all) {
    Places some{all.time, {}, {}};
    for (const VertexId v : piece.vertices)
      some.at.push_back(all.at[+v]), some.error.push_back(all.error[+v]);
    return some;
  };
  return look_at(piece, of_piece(from), of_piece(to), pairs);
}

bool TrueMotion::look_at(Piece& piece, const Places& from, const Places& to,
                         const std::vector<FeaturePair>& pairs) {
  paths_.deviations(from.time, to.time, piece.vertices, piece.deviation);
  for (std::size_t i = 0; i < piece.vertices.size(); ++i) {
    const std::size_t v = +piece.vertices[i];
    a_[v] = from.at[i], b_[v] = to.at[i];
    wide_[v] = (piece.deviation[i] + std::max(from.error[i], to.error[i])) * kGrown;
  }
  const Motion motion(a_, b_);
  double within = 0;
  std::vector<FeaturePair> near;
  for (const FeaturePair& pair : pairs) {
    // Not by Thickness, whose largest length would be that of all vertices.
    const auto points = vertices_of(setup_.mesh, pair);
    const std::size_t first = pair.kind == FeaturePair::Kind::vertex_face ? 1 : 2;
    double one = 0, other = 0;
    for (std::size_t k = 0; k < 4; ++k)
      (k < first ? one : other) = std::max(k < first ? one : other, wide_[+points[k]]);
    const double distance = (one + other) * kGrown;
    if (distance < kMostLength &&
        ask_close(setup_.elementary, setup_.mesh, motion, pair, distance).verdict == Verdict::apart)
      continue;
    near.push_back(pair);
    // Points that are `distance` apart on the lines are at most twice as far apart on the true paths.
    within = std::max(within, 2 * distance * kGrown);
  }
  if (near.empty()) return true;

  const bool resolved = within <= options_.resolution, narrow = to.time - from.time <= narrow_;
  bool proven = (resolved || narrow) && proves_contact(piece, from, to, near);
  const TrueAnswer contact = answer_;
  if (proven && narrow) return false;
  if (resolved && !proven) {
    const double reach = kAround * (to.time - from.time);
    const bool ends_unknown = unknown_to_;
    if ((unknown_from_ && proves_contact_around(piece, from.time, reach, near)) ||
        (ends_unknown && proves_contact_around(piece, to.time, reach, near)))
      return false;
  }
  if (resolved && !proven && !look_on(within)) {
    say_close(from.time, to.time, within, near);
    return true;
  }
  const double middle = paths_.split(from.time, to.time);
  if (++answer_.pieces > options_.most_pieces || !(from.time < middle && middle < to.time)) {
    if (proven) return false;
    if (!(within < kInfinity)) return give_up(from.time, to.time);
    say_close(from.time, to.time, within, near);
    return true;
  }
  const Places between = places_of(piece, middle);
  const bool looked_on = std::exchange(looks_on_, resolved);
  const bool more = look_at(piece, from, between, near) && look_at(piece, between, to, near);
  looks_on_ = looked_on;
  if (!more) return false;
  if (!proven) return true;
  // Neither half shows what the whole does, because the middle cannot be told: the whole is the proof.
  const std::size_t pieces = answer_.pieces;
  answer_ = contact;
  answer_.pieces = pieces;
  return false;
}

TrueMotion::Places TrueMotion::places_of(const Piece& piece, double time) const {
  Places out{time, std::vector<Vec3>(piece.vertices.size()), std::vector<double>(piece.vertices.size())};
  paths_.positions(time, piece.vertices, out.at, out.error);
  require_finite(out.at, "positions of the true motion");
  return out;
}

// Looks for a contact round the end of a piece, at which it cannot be told whether an edge meets a triangle,
// and narrows it down. Paths that are bounded there are continuous, and no more is asked of them.
bool TrueMotion::proves_contact_around(Piece& piece, double end, double reach,
                                       const std::vector<FeaturePair>& pairs) {
  if (ends_left_ == 0) return false;
  --ends_left_;
  for (bool proven = false;; proven = true, reach /= 2) {
    const double from = std::max(end - reach, stretch_from_), to = std::min(end + reach, stretch_to_);
    paths_.deviations(from, to, piece.vertices, piece.deviation);
    if (!all_finite(piece.deviation)) return proven;
    if (!proves_contact(piece, places_of(piece, from), places_of(piece, to), pairs)) return proven;
    if (to - from <= narrow_) return true;
  }
}

// Looks for an edge that meets a triangle at one end and is apart from it at the other, whatever the true
// places are. Says so in the answer.
bool TrueMotion::proves_contact(const Piece& piece, const Places& from, const Places& to,
                                const std::vector<FeaturePair>& pairs) {
  double error = 0;
  for (const Places* places : {&from, &to})
    for (const double e : places->error) error = std::max(error, e);
  const auto at = [&](const Places& places, VertexId v) -> const Vec3& {
    const auto found = std::ranges::lower_bound(piece.vertices, v);
    return places.at[static_cast<std::size_t>(found - piece.vertices.begin())];
  };
  const auto meets = [&](const Places& places, const Edge& edge, const Triangle& face) {
    return edge_meets_triangle(at(places, edge[0]), at(places, edge[1]), at(places, face[0]),
                               at(places, face[1]), at(places, face[2]), error);
  };
  unknown_from_ = unknown_to_ = false;
  for (const FeaturePair& pair : pairs)
    for (const CrossingPair& both : carriers(setup_.mesh, pair)) {
      if (is_out(triangles_of(both))) continue;
      for (const auto& [one, other] :
           {std::pair(both.first, both.second), std::pair(both.second, both.first)})
        for (const EdgeId e : setup_.mesh.edges_of(one)) {
          const Edge& edge = setup_.mesh.ends(e);
          const Triangle& face = setup_.mesh.corners(other);
          if (std::ranges::find_first_of(edge, face) != edge.end()) continue;
          const Meets before = meets(from, edge, face), after = meets(to, edge, face);
          unknown_from_ = unknown_from_ || before == Meets::unknown;
          unknown_to_ = unknown_to_ || after == Meets::unknown;
          if (before == Meets::unknown || after == Meets::unknown || before == after) continue;
          answer_.verdict = IntervalVerdict::touches;
          answer_.from = from.time, answer_.to = to.time;
          answer_.pair = both;
          answer_.parts_again = before == Meets::yes;
          answer_.within = 0;
          return true;
        }
    }
  return false;
}

}  // namespace cscd
