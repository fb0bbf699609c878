#include "scenes/motion/character_motion.h"

#include "core/base/error.h"

namespace cscd::scenes {
namespace {

// Of the size of a time, what some roundings of it come to; and seconds, more than that by far.
constexpr double kRounded = 8 * 0x1p-52, kApart = 1e-9;

const Animation& clip_of(const Character& character) {
  if (character.animations.size() != 1) throw InputError("motion: is not about one clip");
  return character.animations.front();
}

}  // namespace

CharacterMotion::CharacterMotion(MovingCharacter moving)
    : moving_(std::move(moving)), pose_(moving_.character, clip_of(moving_.character)) {
  if (const std::string refused = pose_.refused(); !refused.empty())
    throw NoBounds("no bounds are known for " + refused + "; ask about straight lines, without it");
  for (const Part& part : moving_.character.parts) points_.push_back(points_in_joints(part));
  const std::vector<double>& jumps = pose_.jumps();
  for (const double corner : pose_.corners()) {
    const auto jump = std::lower_bound(jumps.begin(), jumps.end(), corner - kApart);
    if (jump == jumps.end() || *jump > corner + kApart) corners_.push_back(corner);
  }
  std::vector<Place> all;
  for (std::size_t p = 0; p < moving_.character.parts.size(); ++p)
    for (std::size_t v = 0; v < moving_.character.parts[p].positions.size(); ++v)
      all.push_back({static_cast<std::int32_t>(p), static_cast<std::int32_t>(v)});
  for (const std::int32_t raw : moving_.raw_vertex) place_.push_back(all.at(static_cast<std::size_t>(raw)));
}

// Keys have times on the file's time line. The sum rounds as the import's does; what rounding moves off a
// corner is put back there, because a corner just inside a span costs it its bounds on rates.
double CharacterMotion::on_time_line(double seconds) const {
  const double start = moving_.character.animations.front().start, time = start + seconds;
  return corner_near(time, kRounded * (std::abs(start) + std::abs(time))).value_or(time);
}

std::optional<double> CharacterMotion::corner_near(double time, double reach) const {
  const auto next = std::lower_bound(corners_.begin(), corners_.end(), time);
  std::optional<double> best;
  for (auto c = next == corners_.begin() ? next : next - 1; c != corners_.end() && c <= next; ++c)
    if (std::abs(*c - time) <= reach && (!best || std::abs(*c - time) < std::abs(*best - time))) best = *c;
  return best;
}

double CharacterMotion::at_corner(double seconds, double reach) const {
  const double start = moving_.character.animations.front().start;
  const std::optional<double> corner = corner_near(start + seconds, reach);
  return corner ? *corner - start : seconds;
}

template <class Take>
void CharacterMotion::for_each_vertex(const Span& span, const PoseJets::Weights& weights,
                                      std::span<const VertexId> vertices, Wanted wanted,
                                      const Take& take) const {
  const PoseJets::Nodes nodes = pose_.nodes(span);
  const std::vector<Part>& parts = moving_.character.parts;
  std::vector<std::optional<SkinJets>> skins(parts.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Place& place = place_[+vertices[i]];
    const auto part = static_cast<std::size_t>(place.part);
    if (!skins[part]) skins[part].emplace(parts[part], points_[part], nodes, weights.of_part[part], wanted);
    take(i, *skins[part], static_cast<std::size_t>(place.vertex));
  }
}

void CharacterMotion::positions(double seconds, std::span<const VertexId> vertices, std::span<Vec3> at,
                                std::span<double> error) const {
  const Span moment = on_time_line(seconds, seconds);
  for_each_vertex(moment, pose_.weights(moment), vertices, Wanted::places,
                  [&](std::size_t i, const SkinJets& skin, std::size_t v) {
                    const BallVector place = skin.vertex(v).value;
                    at[i] = place.centre;
                    error[i] = place.radius;
                  });
}

void CharacterMotion::deviations(double from, double to, std::span<const VertexId> vertices,
                                 std::span<double> out) const {
  const Span span = on_time_line(from, to);
  std::ranges::fill(out, std::numeric_limits<double>::infinity());
  if (next_jump(from, to)) return;
  const double h = rounded_up(span.to - span.from);
  // A corner at time c moves the path off the line by (c - from) (to - c) / h times the change of its rate.
  double corners = 0;
  for (auto c = std::upper_bound(pose_.corners().begin(), pose_.corners().end(), span.from);
       c != pose_.corners().end() && *c < span.to; ++c)
    corners += rounded_up((*c - span.from) * (span.to - *c) / h);
  try {
    const PoseJets::Weights weights = pose_.weights(span);
    const bool known_corners = !weights.corners_anywhere;
    for_each_vertex(
        span, weights, vertices, Wanted::paths, [&](std::size_t i, const SkinJets& skin, std::size_t v) {
          try {
            const MovingVector x = skin.vertex(v);
            const double change = 2 * x.rate.radius, bend = norm_above(x.bend.centre) + x.bend.radius;
            double bound = change * h / 4;
            if (known_corners) bound = std::min(bound, bend * h * h / 8 + change * corners);
            if (bound < std::numeric_limits<double>::infinity()) out[i] = grown(bound);
          } catch (const Unbounded&) {
            // stays without a bound
          }
        });
  } catch (const Unbounded&) {
    std::ranges::fill(out, std::numeric_limits<double>::infinity());
  }
}

double CharacterMotion::split(double from, double to) const {
  const Span span = on_time_line(from, to);
  const double h = span.to - span.from;
  double best = from + (to - from) / 2, most = 0;
  for (auto c = std::upper_bound(pose_.corners().begin(), pose_.corners().end(), span.from);
       c != pose_.corners().end() && *c < span.to; ++c) {
    const double off = (*c - span.from) * (span.to - *c) / h;
    const double seconds = *c - moving_.character.animations.front().start;
    if (off <= most || seconds <= from || seconds >= to) continue;
    most = off;
    best = seconds;
  }
  return best;
}

std::optional<VertexPaths::Jump> CharacterMotion::next_jump(double from, double to) const {
  const Span span = on_time_line(from, to);
  const auto jump = std::upper_bound(pose_.jumps().begin(), pose_.jumps().end(), span.from);
  if (jump == pose_.jumps().end() || *jump > span.to) return std::nullopt;
  // The neighbouring times on either side, as seconds after the start of the clip.
  const double start = moving_.character.animations.front().start;
  const double seconds = *jump - start, step = 0x1p-52 * (std::abs(start) + std::abs(*jump) + 1e-9);
  Jump out{seconds, seconds};
  while (!(start + out.before < *jump)) out.before -= step;
  while (!(start + out.after >= *jump)) out.after += step;
  return out;
}

}  // namespace cscd::scenes
