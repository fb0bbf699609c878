#include "core/fast/prepare/outward_mesh.h"

#include <utility>
#include <vector>

namespace cscd::fast {
namespace {

// An open component faces inward if the mean over its area of the cosine between normals and the ways out of
// its middle is below this, with long ways counting more. The mean is -1 for a ball and near 0 for cloth, of
// which neither side is the outside.
constexpr double kOpenFacesInward = -0.25;

struct Component {
  Vec3 sum = Vec3::Zero();  // of all corners
  double corners = 0;
  double facing = 0, most = 0;  // six times the volume over the middle, and how large that could be
  bool open = false;
};

}  // namespace

std::unique_ptr<const TriangleMesh> turned_outward(const TriangleMesh& mesh,
                                                   std::span<const Vec3> reference) {
  std::vector<Component> components(static_cast<std::size_t>(mesh.component_count()));
  const auto component_of = [&](TriangleId t) -> Component& {
    return components[static_cast<std::size_t>(mesh.component(t))];
  };
  const auto for_each_triangle = [&](const auto& take) {
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) take(TriangleId{static_cast<std::int32_t>(t)});
  };
  for_each_triangle([&](TriangleId t) {
    Component& component = component_of(t);
    for (const VertexId v : mesh.corners(t)) component.sum += reference[+v], ++component.corners;
    for (const EdgeId edge : mesh.edges_of(t)) component.open |= mesh.triangles_at(edge).size() != 2;
  });
  for_each_triangle([&](TriangleId t) {
    Component& component = component_of(t);
    const Triangle& c = mesh.corners(t);
    const Vec3 way = reference[+c[0]] - component.sum / component.corners;
    const Vec3 normal = (reference[+c[1]] - reference[+c[0]]).cross(reference[+c[2]] - reference[+c[0]]);
    component.facing += way.dot(normal);
    component.most += way.norm() * normal.norm();
  });
  const auto faces_inward = [&](TriangleId t) {
    const Component& component = component_of(t);
    return component.facing < (component.open ? kOpenFacesInward * component.most : 0);
  };
  bool any = false;
  std::vector<Triangle> triangles(mesh.triangles().begin(), mesh.triangles().end());
  for_each_triangle([&](TriangleId t) {
    if (!faces_inward(t)) return;
    std::swap(triangles[+t][1], triangles[+t][2]);
    any = true;
  });
  return any ? std::make_unique<const TriangleMesh>(std::move(triangles), mesh.vertex_count()) : nullptr;
}

}  // namespace cscd::fast
