#pragma once

#include <string>
#include <vector>

#include "core/base/vec3.h"
#include "scenes/shape/circle.h"
#include "scenes/shape/key_curve.h"
#include "scenes/shape/parameters.h"

namespace cscd::scenes {

// A rounded body about one axis of the world. Its sections across the axis are superellipses |u /
// half_u|^p + |v / half_v|^p = 1 (p = 2 gives an ellipse, 4 and more a rounded rectangle) that close
// towards the ends as a superellipsoid does. u and v are the other two axes in the order x, y, z. The body
// is smooth between the given sections.
class BodyForm {
 public:
  struct Spec {
    int axis = 2;  // 0, 1, 2
    Parameters::Table
        sections;  // along the axis, half_u, half_v, shift_u, shift_v; the ends are the first and last
    int section_power = 2;  // even, from 2 to 64
    int end_power = 2;      // even, from 2 to 64; 2 closes like an ellipsoid, larger powers are blunter
  };
  // Throws InputError, whose text begins with `who`, for sections or powers that give no body.
  BodyForm(const Spec& spec, const std::string& who);

  const Vec3& centre() const { return centre_; }  // halfway between the ends, inside
  bool inside(const Vec3& point) const;
  // The point at which the ray from the centre through `point` leaves the body. Every point of the body
  // must be visible from the centre.
  Vec3 projected(const Vec3& point) const;
  // A point in the given direction from the centre. Each component of the direction is a share of the
  // body's extent.
  Vec3 towards(const Vec3& direction) const;

 private:
  struct Section {
    double half_u, half_v, shift_u, shift_v;
  };
  Section at(double along) const;

  Spec spec_;
  double low_, high_;
  std::vector<Section> table_;  // at equal distances from low_ to high_; a table, because it is read often
  Vec3 centre_, extent_;
};

// A round limb. It has elliptic sections along a smooth centre line through joints, and a rounded tip.
// Places on the centre line are given by *arc length*: the length of the line from the first joint.
//
// A section whose share is not above the share of the section before it begins a new *piece* of the limb, as
// the hand begins where a cuff ends. The surface leads straight from the end of one piece to the beginning of
// the next. With equal shares this is a square edge, which stands on edge towards the centre line. With a
// lower share the end of the first piece overhangs the second one.
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

  // A place on the silhouette.
  struct Place {
    double arc;
    double scale = 1;  // a factor on the radii, with which the tip is rounded
    std::size_t piece = 0;
    double towards_next = 0;  // the share of the way from the end of the piece to the next piece
  };
  // A point of the surface, in a direction on the unit circle.
  Vec3 point(const Place& place, const CirclePoint& direction) const;

  // A place on the rounded tip. `share` is 0 where the tip begins and 1 at its pole.
  Place on_tip(double share) const;
  // Returns `count` places along the silhouette. The first place is one distance after `from`, and the last
  // place is in the middle of the rounded tip. Distances are equal, but for the places that are moved to the
  // ends of pieces. Where there are too few places for that, an edge between two pieces is cut off.
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
    bool at_edge;  // at the end of a piece that another one follows, or at the beginning of that one
  };
  std::vector<Stop> stops(double from) const;
  struct Section {
    double radius_u, radius_v, shift_u, shift_v;
  };
  Section section(std::size_t piece, double arc) const;
  Section section(const Place& place) const;

  Spec spec_;
  std::string who_;
  std::vector<KeyCurve> pieces_;
  std::vector<Sample> samples_;
};

}  // namespace cscd::scenes
