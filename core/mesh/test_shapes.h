#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"

// Small surfaces for tests. All but ramp() are closed, and all are oriented outward.
namespace cscd::test {

struct Shape {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  TriangleMesh mesh() const { return TriangleMesh(triangles, positions.size(), "test shape"); }
};

inline Triangle corners(int a, int b, int c) {
  return {VertexId{a}, VertexId{b}, VertexId{c}};
}

// An octahedron: eight faces, corners at distance `radius` from the origin along the axes.
inline Shape octahedron(double radius = 1) {
  const double r = radius;
  return {{{r, 0, 0}, {-r, 0, 0}, {0, r, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}},
          {corners(0, 2, 4), corners(2, 1, 4), corners(1, 3, 4), corners(3, 0, 4), corners(2, 0, 5),
           corners(1, 2, 5), corners(3, 1, 5), corners(0, 3, 5)}};
}

// Splits every face of a star-shaped surface about the origin in four and moves all vertices onto
// the sphere of the given radius.
inline Shape split_onto_sphere(const Shape& shape, double radius) {
  const TriangleMesh mesh = shape.mesh();
  Shape out{shape.positions, {}};
  const auto first_middle = static_cast<int>(shape.positions.size());
  for (const Edge& e : mesh.edges())
    out.positions.push_back((shape.positions[+e[0]] + shape.positions[+e[1]]) / 2);
  for (Vec3& p : out.positions) p *= radius / p.norm();
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const TriangleId id{static_cast<std::int32_t>(t)};
    int c[3], m[3];
    for (std::size_t k = 0; k < 3; ++k) {
      c[k] = static_cast<int>(mesh.corners(id)[k]);
      m[k] = first_middle + static_cast<int>(mesh.edges_of(id)[k]);
    }
    out.triangles.push_back(corners(c[0], m[0], m[2]));
    out.triangles.push_back(corners(m[0], c[1], m[1]));
    out.triangles.push_back(corners(m[2], m[1], c[2]));
    out.triangles.push_back(corners(m[0], m[1], m[2]));
  }
  return out;
}

// An icosahedron whose faces are split `splits` times onto the sphere: 20 * 4^splits faces.
inline Shape icosphere(int splits, double radius = 1) {
  const double g = std::numbers::phi;
  Shape shape{
      {{-1, g, 0},
       {1, g, 0},
       {-1, -g, 0},
       {1, -g, 0},
       {0, -1, g},
       {0, 1, g},
       {0, -1, -g},
       {0, 1, -g},
       {g, 0, -1},
       {g, 0, 1},
       {-g, 0, -1},
       {-g, 0, 1}},
      {corners(0, 11, 5), corners(0, 5, 1),  corners(0, 1, 7),   corners(0, 7, 10), corners(0, 10, 11),
       corners(1, 5, 9),  corners(5, 11, 4), corners(11, 10, 2), corners(10, 7, 6), corners(7, 1, 8),
       corners(3, 9, 4),  corners(3, 4, 2),  corners(3, 2, 6),   corners(3, 6, 8),  corners(3, 8, 9),
       corners(4, 9, 5),  corners(2, 4, 11), corners(6, 2, 10),  corners(8, 6, 7),  corners(9, 8, 1)}};
  for (Vec3& p : shape.positions) p *= radius / p.norm();
  for (int i = 0; i < splits; ++i) shape = split_onto_sphere(shape, radius);
  return shape;
}

// A round tube along the x axis from 0 to `length`. It has `rings` + 1 circles of `sides` vertices and a flat
// fan at each end. Its radius at x is radius_at(x).
template <class RadiusAt>
Shape uneven_tube(int sides, int rings, double length, RadiusAt&& radius_at) {
  Shape shape;
  for (int i = 0; i <= rings; ++i) {
    const double x = length * i / rings, r = radius_at(x);
    for (int j = 0; j < sides; ++j) {
      const double angle = 2 * std::numbers::pi * j / sides;
      shape.positions.emplace_back(x, r * std::cos(angle), r * std::sin(angle));
    }
  }
  const int left = (rings + 1) * sides, right = left + 1;
  shape.positions.emplace_back(0, 0, 0);
  shape.positions.emplace_back(length, 0, 0);
  for (int j = 0; j < sides; ++j) {
    const int k = (j + 1) % sides;
    shape.triangles.push_back(corners(left, k, j));
    for (int i = 0; i < rings; ++i) {
      const int a = i * sides + j, b = i * sides + k;
      shape.triangles.push_back(corners(a, b, b + sides));
      shape.triangles.push_back(corners(a, b + sides, a + sides));
    }
    shape.triangles.push_back(corners(rings * sides + j, rings * sides + k, right));
  }
  return shape;
}

inline Shape capped_tube(int sides, int rings, double radius, double length) {
  return uneven_tube(sides, rings, length, [radius](double) { return radius; });
}

// A torus about the z axis.
inline Shape torus(int around = 12, int across = 8, double major = 2, double minor = 0.5) {
  Shape shape;
  for (int i = 0; i < around; ++i) {
    const double u = 2 * std::numbers::pi * i / around;
    for (int j = 0; j < across; ++j) {
      const double v = 2 * std::numbers::pi * j / across, r = major + minor * std::cos(v);
      shape.positions.emplace_back(r * std::cos(u), r * std::sin(u), minor * std::sin(v));
    }
  }
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const int i1 = (i + 1) % around, j1 = (j + 1) % across;
      const int a = i * across + j, b = i1 * across + j, c = i1 * across + j1, d = i * across + j1;
      shape.triangles.push_back(corners(a, b, c));
      shape.triangles.push_back(corners(a, c, d));
    }
  return shape;
}

// An open strip, two quads wide, that winds about the z axis like a spiral staircase and faces up everywhere.
inline Shape ramp(int steps, double turns, double inner, double outer, double pitch) {
  Shape shape;
  for (int i = 0; i <= steps; ++i) {
    const double turn = turns * i / steps, angle = 2 * std::numbers::pi * turn;
    for (int j = 0; j < 3; ++j) {
      const double r = inner + (outer - inner) * j / 2;
      shape.positions.emplace_back(r * std::cos(angle), r * std::sin(angle), pitch * turn);
    }
  }
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < 2; ++j) {
      const int a = 3 * i + j;
      shape.triangles.push_back(corners(a, a + 1, a + 4));
      shape.triangles.push_back(corners(a, a + 4, a + 3));
    }
  return shape;
}

// An open sheet in the plane z = 0 that faces up, over the square from (-1, -1) to (1, 1): `cells` by `cells`
// squares.
inline Shape sheet(int cells) {
  Shape shape;
  for (int y = 0; y <= cells; ++y)
    for (int x = 0; x <= cells; ++x)
      shape.positions.emplace_back(2.0 * x / cells - 1, 2.0 * y / cells - 1, 0);
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      const int a = y * (cells + 1) + x, b = a + 1, c = a + cells + 1, d = c + 1;
      shape.triangles.push_back(corners(a, b, d));
      shape.triangles.push_back(corners(a, d, c));
    }
  return shape;
}

// A box of twelve triangles.
inline Shape box(const Vec3& low = {0, 0, 0}, const Vec3& high = {1, 1, 1}) {
  Shape shape;
  for (int i = 0; i < 8; ++i)
    shape.positions.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                                 i & 4 ? high.z() : low.z());
  constexpr int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                               {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quads) {
    shape.triangles.push_back(corners(q[0], q[1], q[2]));
    shape.triangles.push_back(corners(q[0], q[2], q[3]));
  }
  return shape;
}

inline Shape moved(Shape shape, const Vec3& by, double scale = 1) {
  for (Vec3& p : shape.positions) p = scale * p + by;
  return shape;
}

// Both surfaces in one list. They share no vertex.
inline Shape together(Shape first, const Shape& second) {
  const auto shift = static_cast<int>(first.positions.size());
  first.positions.insert(first.positions.end(), second.positions.begin(), second.positions.end());
  for (const Triangle& c : second.triangles)
    first.triangles.push_back(corners(static_cast<int>(c[0]) + shift, static_cast<int>(c[1]) + shift,
                                      static_cast<int>(c[2]) + shift));
  return first;
}

// Returns six times the enclosed volume, which is positive if the surface faces outward.
inline double six_volumes(const Shape& shape) {
  double sum = 0;
  for (const Triangle& c : shape.triangles)
    sum += shape.positions[+c[0]].dot(shape.positions[+c[1]].cross(shape.positions[+c[2]]));
  return sum;
}

// A skeleton of `count` bones in one chain along the straight line from `head` to `tail`.
inline Rig straight_chain(int count, const Vec3& head, const Vec3& tail) {
  Rig rig;
  for (int i = 0; i < count; ++i) {
    rig.parent.push_back(BoneId{i - 1});
    rig.reference.push_back({head + (tail - head) * i / count, head + (tail - head) * (i + 1) / count});
  }
  return rig;
}

}  // namespace cscd::test
