#pragma once

#include <string>
#include <vector>

#include "core/base/vec3.h"
#include "scenes/shape/parameters.h"

namespace cscd::scenes {

// A rounded body about one axis of the world: sections across the axis are superellipses
// |u / half_u|^p + |v / half_v|^p = 1 (p = 2 ellipse, 4 and more rounded rectangle) that close towards the
// ends as a superellipsoid does. u and v are the other two axes in the order x, y, z. Smooth between the
// sections given.
class BodyForm {
 public:
  struct Spec {
    int axis = 2;  // 0, 1, 2
    Parameters::Table
        sections;  // along the axis, half_u, half_v, shift_u, shift_v; the ends are the first and last
    int section_power = 2;  // even, as the next
    int end_power = 2;      // 2 closes like an ellipsoid, more the blunter
  };
  // Throws InputError, beginning with `who`.
  BodyForm(const Spec& spec, const std::string& who);

  const Vec3& centre() const { return centre_; }  // halfway between the ends, inside
  bool inside(const Vec3& point) const;
  // Where the ray from the centre through a point leaves the body. The body must be seen from its centre
  // whole.
  Vec3 projected(const Vec3& point) const;
  // A point in the given direction from the centre, each component a share of the body's extent.
  Vec3 towards(const Vec3& direction) const;

 private:
  struct Section {
    double half_u, half_v, shift_u, shift_v;
  };
  Section at(double along) const;

  Spec spec_;
  double low_, high_;
  std::vector<Section> table_;  // at equal distances from low to high; asked for very often
  Vec3 centre_, extent_;
};

}  // namespace cscd::scenes
