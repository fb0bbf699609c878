#include "scenes/cloth/ball.h"

#include <cmath>
#include <map>
#include <utility>

#include "core/base/error.h"
#include "scenes/shape/circle.h"

namespace cscd::scenes {
namespace {

// The angle between two neighbouring corners of an icosahedron, in turns: the arc cosine of 1 / sqrt(5).
constexpr double kCornerTurns = 0.17620819117478337;

std::vector<Vec3> icosahedron_corners() {
  const double golden = (1 + std::sqrt(5.0)) / 2, length = std::sqrt(1 + golden * golden);
  const double a = 1 / length, b = golden / length;
  return {{-a, b, 0},  {a, b, 0},  {-a, -b, 0}, {a, -b, 0}, {0, -a, b},  {0, a, b},
          {0, -a, -b}, {0, a, -b}, {b, 0, -a},  {b, 0, a},  {-b, 0, -a}, {-b, 0, a}};
}

constexpr int kFaces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                               {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                               {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                               {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};

// Makes each vertex of the ball once, however many faces of the icosahedron share it.
class VertexMaker {
 public:
  VertexMaker(const BallParameters& p, Shape& shape) : p_(p), corners_(icosahedron_corners()), shape_(shape) {
    // Weights that are sines of angles space the points of an edge evenly along its arc, as in spherical
    // linear interpolation.
    for (int i = 0; i <= p.parts; ++i) share_.push_back(circle_point(kCornerTurns * i / p.parts).sine);
  }

  // The vertex at whole barycentric coordinates, which sum to `parts`.
  VertexId at(const int (&face)[3], int a, int b, int c) {
    Key key;
    for (const auto& [corner, count] : {std::pair{face[0], a}, {face[1], b}, {face[2], c}})
      if (count > 0) key.emplace(corner, count);
    const auto [place, is_new] = made_.try_emplace(key, VertexId{static_cast<int>(shape_.positions.size())});
    if (is_new) {
      Vec3 sum = Vec3::Zero();
      for (const auto& [corner, count] : key)
        sum += share_[static_cast<std::size_t>(count)] * corners_[static_cast<std::size_t>(corner)];
      shape_.positions.push_back(p_.centre + p_.radius / sum.norm() * sum);
    }
    return place->second;
  }

 private:
  using Key = std::map<int, int>;  // corner of the icosahedron to its coordinate, without zeros
  const BallParameters& p_;
  std::vector<Vec3> corners_;
  std::vector<double> share_;
  Shape& shape_;
  std::map<Key, VertexId> made_;
};

}  // namespace

Shape ball(const BallParameters& p) {
  if (p.parts < 1 || p.parts > 2000 || !(p.radius > 0))
    throw InputError("ball: needs 1 to 2000 parts of an edge and a positive radius");
  Shape shape;
  VertexMaker maker(p, shape);
  for (const auto& face : kFaces)
    for (int row = 0; row < p.parts; ++row)
      for (int i = 0; i + row < p.parts; ++i) {
        const int rest = p.parts - row - i;
        const VertexId here = maker.at(face, rest, i, row), next = maker.at(face, rest - 1, i + 1, row),
                       above = maker.at(face, rest - 1, i, row + 1);
        shape.triangles.push_back({here, next, above});
        if (rest > 1) shape.triangles.push_back({next, maker.at(face, rest - 2, i + 1, row + 1), above});
      }
  shape.weights.resize(shape.positions.size());
  return shape;
}

ShapeRow ball_row() {
  static const ParameterRow rows[] = {
      integer_row("parts", "", "parts of each edge of the icosahedron", {1, 2000}),
      number_row("radius", "length", "radius of the ball", {1e-9, 1e9}),
      vector_row("centre", "length", "centre of the ball"),
  };
  return {
      "ball", "geodesic ball, closed and without bones", rows,
      [](const Parameters& parameters) {
        return ball({parameters.integer("parts"), parameters.number("radius"), parameters.vector("centre")});
      },
      [](const Parameters& parameters, double factor) {
        return parameters.with("parts", scaled_count(parameters.integer("parts"), factor, 1));
      }};
}

}  // namespace cscd::scenes
