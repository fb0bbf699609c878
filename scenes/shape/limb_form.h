#pragma once

#include <string>
#include <vector>

#include "scenes/shape/circle.h"
#include "scenes/shape/key_curve.h"

namespace cscd::scenes {

// A round limb. It has elliptic sections along a smooth centre line through joints, and a rounded tip.
// Places on the centre line are given by *arc length*: the length of the line from the first joint.
class LimbForm {
 public:
  struct Spec {
    std::vector<Vec3> joints;    // at least two; the line leads from the first, inside the body, to the tip
    Parameters::Table sections;  // share of the line's length, radius_u, radius_v, shift_u, shift_v
    double tip = 0;              // the length over which the end is rounded
    // The axes of the section at the first joint. Their parts along the centre line are removed.
    Vec3 u = Vec3::UnitX(), v = Vec3::UnitY();
  };
  // Throws InputError, whose text begins with `who`, for joints or sections that give no limb.
  LimbForm(Spec spec, const std::string& who);

  // The local axes at one arc length. `u` and `v` turn as little as the line allows.
  struct Frame {
    Vec3 centre, u, v, along;
  };
  double length() const { return samples_.back().arc; }
  double joint(std::size_t i) const;  // the arc length of joint i
  Frame at(double arc) const;         // the line is continued straight beyond both ends

  // The section at an arc length, without the rounding of the tip.
  struct Section {
    double radius_u, radius_v, shift_u, shift_v;
  };
  Section section(double arc) const;
  // A point of the surface, in a direction on the unit circle. `scale` is a factor on the radii.
  Vec3 point(double arc, const CirclePoint& direction, double scale) const;

  // A place on the silhouette: an arc length, and the factor by which the rounding of the tip shrinks the
  // radii there.
  struct Place {
    double arc, scale;
  };
  // A place on the rounded tip. `share` is 0 where the tip begins and 1 at its pole.
  Place on_tip(double share) const;
  // Returns `count` places at equal distances along the silhouette. The first place is one such distance
  // after `from`, and the last place is in the middle of the rounded tip.
  std::vector<Place> spread(double from, std::size_t count) const;
  // The length of the silhouette over which `spread` divides its places.
  double silhouette(double from) const;

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
