// A cloth of springs falls onto itself and moves by bounds alone: each vertex goes where it wants to, but no
// farther than it may. No step is asked about, and the cloth never comes closer to itself than it is thick.

#include <cmath>
#include <cscd/cscd.h>
#include <iostream>
#include <vector>

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

int main() {
  constexpr int n = 16;  // vertices along a side
  Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor> faces(2 * (n - 1) * (n - 1), 3);
  std::vector<std::pair<int, int>> springs;
  Rows x(n * n, 3);
  for (int i = 0, f = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int v = n * i + j;
      x.row(v) << i, j, 0.3 * std::sin(0.9 * i) * std::cos(0.7 * j);
      if (i + 1 < n) springs.emplace_back(v, v + n);
      if (j + 1 < n) springs.emplace_back(v, v + 1);
      if (i + 1 == n || j + 1 == n) continue;
      faces.row(f++) << v, v + n, v + n + 1;
      faces.row(f++) << v, v + n + 1, v + 1;
      springs.emplace_back(v, v + n + 1);
    }
  const Rows rest = x;
  Rows velocity = Rows::Zero(n * n, 3);
  cscd::SelfCollision::Options options;
  options.thickness = 0.1;
  cscd::SelfCollision cloth(faces, x, options);

  int held_back = 0, close = 0;
  for (int step = 0; step < 500; ++step) {
    constexpr double dt = 0.02, cap = 0.2;
    // The two halves are driven towards each other; gravity pulls the middle down.
    for (int v = 0; v < n * n; ++v) {
      velocity(v, 0) += dt * (rest(v, 0) < n / 2.0 ? 0.6 : -0.6);
      velocity(v, 2) -= dt * (1 - std::abs(rest(v, 0) / (n / 2.0) - 1));
    }
    Rows wanted = x + dt * velocity;
    for (int round = 0; round < 10; ++round)
      for (const auto& [a, b] : springs) {
        const Eigen::RowVector3d d = wanted.row(b) - wanted.row(a);
        const double wrong = 0.5 * (1 - (rest.row(b) - rest.row(a)).norm() / d.norm());
        wanted.row(a) += wrong * d, wanted.row(b) -= wrong * d;
      }
    const Rows before = x;
    const std::vector<double> bounds = cloth.vertex_bounds(x, cap);
    for (int v = 0; v < n * n; ++v) {
      const Eigen::RowVector3d way = wanted.row(v) - x.row(v);
      const double may = 0.999 * bounds[std::size_t(v)];  // sums round
      const double share = way.norm() <= may ? 1 : may / way.norm();
      x.row(v) += share * way;
      velocity.row(v) = 0.99 * share * way / dt;
      held_back += share < 1 && bounds[std::size_t(v)] < cap;
    }
    close += !cloth.is_free(before, x);  // to show that it never is
  }
  std::cout << held_back << " times a vertex was held back; " << close << " of 500 steps came too close\n";
  return held_back > 0 && close == 0 ? 0 : 1;
}
