#pragma once

// For tests only: a bent, noisy tube with bones along it, and the positions of one interval.

#include <cmath>
#include <random>

#include "core/fast/prepare/covers.h"
#include "core/mesh/motion.h"
#include "core/mesh/test_shapes.h"
#include "core/radial/atomic_clusters.h"

namespace cscd::test {

struct Body {
  Shape shape;
  TriangleMesh mesh;
  Rig rig;
  radial::AtomicClusters atomic;
  std::vector<Vec3> start, end;

  // The tube has radius 0.8 and length 15, and `noise` and `bend` are lengths in that unit. All positions are
  // then scaled by `scale` and shifted by `origin`.
  explicit Body(double noise, double bend, const Vec3& origin = Vec3::Zero(), double scale = 1, int seed = 1)
      : shape(uneven_tube(12, 70, 15, [](double x) { return 0.8 + 0.1 * std::sin(3 * x); })),
        mesh(shape.mesh()),
        rig(straight_chain(5, {0.5, 0, 0}, {14.5, 0, 0})) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const auto dice = [&] { return static_cast<double>(random() >> 8) * 0x1p-23 - 1; };
    const auto placed = [&](Vec3 p, double bent) {
      p.y() += bent * std::sin(p.x() / 3);
      p += noise * Vec3(dice(), dice(), dice());
      return Vec3(origin + scale * p);
    };
    for (const Vec3& p : shape.positions) start.push_back(placed(p, bend));
    for (const Vec3& p : shape.positions) end.push_back(placed(p + Vec3(0.3, 0, 0.2), 1.5 * bend));
    std::vector<BoneId> bone_of;
    for (const Triangle& t : mesh.triangles()) {
      const double x =
          (shape.positions[+t[0]].x() + shape.positions[+t[1]].x() + shape.positions[+t[2]].x()) / 3;
      bone_of.push_back(BoneId{std::clamp(static_cast<int>((x - 0.5) / 2.8), 0, 4)});
    }
    atomic = radial::make_atomic_clusters(mesh, bone_of);
  }
  Motion motion() const { return Motion(start, end); }
};

}  // namespace cscd::test
