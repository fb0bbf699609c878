#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::scenes {

// A generator that gives the same numbers with every compiler and standard library. The distributions of the
// standard library do not promise that; nor does C++ say which of a call's arguments is drawn first, so each
// draw is a statement of its own, or stands in braces.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  int integer(int low, int high) {  // both inclusive
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  // Half of the time 0.
  double at_times(double low, double high) {
    const bool drawn = integer(0, 1) == 1;  // the other number is drawn in any case
    const double value = uniform(low, high);
    return drawn ? value : 0;
  }
  // The next two draw z first, then y, then x: records hold samples that were drawn so.
  Vec3 between(const Vec3& low, const Vec3& high) {
    const double z = uniform(low.z(), high.z()), y = uniform(low.y(), high.y());
    return {uniform(low.x(), high.x()), y, z};
  }
  Vec3 whole(int low, int high) {
    const int z = integer(low, high), y = integer(low, high);
    return Vec3(integer(low, high), y, z);
  }
  Vec3 in_box(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }

 private:
  std::mt19937_64 engine_;
};

// A small surface, closed and oriented outward but for sheets. Each of the functions below appends one
// connected component.
struct Surface {
  std::vector<Vec3> positions;      // [vertices]
  std::vector<Triangle> triangles;  // [triangles]
};

// Appends a sphere of the given radius: an octahedron with every face split in four, `splits` times. It has
// 8 * 4^splits triangles.
void append_sphere(Surface& surface, int splits, double radius, const Vec3& centre);

// Appends a box of twelve triangles.
void append_box(Surface& surface, const Vec3& low, const Vec3& high);

// A tube along z from -length / 2 to length / 2, with pointed ends. It has 2 * sides * rings triangles.
struct Tube {
  int rings, sides;
  double length;
  std::vector<double> radii;  // control values along the tube, interpolated linearly
};
void append_tube(Surface& surface, const Tube& tube);

// Appends an open sheet in the plane x = 0, centred: `along` by `across` squares over a length along z and a
// width along y, two triangles a square.
void append_sheet(Surface& surface, int along, int across, double length, double width);

// Appends a pointed finger over the segment from (-1, 0, 0) to (1, 0, 0). The other end of the finger is
// led round in two bends to a small face in front of the finger's tip, so that all is one connected
// surface. The finger is the first four vertices, and the tip is the first of these. Moved by kFingerPoke,
// the tip goes through the face. The underside of the finger changes its sign towards the segment: it is
// negative at the tip and positive at its other corners. All other triangles at the tip and the face are
// positive.
void append_hooked_finger(Surface& surface);
inline const Vec3 kFingerPoke = -0.155 * Vec3(-0.85, 0, 0.52678);

}  // namespace cscd::scenes
