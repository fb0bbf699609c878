#pragma once

// For tests only: bodies cut into patches, far from the origin and in small units too.

#include <cmath>
#include <vector>

#include "core/fast/classify/local_positions.h"
#include "core/fast/prepare/cut_surface.h"
#include "core/fast/prepare/test_body.h"
#include "core/radial/test_exact_orientation.h"

namespace cscd::test {

// A body that is cut into patches, and its local positions. The origin and the unit of the local coordinates
// are such that a viewpoint whose local coordinates have few bits is exact in world coordinates too.
struct Patches : Body, fast::CutSurface {
  Vec3 shift;
  double unit;  // length of one local unit in the world
  fast::LocalPositions local;

  Patches(double noise, double bend, const Vec3& origin, double scale, int seed)
      : Body(noise, bend, origin, scale, seed),
        fast::CutSurface(fast::cut_surface(mesh, shape.positions, atomic.of_triangle)),
        local(start) {
    local.update(motion());
    shift = start[0];
    Eigen::AlignedBox3d box;
    for (const Vec3& p : start) box.extend(p);
    unit = std::ldexp(1.0, std::ilogb(box.sizes().maxCoeff()));
  }
  // Returns the exact local coordinates of a point of the world.
  Exact3 exact_local(const Vec3& p) const {
    const Exact3 at = exact(p), from = exact(shift);
    Exact3 out;
    for (std::size_t i = 0; i < 3; ++i) out[i] = (at[i] - from[i]) / mpq_class(unit);
    return out;
  }
};

inline std::vector<Patches> patches() {
  constexpr struct {
    double noise, bend, origin, scale;
  } kBodies[] = {{0.02, 1, 0, 1}, {0.1, 2, 1e6, 1}, {0.05, 3, 1e9, 1e-3}, {0.1, 1, 0.5, 1e-15}};
  std::vector<Patches> all;
  for (const auto& b : kBodies)
    all.emplace_back(b.noise, b.bend, Vec3(b.origin, -b.origin / 2, b.origin / 4), b.scale,
                     1 + static_cast<int>(all.size()));
  return all;
}

}  // namespace cscd::test
