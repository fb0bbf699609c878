#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"
#include "core/radial/visible_bones.h"

namespace cscd::radial {

// Receives the weights of one bone, [vertices].
using TakeWeights = std::function<void(BoneId bone, const Eigen::Ref<const Eigen::VectorXd>& weights)>;

// Solves for the heat weights of each bone (Baran and Popovic, SIGGRAPH 2007, section 4; see
// heat_weights.cpp) and hands them on in ascending order of the bones. A bone that heats no vertex has weight
// 0 everywhere and is left out. At a vertex of the surface the weights lie in [0, 1] and sum to 1, up to
// rounding. At a vertex that no triangle uses they are 0. Returns false, having handed on nothing, if the
// system cannot be factorised.
[[nodiscard]] bool diffuse_heat(const TriangleMesh& mesh, std::span<const Vec3> positions,
                                const VisibleBones& visible, const TakeWeights& take);

}  // namespace cscd::radial
