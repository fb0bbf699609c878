#include "scenes/shape/tube.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "scenes/shape/circle.h"

namespace cscd::scenes {
namespace {

// A point of the profile: distance along the axis from the first pole, distance from the axis.
struct ProfilePoint {
  double along, out;
};

ProfilePoint profile_at(double arc, double radius, double length) {
  const double cap = std::numbers::pi / 2 * radius;
  const double straight = length - 2 * radius;
  if (arc < cap) {
    const CirclePoint point = circle_point(arc / cap / 4);
    return {radius * (1 - point.cosine), radius * point.sine};
  }
  if (arc <= cap + straight) return {radius + (arc - cap), radius};
  const CirclePoint point = circle_point((2 * cap + straight - arc) / cap / 4);
  return {length - radius * (1 - point.cosine), radius * point.sine};
}

// Quadratic B-spline weights at `place`, measured in bones from the head of the first. What the spline gives
// to bones beyond the ends goes to the end bones.
JointWeights spline_weights(double place, int bones) {
  const int centre = std::clamp(static_cast<int>(std::floor(place)), 0, bones - 1);
  const double t = std::clamp(place - centre, 0.0, 1.0);
  const double share[3] = {(1 - t) * (1 - t) / 2, 0.75 - (t - 0.5) * (t - 0.5), t * t / 2};
  JointWeights weights;
  std::size_t used = 0;
  for (int k = -1; k <= 1; ++k) {
    const BoneId bone{std::clamp(centre + k, 0, bones - 1)};
    const double amount = share[k + 1];
    if (amount == 0) continue;
    if (used > 0 && weights.bone[used - 1] == bone) {
      weights.weight[used - 1] += amount;
    } else {
      weights.bone[used] = bone;
      weights.weight[used++] = amount;
    }
  }
  return weights;
}

// Two unit vectors that make a right-handed frame with the axis.
std::array<Vec3, 2> across(const Vec3& axis) {
  int least = 0;
  axis.cwiseAbs().minCoeff(&least);
  const Vec3 first = axis.cross(Vec3::Unit(least)).normalized();
  return {first, axis.cross(first)};
}

}  // namespace

Shape tube(const TubeParameters& p) {
  if (p.rings < 2 || p.sides < 3 || p.bones < 1 || !(p.radius > 0) || !(p.length > 2 * p.radius) ||
      !(p.direction.norm() > 0))
    throw InputError("tube: needs at least 2 rings, 3 sides and 1 bone, and a length above two radii");
  if (static_cast<double>(p.rings) * p.sides > 1 << 27)
    throw InputError("tube: more than 2^27 vertices; lower rings or sides");
  const Vec3 axis = p.direction.normalized();
  const auto [u, v] = across(axis);
  const double profile = p.length - 2 * p.radius + std::numbers::pi * p.radius;
  const double bone_length = (p.length - 2 * p.radius) / p.bones;

  Shape shape;
  const auto vertices = static_cast<std::size_t>(p.rings) * static_cast<std::size_t>(p.sides) + 2;
  shape.positions.reserve(vertices);
  shape.weights.reserve(vertices);
  shape.triangles.reserve(2 * (vertices - 2));
  const auto add_vertex = [&](double along, const Vec3& out) {
    shape.positions.push_back(p.start + along * axis + out);
    shape.weights.push_back(spline_weights((along - p.radius) / bone_length, p.bones));
  };
  for (int ring = 0; ring < p.rings; ++ring) {
    const ProfilePoint point = profile_at(profile * (ring + 1) / (p.rings + 1), p.radius, p.length);
    for (int side = 0; side < p.sides; ++side) {
      const CirclePoint turn = circle_point(static_cast<double>(side) / p.sides);
      add_vertex(point.along, point.out * (turn.cosine * u + turn.sine * v));
    }
  }
  add_vertex(0, Vec3::Zero());
  add_vertex(p.length, Vec3::Zero());

  const auto at = [&](int ring, int side) { return VertexId{ring * p.sides + side % p.sides}; };
  const VertexId first_pole{p.rings * p.sides}, last_pole{p.rings * p.sides + 1};
  for (int side = 0; side < p.sides; ++side) {
    shape.triangles.push_back({first_pole, at(0, side + 1), at(0, side)});
    shape.triangles.push_back({last_pole, at(p.rings - 1, side), at(p.rings - 1, side + 1)});
  }
  for (int ring = 0; ring + 1 < p.rings; ++ring)
    for (int side = 0; side < p.sides; ++side) {
      const VertexId a = at(ring, side), b = at(ring, side + 1), c = at(ring + 1, side + 1),
                     d = at(ring + 1, side);
      shape.triangles.push_back({a, b, c});
      shape.triangles.push_back({a, c, d});
    }

  for (int bone = 0; bone < p.bones; ++bone) {
    shape.rig.parent.push_back(BoneId{bone - 1});
    shape.rig.reference.push_back({p.start + (p.radius + bone * bone_length) * axis,
                                   p.start + (p.radius + (bone + 1) * bone_length) * axis});
  }
  return shape;
}

ShapeRow tube_row() {
  static const ParameterRow rows[] = {
      {"rings", ParameterKind::integer, "rings of vertices between the poles", true, 2, 1e6},
      {"sides", ParameterKind::integer, "vertices of a ring", true, 3, 1e5},
      {"bones", ParameterKind::integer, "bones of the chain on the axis", true, 1, 1e5},
      {"radius", ParameterKind::number, "radius of the tube", true, 1e-9, 1e9},
      {"length", ParameterKind::number, "from pole to pole, above two radii", true, 1e-9, 1e12},
      {"start", ParameterKind::vector, "the first pole", false},
      {"direction", ParameterKind::vector, "from the first pole to the last", false},
  };
  return {"tube", "straight tube with rounded ends on a chain of bones", rows,
          [](const Parameters& parameters) {
            TubeParameters p;
            p.rings = parameters.integer("rings");
            p.sides = parameters.integer("sides");
            p.bones = parameters.integer("bones");
            p.radius = parameters.number("radius");
            p.length = parameters.number("length");
            p.start = parameters.vector("start", p.start);
            p.direction = parameters.vector("direction", p.direction);
            return tube(p);
          }};
}

}  // namespace cscd::scenes
