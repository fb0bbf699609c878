#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::scenes {

// The same numbers with every standard library, which its distributions do not promise.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  int integer(int low, int high) {  // both inclusive
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  Vec3 in_box(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }

 private:
  std::mt19937_64 engine_;
};

// A small closed surface, outward oriented. Components are appended one after the other.
struct Surface {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
};

// Octahedron with every face split in four, `splits` times, on a sphere of the given radius: 8 * 4^splits
// triangles.
void append_sphere(Surface& surface, int splits, double radius, const Vec3& centre);

// Twelve triangles.
void append_box(Surface& surface, const Vec3& low, const Vec3& high);

// Tube along z from -length / 2 to length / 2 with pointed ends; radius(s) for s in [0, 1] along it. 2 sides
// * rings triangles.
struct Tube {
  int rings, sides;
  double length;
  std::vector<double> radii;  // control values along the tube, interpolated linearly
};
void append_tube(Surface& surface, const Tube& tube);

// A pointed finger over the segment from (-1, 0, 0) to (1, 0, 0) whose other end is led round in two bends to
// a small face before its tip: one connected surface. The finger is the first four vertices, the tip the very
// first; moved by kFingerPoke the tip goes through the face. Its underside changes sign towards the segment
// between the tip (negative) and the other corners (positive); all else at tip and face is positive.
void append_hooked_finger(Surface& surface);
inline const Vec3 kFingerPoke = -0.155 * Vec3(-0.85, 0, 0.52678);

}  // namespace cscd::scenes
