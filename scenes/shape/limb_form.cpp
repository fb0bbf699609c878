#include "scenes/shape/limb_form.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "scenes/shape/key_curve.h"

namespace cscd::scenes {

namespace {

constexpr int kTable = 512;  // cells of the table of sections

// base^exponent for an even exponent. The results of std::pow differ between libraries, and frames must not.
double even_power(double base, int exponent) {
  double result = 1;
  for (int i = 0; i < exponent; i += 2) result *= base * base;
  return result;
}

constexpr int kPerBone = 32;   // samples of the centre line for each bone
constexpr int kStops = 400;    // stops along the silhouette up to the tip
constexpr int kTipStops = 40;  // stops along the rounded tip

Vec3 reflected(const Vec3& v, const Vec3& across) {
  const double squared = across.squaredNorm();
  return squared > 0 ? Vec3(v - 2 * across.dot(v) / squared * across) : v;
}

Vec3 part_across(const Vec3& v, const Vec3& along) {
  return v - v.dot(along) * along;
}

// The curves of the sections, piece by piece.
std::vector<KeyCurve> pieces_of(const Parameters::Table& sections, const std::string& who) {
  std::vector<KeyCurve> pieces;
  for (std::size_t first = 0, i = 0; i < sections.size(); ++i) {
    if (!(sections[i][0] >= 0 && sections[i][0] <= 1 && sections[i][1] > 0 && sections[i][2] > 0))
      throw InputError(who + ": sections must lie at shares from 0 to 1 and have positive radii");
    if (i + 1 < sections.size() && sections[i + 1][0] > sections[i][0]) continue;
    pieces.emplace_back(Parameters::Table(sections.begin() + static_cast<std::ptrdiff_t>(first),
                                          sections.begin() + static_cast<std::ptrdiff_t>(i + 1)),
                        who);
    first = i + 1;
  }
  if (pieces.empty()) throw InputError(who + ": needs at least one section");
  return pieces;
}

}  // namespace

BodyForm::BodyForm(const Spec& spec, const std::string& who) : spec_(spec) {
  const Parameters::Table& rows = spec.sections;
  bool usable = rows.size() >= 2;
  for (std::size_t i = 0; i < rows.size(); ++i)
    usable = usable && rows[i][1] > 0 && rows[i][2] > 0 && (i == 0 || rows[i][0] > rows[i - 1][0]);
  if (!usable)
    throw InputError(who +
                     ": the body needs at least two sections, in order along its axis, of positive size");
  for (const int power : {spec.section_power, spec.end_power})
    if (power < 2 || power > 64 || power % 2 != 0)
      throw InputError(who + ": the body's powers must be even, from 2 to 64");

  const KeyCurve curve(rows, who);
  low_ = rows.front()[0];
  high_ = rows.back()[0];
  Section largest{0, 0, 0, 0};
  for (int i = 0; i <= kTable; ++i) {
    const double along = low_ + (high_ - low_) * i / kTable;
    table_.push_back({curve.at(along, 1), curve.at(along, 2), curve.at(along, 3), curve.at(along, 4)});
    largest.half_u = std::max(largest.half_u, table_.back().half_u);
    largest.half_v = std::max(largest.half_v, table_.back().half_v);
  }
  const double middle = (low_ + high_) / 2;
  const Section section = at(middle);
  const int u = spec.axis == 0 ? 1 : 0, v = spec.axis == 2 ? 1 : 2;
  centre_[spec.axis] = middle;
  centre_[u] = section.shift_u;
  centre_[v] = section.shift_v;
  extent_[spec.axis] = (high_ - low_) / 2;
  extent_[u] = largest.half_u;
  extent_[v] = largest.half_v;
}

BodyForm::Section BodyForm::at(double along) const {
  const double place = std::clamp((along - low_) / (high_ - low_), 0.0, 1.0) * kTable;
  const int cell = std::min(static_cast<int>(place), kTable - 1);
  const double t = place - cell;
  const Section &a = table_[static_cast<std::size_t>(cell)], &b = table_[static_cast<std::size_t>(cell) + 1];
  return {a.half_u + t * (b.half_u - a.half_u), a.half_v + t * (b.half_v - a.half_v),
          a.shift_u + t * (b.shift_u - a.shift_u), a.shift_v + t * (b.shift_v - a.shift_v)};
}

bool BodyForm::inside(const Vec3& point) const {
  const int u = spec_.axis == 0 ? 1 : 0, v = spec_.axis == 2 ? 1 : 2;
  const double along = point[spec_.axis];
  const double end = (2 * along - low_ - high_) / (high_ - low_);
  if (end < -1 || end > 1) return false;
  const Section section = at(along);
  return even_power((point[u] - section.shift_u) / section.half_u, spec_.section_power) +
             even_power((point[v] - section.shift_v) / section.half_v, spec_.section_power) +
             even_power(end, spec_.end_power) <
         1;
}

Vec3 BodyForm::projected(const Vec3& point) const {
  const Vec3 ray = point - centre_;
  const auto within = [&](double t) { return inside(centre_ + t * ray); };
  double near = 1, far = 1;
  if (within(1))
    for (int i = 0; i < 200 && within(far); ++i) near = far, far *= 1.1;
  else
    for (int i = 0; i < 200 && !within(near); ++i) far = near, near /= 1.1;
  for (int i = 0; i < 24; ++i) {
    const double t = (near + far) / 2;
    (within(t) ? near : far) = t;
  }
  return centre_ + near * ray;
}

Vec3 BodyForm::towards(const Vec3& direction) const {
  return centre_ + direction.cwiseProduct(extent_);
}

LimbForm::LimbForm(Spec spec, const std::string& who)
    : spec_(std::move(spec)), who_(who), pieces_(pieces_of(spec_.sections, who)) {
  const std::vector<Vec3>& joints = spec_.joints;
  if (joints.size() < 2) throw InputError(who + ": needs at least two joints");
  const std::size_t bones = joints.size() - 1;
  std::vector<Vec3> along(bones);
  for (std::size_t i = 0; i < bones; ++i) {
    along[i] = joints[i + 1] - joints[i];
    if (!(along[i].norm() > 0)) throw InputError(who + ": two neighbouring joints are one point");
    along[i].normalize();
  }

  // The centre line is made of cubic Hermite curves from joint to joint. Its frames do not spin (Wang,
  // Juettler, Zheng, Liu, "Computation of rotation minimizing frames", ACM Trans. Graph. 2008).
  const auto tangent = [&](std::size_t joint) -> Vec3 {
    if (joint == 0 || joint == bones) return along[joint == 0 ? 0 : bones - 1];
    const Vec3 sum = along[joint - 1] + along[joint];
    if (!(sum.norm() > 1e-6)) throw InputError(who + ": the centre line turns back at a joint");
    return sum.normalized();
  };
  for (std::size_t bone = 0; bone < bones; ++bone) {
    const Vec3 a = joints[bone], b = joints[bone + 1];
    const double span = (b - a).norm();
    const Vec3 from = span * tangent(bone), to = span * tangent(bone + 1);
    for (int i = bone == 0 ? 0 : 1; i <= kPerBone; ++i) {
      const double t = static_cast<double>(i) / kPerBone, s = 1 - t;
      Sample sample{0, {}};
      sample.frame.centre =
          s * s * (1 + 2 * t) * a + t * s * s * from + t * t * (1 + 2 * s) * b - t * t * s * to;
      sample.frame.along = (6 * t * s * (b - a) + s * (1 - 3 * t) * from + t * (3 * t - 2) * to).normalized();
      if (samples_.empty()) {
        const Vec3& axis = sample.frame.along;
        sample.frame.u = part_across(spec_.u, axis);
        if (!(sample.frame.u.norm() > 1e-3))
          throw InputError(who + ": begins along its face; lead the centre line out of the face");
        sample.frame.u.normalize();
        sample.frame.v = part_across(part_across(spec_.v, axis), sample.frame.u).normalized();
      } else {
        const Frame& before = samples_.back().frame;
        const Vec3 step = sample.frame.centre - before.centre;
        sample.arc = samples_.back().arc + step.norm();
        const Vec3 turned = reflected(before.along, step), left = sample.frame.along - turned;
        sample.frame.u = reflected(reflected(before.u, step), left);
        sample.frame.v = reflected(reflected(before.v, step), left);
      }
      samples_.push_back(sample);
    }
  }
  if (!(spec_.tip >= 0 && spec_.tip < length()))
    throw InputError(who + ": the rounded tip must be shorter than the limb");
}

double LimbForm::joint(std::size_t i) const {
  return samples_[i * kPerBone].arc;
}

LimbForm::Frame LimbForm::at(double arc) const {
  if (arc <= 0 || arc >= length()) {
    const Sample& end = arc <= 0 ? samples_.front() : samples_.back();
    Frame frame = end.frame;
    frame.centre += (arc - end.arc) * frame.along;
    return frame;
  }
  const auto next = std::upper_bound(samples_.begin(), samples_.end(), arc,
                                     [](double value, const Sample& sample) { return value < sample.arc; });
  const Frame &a = (next - 1)->frame, &b = next->frame;
  const double t = (arc - (next - 1)->arc) / (next->arc - (next - 1)->arc), s = 1 - t;
  return {s * a.centre + t * b.centre, s * a.u + t * b.u, s * a.v + t * b.v, s * a.along + t * b.along};
}

LimbForm::Section LimbForm::section(std::size_t piece, double arc) const {
  const double share = std::clamp(arc / length(), 0.0, 1.0);
  const KeyCurve& curve = pieces_[piece];
  return {curve.at(share, 1), curve.at(share, 2), curve.at(share, 3), curve.at(share, 4)};
}

LimbForm::Section LimbForm::section(const Place& place) const {
  Section s = section(place.piece, place.arc);
  if (place.towards_next > 0) {
    const double t = place.towards_next;
    const Section a = section(place.piece, length()), b = section(place.piece + 1, 0);
    s = {(1 - t) * a.radius_u + t * b.radius_u, (1 - t) * a.radius_v + t * b.radius_v,
         (1 - t) * a.shift_u + t * b.shift_u, (1 - t) * a.shift_v + t * b.shift_v};
  }
  s.radius_u = place.scale * s.radius_u;
  s.radius_v = place.scale * s.radius_v;
  return s;
}

Vec3 LimbForm::point(const Place& place, const CirclePoint& direction) const {
  const Frame frame = at(place.arc);
  const Section s = section(place);
  return frame.centre + (s.shift_u + s.radius_u * direction.cosine) * frame.u +
         (s.shift_v + s.radius_v * direction.sine) * frame.v;
}

LimbForm::Place LimbForm::on_tip(double share) const {
  const CirclePoint point = circle_point(share / 4);
  return {length() - spec_.tip + spec_.tip * point.sine, point.cosine, pieces_.size() - 1};
}

std::vector<LimbForm::Stop> LimbForm::stops(double from) const {
  std::vector<Stop> stops;
  const auto add = [&](const Place& place, bool at_edge) {
    double travelled = 0;
    if (!stops.empty()) {
      const Place& before = stops.back().place;
      const Section a = section(before), b = section(place);
      const double out = std::max(std::abs(b.radius_u - a.radius_u) + std::abs(b.shift_u - a.shift_u),
                                  std::abs(b.radius_v - a.radius_v) + std::abs(b.shift_v - a.shift_v));
      const double on = place.arc - before.arc;
      travelled = stops.back().travelled + std::sqrt(on * on + out * out);
    }
    stops.push_back({travelled, place, at_edge});
  };
  const double straight = length() - spec_.tip;
  for (std::size_t piece = 0; piece < pieces_.size(); ++piece) {
    const bool first = piece == 0, last = piece + 1 == pieces_.size();
    const double low = first ? from : pieces_[piece].first_frame() * length();
    const double high = last ? straight : pieces_[piece].last_frame() * length();
    if (!(low < high))
      throw InputError(who_ + ": an edge of its sections lies in the collar or in the rounded tip");
    for (int i = 0; i <= kStops; ++i)
      add({low + (high - low) * i / kStops, 1, piece}, (i == 0 && !first) || (i == kStops && !last));
  }
  for (int i = 1; i <= kTipStops; ++i) add(on_tip(0.5 * i / kTipStops), false);
  return stops;
}

double LimbForm::silhouette(double from) const {
  return stops(from).back().travelled;
}

std::vector<LimbForm::Place> LimbForm::spread(double from, std::size_t count) const {
  const std::vector<Stop> all = stops(from);
  const double distance = all.back().travelled / static_cast<double>(count);
  // Places that are moved to the ends of pieces, as a place's number and its stop. The stops at both ends of
  // an edge follow each other, and both or none get a place.
  std::vector<std::pair<std::size_t, std::size_t>> moved;
  for (std::size_t stop = 0; stop + 1 < all.size(); ++stop) {
    if (!all[stop].at_edge || !all[stop + 1].at_edge) continue;
    const auto nearest = static_cast<std::size_t>(std::lround(all[stop].travelled / distance));
    const std::size_t place = std::max(nearest, moved.empty() ? 1 : moved.back().first + 1);
    if (place + 1 >= count) break;
    moved.push_back({place, stop});
    moved.push_back({place + 1, stop + 1});
    ++stop;
  }
  moved.push_back({count, all.size() - 1});

  std::vector<Place> places;
  std::size_t next = 1, base = 0;
  double base_travelled = 0;
  for (const auto& [number, stop] : moved) {
    const double steps = static_cast<double>(number - base);
    for (std::size_t i = base + 1; i <= number; ++i) {
      const double goal =
          base_travelled + (all[stop].travelled - base_travelled) * static_cast<double>(i - base) / steps;
      while (next + 1 < all.size() && all[next].travelled < goal) ++next;
      const Stop &a = all[next - 1], &b = all[next];
      const double t =
          b.travelled > a.travelled ? std::min(1.0, (goal - a.travelled) / (b.travelled - a.travelled)) : 1;
      Place place{a.place.arc + t * (b.place.arc - a.place.arc),
                  a.place.scale + t * (b.place.scale - a.place.scale), a.place.piece};
      if (b.place.piece > a.place.piece) {
        if (t == 1)
          place = b.place;
        else
          place.towards_next = t;
      }
      places.push_back(place);
    }
    base = number;
    base_travelled = all[stop].travelled;
  }
  return places;
}

}  // namespace cscd::scenes
