#include "library/engine/arguments.h"

#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"

namespace cscd {

namespace {

template <class Id>
std::vector<std::pair<Id, Id>> ids_of(const std::vector<std::pair<int, int>>& pairs) {
  std::vector<std::pair<Id, Id>> ids;
  for (const auto& [a, b] : pairs) ids.emplace_back(Id{a}, Id{b});
  return ids;
}

void set(Exclusions& out, const TriangleMesh& mesh, std::span<const Vec3> reference,
         const SelfCollision::Exclusions& asked) {
  if (!asked.rigid.empty()) out.set_rigid(mesh, asked.rigid);
  if (!asked.group.empty())
    out.set_groups(mesh, asked.group, asked.groups_that_ignore_each_other);
  else if (!asked.groups_that_ignore_each_other.empty())
    throw InputError("groups_that_ignore_each_other: no vertex has a group; give `group` as well");
  out.exclude(mesh, ids_of<VertexId>(asked.vertex_pairs));
  out.exclude(mesh, ids_of<TriangleId>(asked.face_pairs));
  if (asked.rings < 0) throw InputError("rings: " + std::to_string(asked.rings) + "; give at least 0");
  out.exclude_rings(mesh, asked.rings);
  out.exclude_near(reference, asked.rest_distance);
}

}  // namespace

Exclusions exclusions_of(const TriangleMesh& mesh, std::span<const Vec3> reference,
                         const SelfCollision::Exclusions& asked) {
  Exclusions out;
  try {
    set(out, mesh, reference, asked);
  } catch (const InputError& error) {
    throw InputError(std::string("exclude, ") + error.what());
  }
  return out;
}

std::unique_ptr<ObstacleMesh> obstacle_mesh_of(const std::vector<SelfCollision::Obstacle>& obstacles) {
  if (obstacles.empty()) return nullptr;
  std::vector<Triangle> triangles;
  std::vector<Vec3> positions;
  std::vector<std::size_t> first_vertex;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const std::string name = "obstacle " + std::to_string(i);
    std::vector<Vec3> own;
    for (const auto& [x, y, z] : obstacles[i].positions) own.emplace_back(x, y, z);
    require_finite(own, name + ", positions");
    const auto first = static_cast<std::int32_t>(positions.size());
    std::vector<Triangle> faces;
    for (const auto& [a, b, c] : obstacles[i].faces) faces.push_back({VertexId{a}, VertexId{b}, VertexId{c}});
    const TriangleMesh mesh(std::move(faces), own.size(), name + ", faces");  // throws for wrong corners
    for (Triangle t : mesh.triangles()) {
      for (VertexId& v : t) v = VertexId{first + static_cast<std::int32_t>(v)};
      triangles.push_back(t);
    }
    first_vertex.push_back(positions.size());
    positions.insert(positions.end(), own.begin(), own.end());
  }
  TriangleMesh mesh(std::move(triangles), positions.size(), "obstacles");
  return std::make_unique<ObstacleMesh>(
      ObstacleMesh{std::move(positions), std::move(first_vertex), std::move(mesh)});
}

}  // namespace cscd
