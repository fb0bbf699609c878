#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>

// The cases of nearest features. Two closed features are nearest in points of their least features: a vertex
// and the inside of a face, the insides of two edges, a vertex and the inside of an edge, or two vertices.
// Each case is given by numbers whose signs decide it. The formulas are written once for all kinds of
// numbers: polynomials in t (closeness.cpp), and enclosures at a time (certified/close_enclosures.h).
namespace cscd::exact {

template <class Number>
using PointOf = std::array<Number, 3>;

template <class Number>
using PointList = std::initializer_list<PointOf<Number>>;

template <class Number>
struct CloseCase {
  // The squared distance of the point, line or plane that one least feature spans from that of the other,
  // minus r^2, times `whole`.
  Number beyond;
  // Zero if a least feature is an edge without length or a face without area, so that lower cases decide.
  // Above zero otherwise. Not given for two vertices.
  Number whole;
  // The nearest points lie inside the least features exactly if none of these is negative.
  std::array<Number, 4> inside;
  std::size_t insides;
  // If `whole` and all of `inside` are above zero and all of these are below zero, then the two least
  // features are the nearest ones, so the distance is theirs.
  std::array<Number, 2> elsewhere;
  std::size_t elsewheres;
};

template <class Number>
PointOf<Number> operator-(const PointOf<Number>& a, const PointOf<Number>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class Number>
Number dot(const PointOf<Number>& u, const PointOf<Number>& w) {
  return u[0] * w[0] + u[1] * w[1] + u[2] * w[2];
}
template <class Number>
PointOf<Number> cross(const PointOf<Number>& u, const PointOf<Number>& w) {
  return {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
}

// A vertex v and the inside of the face a, b, c.
template <class Number>
CloseCase<Number> vertex_to_face(const PointOf<Number>& v, const PointOf<Number>& a, const PointOf<Number>& b,
                                 const PointOf<Number>& c, const Number& r_squared) {
  const PointOf<Number> n = cross(b - a, c - a), va = a - v, vb = b - v, vc = c - v;
  const Number height = dot(n, va), area = dot(n, n);
  return {height * height - r_squared * area,
          area,
          {dot(n, cross(vb, vc)), dot(n, cross(vc, va)), dot(n, cross(va, vb))},
          3,
          {},
          0};
}

// The insides of the edges a, b and c, d.
template <class Number>
CloseCase<Number> edge_to_edge(const PointOf<Number>& a, const PointOf<Number>& b, const PointOf<Number>& c,
                               const PointOf<Number>& d, const Number& r_squared) {
  const PointOf<Number> u = b - a, w = d - c, ac = c - a, n = cross(u, w);
  const Number height = dot(n, ac), area = dot(n, n);
  // The nearest points of the lines are a + s u and c + q w. These are s and q times the area.
  const Number s = dot(cross(ac, w), n), q = dot(cross(ac, u), n);
  return {height * height - r_squared * area, area, {s, area - s, q, area - q}, 4, {}, 0};
}

// A vertex p and the inside of the edge a, b. The points in `beside` are the others of the edge's feature,
// and those in `behind` are the others of the vertex's feature.
template <class Number>
CloseCase<Number> vertex_to_edge(const PointOf<Number>& p, const PointOf<Number>& a, const PointOf<Number>& b,
                                 const Number& r_squared, PointList<Number> beside,
                                 PointList<Number> behind) {
  const PointOf<Number> u = b - a, w = p - a, sweep = cross(w, u);
  const Number length = dot(u, u), along = dot(w, u);
  // The way from the edge to the vertex, times `length`.
  const PointOf<Number> way = cross(u, sweep);
  CloseCase<Number> result{dot(sweep, sweep) - r_squared * length, length, {along, length - along}, 2, {}, 0};
  for (const PointOf<Number>& x : beside) result.elsewhere[result.elsewheres++] = dot(x - a, way);
  for (const PointOf<Number>& x : behind) result.elsewhere[result.elsewheres++] = dot(p - x, way);
  return result;
}

// The vertices p and q. The points in `beside` are the others of q's feature, and those in `behind` of p's.
template <class Number>
CloseCase<Number> vertex_to_vertex(const PointOf<Number>& p, const PointOf<Number>& q,
                                   const Number& r_squared, PointList<Number> beside,
                                   PointList<Number> behind) {
  const PointOf<Number> way = p - q;
  CloseCase<Number> result{dot(way, way) - r_squared, {}, {}, 0, {}, 0};
  for (const PointOf<Number>& x : beside) result.elsewhere[result.elsewheres++] = dot(x - q, way);
  for (const PointOf<Number>& x : behind) result.elsewhere[result.elsewheres++] = dot(p - x, way);
  return result;
}

// The cases of a vertex, points[0], and a face: its inside, its three edges, its three corners.
inline constexpr int kVertexFaceCases = 7;
template <class Number>
CloseCase<Number> vertex_face_case(int number, const std::array<PointOf<Number>, 4>& points,
                                   const Number& r_squared) {
  const auto corner = [&](int i) -> const PointOf<Number>& {
    return points[static_cast<std::size_t>(1 + i % 3)];
  };
  const int i = number - (number < 4 ? 1 : 4);
  if (number == 0) return vertex_to_face(points[0], corner(0), corner(1), corner(2), r_squared);
  if (number < 4)
    return vertex_to_edge<Number>(points[0], corner(i), corner(i + 1), r_squared, {corner(i + 2)}, {});
  return vertex_to_vertex<Number>(points[0], corner(i), r_squared, {corner(i + 1), corner(i + 2)}, {});
}

// The cases of two edges, points[0] to points[1] and points[2] to points[3]: their insides, each of the four
// points and the inside of the edge that it is no end of, and the four pairs of ends.
inline constexpr int kEdgeEdgeCases = 9;
template <class Number>
CloseCase<Number> edge_edge_case(int number, const std::array<PointOf<Number>, 4>& points,
                                 const Number& r_squared) {
  if (number == 0) return edge_to_edge(points[0], points[1], points[2], points[3], r_squared);
  if (number < 5) {
    const std::size_t i = static_cast<std::size_t>(number - 1), from = i < 2 ? 2 : 0;
    return vertex_to_edge<Number>(points[i], points[from], points[from + 1], r_squared, {}, {points[i ^ 1]});
  }
  const std::size_t i = number < 7 ? 0 : 1, j = number % 2 == 1 ? 2 : 3;
  return vertex_to_vertex<Number>(points[i], points[j], r_squared, {points[j ^ 1]}, {points[i ^ 1]});
}

}  // namespace cscd::exact
