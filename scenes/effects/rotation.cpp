#include "scenes/effects/rotation.h"

namespace cscd::scenes {

Eigen::Matrix3d smallest_rotation(const Vec3& from, const Vec3& to) {
  const Vec3 axis = from.cross(to);  // its length is the sine of the angle
  const double cosine = from.dot(to);
  if (cosine < -0.999999) {
    // Make a half turn about any axis perpendicular to `from`.
    int least = 0;
    from.cwiseAbs().minCoeff(&least);
    const Vec3 across = from.cross(Vec3::Unit(least)).normalized();
    return 2 * across * across.transpose() - Eigen::Matrix3d::Identity();
  }
  Eigen::Matrix3d cross;
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return Eigen::Matrix3d::Identity() + cross + composed(cross, cross) / (1 + cosine);
}

}  // namespace cscd::scenes
