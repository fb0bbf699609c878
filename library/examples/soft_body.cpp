// Two soft balls fall onto each other and onto a floor, which is an obstacle at rest. Before each step,
// vertices that would touch something are held where they are, until the step is free; nothing ever crosses.

#include <cmath>
#include <cscd/cscd.h>
#include <iostream>
#include <numbers>
#include <vector>
using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
int main() {
  constexpr double dt = 0.02;
  constexpr int rings = 9, around = 12, size = rings * around + 2;  // vertices of a ball
  Rows x(2 * size, 3);
  Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor> faces(4 * rings * around, 3);
  std::vector<std::pair<int, int>> springs;
  for (int ball = 0, f = 0; ball < 2; ++ball) {
    const int first = ball * size, top = first + size - 2, bottom = top + 1;
    const auto at = [&](int r, int k) {
      return r < 0 ? bottom : r == rings ? top : first + r * around + k % around;
    };
    const Eigen::RowVector3d middle(0.3 * ball, 0, 1.2 + 2.3 * ball);
    x.row(top) = middle + Eigen::RowVector3d(0, 0, 1), x.row(bottom) = middle - Eigen::RowVector3d(0, 0, 1);
    for (int r = 0; r <= rings; ++r)
      for (int k = 0; k < around; ++k) {
        const double u = std::numbers::pi * ((r + 1.0) / (rings + 1) - 0.5),
                     w = 2 * std::numbers::pi * k / around;
        springs.emplace_back(at(r - 1, k), at(r, k));
        if (r > 0) faces.row(f++) << at(r - 1, k), at(r - 1, k + 1), at(r, k);
        if (r == rings) continue;
        x.row(at(r, k)) = middle + Eigen::RowVector3d(cos(u) * cos(w), cos(u) * sin(w), sin(u));
        faces.row(f++) << at(r - 1, k + 1), at(r, k + 1), at(r, k);
        springs.emplace_back(at(r, k), at(r, k + 1));
        springs.emplace_back(at(r, k), at(rings - 1 - r, k + around / 2));  // across the ball
      }
  }
  cscd::SelfCollision::Options options;
  const Eigen::Matrix3d floor{{-30, -20, 0}, {30, -20, 0}, {0, 40, 0}};
  options.obstacles.emplace_back(Eigen::RowVector3i(0, 1, 2), floor);
  cscd::SelfCollision balls(faces, x, options);
  Rows rest = x, velocity = Rows::Zero(2 * size, 3);
  int held = 0;
  for (int step = 0; step < 300; ++step) {
    velocity.col(2).array() -= 9.8 * dt;
    Rows wanted = x + dt * velocity;
    for (int round = 0; round < 4; ++round)
      for (const auto& [a, b] : springs) {
        const Eigen::RowVector3d d = wanted.row(b) - wanted.row(a);
        const double wrong = 0.3 * (1 - (rest.row(b) - rest.row(a)).norm() / d.norm());
        wanted.row(a) += wrong * d, wanted.row(b) -= wrong * d;
      }
    for (auto answer = balls.all_contacts(x, wanted); !answer.free(); balls.all_contacts(x, wanted, answer)) {
      if (answer.intersects_at_start()) return 1;
      for (const auto& contact : answer.contacts)
        for (const int v : contact.vertices)  // those of the floor are numbered behind the balls'
          if (v < x.rows()) held += wanted.row(v) != x.row(v), wanted.row(v) = x.row(v);
    }
    velocity = 0.99 / dt * (wanted - x), x = wanted;
  }
  std::cout << held << " vertices held; the lowest stands " << x.col(2).minCoeff() << " above the floor\n";
  return held > 0 && x.col(2).minCoeff() > 0 && x.col(2).maxCoeff() < 4 ? 0 : 1;
}
