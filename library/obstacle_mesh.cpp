#include "library/obstacle_mesh.h"

#include <string>

namespace cscd {

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
