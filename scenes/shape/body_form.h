#pragma once

#include <string>
#include <vector>

#include "core/base/vec3.h"
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

}  // namespace cscd::scenes
