// Pairs for a solver with a narrow phase of its own: here, the distance of each vertex to each face near it.

#include <Eigen/Geometry>
#include <cscd/cscd.h>
#include <iostream>

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

int main() {
  // A strip that is folded over: its two halves are 0.1 apart.
  constexpr int n = 20;
  Rows x(2 * n, 3);
  Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor> faces(2 * (n - 1), 3);
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < 2; ++k) x.row(2 * i + k) << (i < n / 2 ? i : n - 1 - i), k, (i < n / 2 ? 0.0 : 0.1);
  for (int i = 0; i + 1 < n; ++i) {
    faces.row(2 * i) << 2 * i, 2 * i + 2, 2 * i + 1;
    faces.row(2 * i + 1) << 2 * i + 1, 2 * i + 2, 2 * i + 3;
  }

  cscd::SelfCollision::Options options;
  options.exclude.rings = 2;  // neighbours are held together by the solver's own springs
  cscd::SelfCollision strip(faces, x, options);
  const auto candidates = strip.candidates(x, x, 0.15);
  double nearest = 1e30;
  for (const auto& [vertex, face] : candidates.vertex_face) {
    const Eigen::Vector3d a = x.row(faces(face, 0)), b = x.row(faces(face, 1)), c = x.row(faces(face, 2));
    const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
    nearest = std::min(nearest, std::abs(normal.dot(x.row(vertex).transpose() - a)));
  }
  std::cout << candidates.vertex_face.size() << " vertices near faces, " << candidates.edge_edge.size()
            << " pairs of edges near each other; planes are " << nearest << " away\n";
  return candidates.vertex_face.empty() || nearest > 0.11 ? 1 : 0;
}
