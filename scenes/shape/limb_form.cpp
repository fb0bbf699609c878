#include "scenes/shape/limb_form.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace cscd::scenes {
namespace {

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

const Parameters::Table& checked(const Parameters::Table& sections, const std::string& who) {
  bool usable = !sections.empty();
  for (std::size_t i = 0; i < sections.size(); ++i)
    usable = usable && sections[i][0] >= 0 && sections[i][0] <= 1 && sections[i][1] > 0 &&
             sections[i][2] > 0 && (i == 0 || sections[i][0] > sections[i - 1][0]);
  if (!usable)
    throw InputError(who + ": sections must be given in order, at shares from 0 to 1, with positive radii");
  return sections;
}

}  // namespace

LimbForm::LimbForm(Spec spec, const std::string& who)
    : spec_(std::move(spec)), curve_(checked(spec_.sections, who), who) {
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

LimbForm::Section LimbForm::section(double arc) const {
  const double share = std::clamp(arc / length(), 0.0, 1.0);
  return {curve_.at(share, 1), curve_.at(share, 2), curve_.at(share, 3), curve_.at(share, 4)};
}

Vec3 LimbForm::point(double arc, const CirclePoint& direction, double scale) const {
  const Frame frame = at(arc);
  const Section s = section(arc);
  return frame.centre + (s.shift_u + scale * s.radius_u * direction.cosine) * frame.u +
         (s.shift_v + scale * s.radius_v * direction.sine) * frame.v;
}

LimbForm::Place LimbForm::on_tip(double share) const {
  const CirclePoint point = circle_point(share / 4);
  return {length() - spec_.tip + spec_.tip * point.sine, point.cosine};
}

std::vector<LimbForm::Stop> LimbForm::stops(double from) const {
  std::vector<Stop> stops;
  const auto add = [&](const Place& place) {
    if (stops.empty()) {
      stops.push_back({0, place});
      return;
    }
    const Place& before = stops.back().place;
    const Section a = section(before.arc), b = section(place.arc);
    const double out = std::max(
        std::abs(place.scale * b.radius_u - before.scale * a.radius_u) + std::abs(b.shift_u - a.shift_u),
        std::abs(place.scale * b.radius_v - before.scale * a.radius_v) + std::abs(b.shift_v - a.shift_v));
    const double on = place.arc - before.arc;
    stops.push_back({stops.back().travelled + std::sqrt(on * on + out * out), place});
  };
  const double straight = length() - spec_.tip;
  for (int i = 0; i <= kStops; ++i) add({from + (straight - from) * i / kStops, 1});
  for (int i = 1; i <= kTipStops; ++i) add(on_tip(0.5 * i / kTipStops));
  return stops;
}

double LimbForm::silhouette(double from) const {
  return stops(from).back().travelled;
}

std::vector<LimbForm::Place> LimbForm::spread(double from, std::size_t count) const {
  const std::vector<Stop> all = stops(from);
  std::vector<Place> places;
  std::size_t next = 1;
  for (std::size_t i = 1; i <= count; ++i) {
    const double goal = all.back().travelled * static_cast<double>(i) / static_cast<double>(count);
    while (next + 1 < all.size() && all[next].travelled < goal) ++next;
    const Stop &a = all[next - 1], &b = all[next];
    const double t =
        b.travelled > a.travelled ? std::min(1.0, (goal - a.travelled) / (b.travelled - a.travelled)) : 1;
    places.push_back(
        {a.place.arc + t * (b.place.arc - a.place.arc), a.place.scale + t * (b.place.scale - a.place.scale)});
  }
  return places;
}

}  // namespace cscd::scenes
