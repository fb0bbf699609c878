#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// A vertex of a closed component at the border of all space that the component does not wind around, and the
// winding number just before the faces at that vertex: 0, or -1 where these faces look inward.
struct OutermostVertex {
  VertexId vertex;
  int winding;
};

// Looks for such a vertex at the ends of the component, all of whose triangles are given, along the axes.
// Decides with certainty, or returns nothing. `is_on_curve` says at which vertices faces of their own ring
// cross each other; such a vertex says nothing.
std::optional<OutermostVertex> find_outermost_vertex(const TriangleMesh& mesh,
                                                     std::span<const Vec3> positions,
                                                     std::span<const TriangleId> component,
                                                     const std::function<bool(VertexId)>& is_on_curve);

// Whether the faces of a closed component look inward: it holds a negative volume. Where rounding leaves the
// sign of the volume open, an outermost vertex decides, which is right if the component does not cross
// itself.
bool faces_inward(const TriangleMesh& mesh, std::span<const Vec3> positions,
                  std::span<const TriangleId> component, const std::function<bool(VertexId)>& is_on_curve);

// A way from one part of the component's skin to another, on which so many more of its faces come to lie
// before the skin. Each way can be gone back.
struct WindingStep {
  std::int32_t from, to;
  int more;
};
// The winding number of each of `parts` parts, from that of one of them. Nothing for those to which no way
// leads, or for all if there is no such part.
std::vector<std::optional<int>> spread_winding(std::size_t parts, std::span<const WindingStep> steps,
                                               std::int32_t known, int winding);

}  // namespace cscd
