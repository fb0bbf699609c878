// A cloth of springs falls onto itself. Each step is cut short of its first contact, so that the cloth never
// passes through itself, and what touches is pushed apart. A cloth has a border; all contacts are right on
// such a surface too.

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
  cscd::SelfCollision cloth(faces, x);

  int touching = 0, crossing = 0;
  for (int step = 0; step < 500; ++step) {
    constexpr double dt = 0.02;
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
    const cscd::SelfCollision::Answer answer = cloth.first_contact(x, wanted);
    crossing += answer.intersects_at_start();
    touching += !answer.contacts.empty();
    const double share = cloth.largest_step(x, wanted);
    velocity = 0.99 * share * (wanted - x) / dt;
    for (const auto& contact : answer.contacts)  // what comes together stops
      for (const int v : contact.vertices) velocity.row(v).setZero();
    x += share * (wanted - x);
  }
  std::cout << touching << " of 500 steps had contacts; " << crossing << " started with crossings\n";
  return touching > 0 && crossing == 0 ? 0 : 1;
}
