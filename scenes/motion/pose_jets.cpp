#include "scenes/motion/pose_jets.h"

#include <algorithm>
#include <map>

#include "core/base/sort_unique.h"

namespace cscd::scenes {
namespace {

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

JetVector fixed(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

// The first and the last key of a curve are corners too: there it stops, or goes on in a straight line.
Breaks breaks_of(const Channel& channel) {
  Breaks breaks;
  add_breaks(channel.moves, breaks);
  add_breaks(channel.rotations, breaks);
  add_breaks(channel.scales, breaks);
  const auto add = [&](const Curve& curve) { add_breaks(curve, breaks); };
  for_each_curve(channel.move_components, add);
  for_each_curve(channel.scale_components, add);
  for_each_curve(channel.angles.degrees, add);
  return breaks;
}

void append(std::vector<double>& to, const std::vector<double>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

// Splits a span at the breaks within it, and returns the hull of what `piece` makes of the parts.
template <class Piece>
auto hull_of_pieces(const std::vector<double>& breaks, const Span& span, const Piece& piece) {
  auto next = std::upper_bound(breaks.begin(), breaks.end(), span.from);
  double from = span.from;
  double to = next != breaks.end() && *next < span.to ? *next : span.to;
  auto whole = piece(Span{from, to});
  while (to < span.to) {
    from = to;
    ++next;
    to = next != breaks.end() && *next < span.to ? *next : span.to;
    whole = hull(whole, piece(Span{from, to}));
  }
  return whole;
}

}  // namespace

MovingTransform fixed(const Transform& map) {
  MovingTransform out;
  for (int k = 0; k < 3; ++k) out.linear.value.centre.col(k) = map.column[static_cast<std::size_t>(k)];
  out.origin.value.centre = map.origin;
  return out;
}

PoseJets::PoseJets(const Character& character, const Animation& animation)
    : character_(character), animation_(animation) {
  for (const Channel& channel : animation.channels) {
    Breaks breaks = breaks_of(channel);
    append(corners_, breaks.corners);
    append(jumps_, breaks.jumps);
    append(breaks.corners, breaks.jumps);
    sort_unique(breaks.corners);
    driven_.push_back(
        {&channel, parts_at_rest(character.nodes[at(channel.node)]), std::move(breaks.corners)});
  }
  Breaks breaks;
  for (const MorphChannel& morph : animation.morphs)
    for (const Layered<1>& weight : morph.weights)
      for_each_curve(weight, [&](const Curve& curve) { add_breaks(curve, breaks); });
  append(corners_, breaks.corners);
  append(jumps_, breaks.jumps);
  sort_unique(corners_);
  sort_unique(jumps_);
}

std::string PoseJets::refused() const {
  const Span clip{animation_.start, animation_.start + animation_.seconds};
  for (const Channel& channel : animation_.channels)
    for (const Layered<3>* numbers :
         {&channel.move_components, &channel.scale_components, &channel.angles.degrees})
      if (const char* why = without_bounds(*numbers, clip))
        return std::string(why) + " (node '" + character_.nodes[at(channel.node)].name + "')";
  for (const MorphChannel& morph : animation_.morphs)
    for (const Layered<1>& weight : morph.weights)
      if (const char* why = without_bounds(weight, clip))
        return std::string(why) + " (mesh '" + character_.parts[at(morph.part)].name + "')";
  return {};
}

PoseJets::ScaleAndMove PoseJets::beside_rotation(const Driven& driven, const Span& span) {
  const Channel& channel = *driven.channel;
  ScaleAndMove out{fixed(driven.rest.scale), fixed(driven.rest.move)};
  if (!channel.moves.empty()) out.move = jets_of(channel.moves, span);
  if (!channel.move_components.empty()) out.move = jets_of(channel.move_components, span);
  if (!channel.scales.empty()) out.scale = jets_of(channel.scales, span);
  if (!channel.scale_components.empty()) out.scale = jets_of(channel.scale_components, span);
  return out;
}

MovingMatrix PoseJets::rotation_of(const Driven& driven, const Span& span) {
  const Channel& channel = *driven.channel;
  if (channel.angles.degrees.empty() && !channel.rotations.empty())
    if (const std::optional<MovingMatrix> turning = turning_of(channel.rotations, span)) return *turning;
  return ball_around(hull_of_pieces(driven.breaks, span, [&](const Span& piece) {
    if (!channel.angles.degrees.empty()) return jets_of(channel.angles, piece);
    if (!channel.rotations.empty()) return jets_of(channel.rotations, piece);
    const Quaternion& q = driven.rest.rotation;
    return columns_of({Jet(q.w), Jet(q.x), Jet(q.y), Jet(q.z)});
  }));
}

std::vector<MovingTransform> PoseJets::locals(const Span& span) const {
  std::vector<MovingTransform> out;
  for (const Node& node : character_.nodes) out.push_back(fixed(node.local));
  std::map<int, JetVector> scales;
  for (const Driven& driven : driven_) {
    const auto node = driven.channel->node;
    const ScaleAndMove beside = hull_of_pieces(
        driven.breaks, span, [&](const Span& piece) { return beside_rotation(driven, piece); });
    MovingTransform& local = out[at(node)] = {rotation_of(driven, span), ball_around(beside.move)};
    scales[node] = beside.scale;
    if (std::ranges::all_of(beside.scale, [](const Jet& x) { return x.is_still() && x.value.is_one(); }))
      continue;
    JetRotation columns{};
    for (std::size_t k = 0; k < 3; ++k) columns[k][k] = beside.scale[k];
    local.linear = local.linear * ball_around(columns);
  }
  for (std::size_t n = 0; n < out.size(); ++n) {
    const std::optional<FollowedScale>& follows = character_.nodes[n].follows;
    const auto found = follows ? scales.find(follows->node) : scales.end();
    if (found == scales.end()) continue;
    JetRotation columns{};
    for (std::size_t k = 0; k < 3; ++k)
      columns[k][k] = follows->inverse ? reciprocal(found->second[k]) : found->second[k];
    out[n] = {ball_around(columns), {}};
  }
  return out;
}

namespace {

// What moves at a rate stays within half a span times the rate of where it is in the middle. So does the rate
// by what it bends, where there is no corner. Without this, the uncertainties of bones that turn against each
// other add up.
template <class Centre>
void tighten(Ball<Centre>& x, const Ball<Centre>& middle, const Ball<Centre>& slope, double half) {
  const double radius = grown(middle.radius + (norm_above(slope.centre) + slope.radius) * half);
  if (radius < x.radius) x = {middle.centre, radius};
}
template <class Centre>
void tighten(MovingBall<Centre>& x, const MovingBall<Centre>& middle, double half, bool has_corners) {
  if (!has_corners) tighten(x.rate, middle.rate, x.bend, half);
  tighten(x.value, middle.value, x.rate, half);
}

}  // namespace

PoseJets::Nodes PoseJets::nodes(const Span& span) const {
  const auto compose = [&](std::vector<MovingTransform>& pose, std::size_t n) {
    if (const int parent = character_.nodes[n].parent; parent >= 0)
      pose[n] = composed(pose[at(parent)], pose[n]);
  };
  Nodes out{locals(span), {}, 0};
  if (span.from == span.to) {
    for (std::size_t n = 0; n < out.over.size(); ++n) compose(out.over, n);
    out.middle = out.over;
    return out;
  }
  const double middle = span.from + (span.to - span.from) / 2;
  const auto corner = std::upper_bound(corners_.begin(), corners_.end(), span.from);
  const bool has_corners = corner != corners_.end() && *corner < span.to;
  out.middle = locals({middle, middle});
  out.half = rounded_up(std::max(middle - span.from, span.to - middle));
  const auto tighten_both = [&](std::size_t n) {
    tighten(out.over[n].linear, out.middle[n].linear, out.half, has_corners);
    tighten(out.over[n].origin, out.middle[n].origin, out.half, has_corners);
  };
  for (std::size_t n = 0; n < out.over.size(); ++n) {
    tighten_both(n);
    compose(out.middle, n);
    compose(out.over, n);
    tighten_both(n);
  }
  return out;
}

namespace {

// The weight of a target that an animation drives (weight_of), and whether a knot is within its range.
Jet response_of(const MorphTarget& target, const Jet& driven, bool& knot_within) {
  const auto& knots = target.response;
  if (knots.empty()) return driven;
  std::optional<Jet> whole;
  for (std::size_t k = 1; k < knots.size(); ++k) {
    const bool first = k == 1, last = k + 1 == knots.size();
    if ((!first && driven.value.high < knots[k - 1].driven) || (!last && driven.value.low > knots[k].driven))
      continue;
    const Interval slope = (Interval(knots[k].weight) - Interval(knots[k - 1].weight)) /
                           (Interval(knots[k].driven) - Interval(knots[k - 1].driven));
    Jet part = driven;
    part.value = Interval(first ? driven.value.low : std::max(driven.value.low, knots[k - 1].driven),
                          last ? driven.value.high : std::min(driven.value.high, knots[k].driven));
    const Jet line = Jet(knots[k - 1].weight) + Jet(slope) * (part - Jet(knots[k - 1].driven));
    knot_within = knot_within || whole.has_value();
    whole = whole ? hull(*whole, line) : line;
  }
  return *whole;
}

}  // namespace

PoseJets::Weights PoseJets::weights(const Span& span) const {
  Weights out;
  for (const Part& part : character_.parts) {
    std::vector<Jet>& own = out.of_part.emplace_back();
    for (const MorphTarget& target : part.targets) own.push_back(target.weight);
  }
  for (const MorphChannel& morph : animation_.morphs)
    for (std::size_t t = 0; t < morph.weights.size(); ++t) {
      if (morph.weights[t].empty()) continue;
      Breaks breaks;
      for_each_curve(morph.weights[t], [&](const Curve& curve) { add_breaks(curve, breaks); });
      append(breaks.corners, breaks.jumps);
      sort_unique(breaks.corners);
      const Jet driven = hull_of_pieces(breaks.corners, span,
                                        [&](const Span& piece) { return jets_of(morph.weights[t], piece); });
      out.of_part[at(morph.part)][t] =
          response_of(character_.parts[at(morph.part)].targets[t], driven, out.corners_anywhere);
    }
  return out;
}

}  // namespace cscd::scenes
