#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/stage_clock.h"
#include "core/fast/fast_culler.h"
#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Positions at both ends of an interval, [vertices] each.
using PosePair = std::array<std::vector<Vec3>, 2>;

// Returns `count` intervals of what a closed and oriented surface might do, to count work in. Every bone is
// turned about its joint by some 20 degrees about an axis drawn at random, and by 5 degrees more at the end
// of the interval. The surface follows the bone of each triangle, `bone_of` [triangles], smoothed over the
// seams. The poses may cross themselves.
std::vector<PosePair> trial_poses(const TriangleMesh& mesh, std::span<const Vec3> reference, const Rig& rig,
                                  std::span<const BoneId> bone_of, std::size_t count);

// A prepared culler, and the cluster of each triangle that its surface was cut along.
struct TrialCuller {
  std::vector<std::int32_t> cluster_of;  // [triangles]
  std::unique_ptr<FastCuller> culler;
  std::size_t new_triangles = 0;  // that StrategyInput::preparation did not know
};

// The clusters of a surface of more triangles than this are found on a coarser surface of at most this many
// triangles (prepare/coarse_surface.h).
inline constexpr std::size_t kManyTriangles = 16000;

// Prepares several cullers and returns the one that makes the least work in a few trial poses
// (trial_poses). The candidates are cut along the clusters of bones or of the surface, and look from one,
// two or three covers. They are prepared and tried side by side on the threads of the set-up. Where there are
// no bones, labels of vertices (StrategyInput::labels) stand for them. Without either, on an open surface, or
// where the options name the clusters, there is one candidate and no trial. On a surface of many triangles,
// clusters are found on a coarser surface. Where signs suffice, candidates are tried on the coarser surface
// too, and only the culler that is returned is cut from the surface itself. With StrategyInput::preparation,
// nothing is tried or cut, and what the preparation says is taken. Leaves the clock in the stage
// `decomposition`.
TrialCuller best_trial_culler(const StrategyInput& setup, const DrvbcFastOptions& options, StageClock& clock);

}  // namespace cscd::fast
