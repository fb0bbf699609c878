#pragma once

#include <string>
#include <vector>

#include "scenes/shape/circle.h"
#include "scenes/shape/key_curve.h"

namespace cscd::scenes {

// A round limb: elliptic sections strung on a smooth centre line through joints, with a rounded tip.
class LimbForm {
 public:
  struct Spec {
    std::vector<Vec3> joints;    // at least two; the line leads from the first, inside the body, to the tip
    Parameters::Table sections;  // share of the line's length, radius_u, radius_v, shift_u, shift_v
    double tip = 0;              // over which length the end is rounded
    Vec3 u = Vec3::UnitX(), v = Vec3::UnitY();  // the section's axes at the first joint, as nearly as may be
  };
  // Throws InputError, beginning with `who`.
  LimbForm(Spec spec, const std::string& who);

  // The local axes at one arc length; `u` and `v` turn as little as the line allows.
  struct Frame {
    Vec3 centre, u, v, along;
  };
  double length() const { return samples_.back().arc; }
  double joint(std::size_t i) const;  // its arc length
  Frame at(double arc) const;         // continued in straight lines beyond both ends

  // The section before rounding.
  struct Section {
    double radius_u, radius_v, shift_u, shift_v;
  };
  Section section(double arc) const;
  // A point of the surface; `direction` on the unit circle, `scale` of the radii.
  Vec3 point(double arc, const CirclePoint& direction, double scale) const;

  // A place on the silhouette: an arc length, and what rounding leaves of the radii there.
  struct Place {
    double arc, scale;
  };
  // Into the rounded tip: 0 where it begins, 1 at the pole.
  Place on_tip(double share) const;
  // `count` places at equal distances along the silhouette, the last one in the middle of the rounded tip,
  // the first one such a distance after `from`.
  std::vector<Place> spread(double from, std::size_t count) const;
  double silhouette(double from) const;  // the length that they share

 private:
  struct Sample {
    double arc;
    Frame frame;
  };
  struct Stop {
    double travelled;
    Place place;
  };
  std::vector<Stop> stops(double from) const;

  Spec spec_;
  KeyCurve curve_;
  std::vector<Sample> samples_;
};

}  // namespace cscd::scenes
