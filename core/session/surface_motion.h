#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/motion.h"

namespace cscd {

// A length with the roundings of a few sums and of a square root paid for. Squares of tiny lengths underflow,
// so the result is not tiny.
double rounded_up(double length);

// How far a surface is at both ends of a step from where it was in a pose, less one rotation and one shift
// for each end (core/soundness.md, "Theorem: small steps near a pose").
struct SurfaceMotion {
  // The largest distance of a vertex from where rotation and shift take it, rounded up. Infinite where it
  // exceeds what was asked for.
  double most = std::numeric_limits<double>::infinity();
  // What the mean of both rotations keeps at least of a distance, rounded down.
  double kept = 1;

  // Features that are farther apart than this in the pose stay farther apart than `distance`.
  double reach(double distance) const;
};

// Some vertices that stand for all of them.
std::vector<std::size_t> sampled_vertices(std::size_t vertex_count);

// The motion from a pose, `from`, [vertices], to both ends of a step: with shifts alone where vertices then
// are at most `enough` away, else with rotations, which are fitted to the sample.
SurfaceMotion surface_motion(const Motion& motion, std::span<const Vec3> from,
                             std::span<const std::size_t> sample, double enough);

// How far the sampled vertices move within a step, less one shift, and less one rotation where that is more
// than `enough`. No bound for the others: it spares large steps a look at all vertices.
double sampled_length(const Motion& motion, std::span<const std::size_t> sample, double enough);

}  // namespace cscd
