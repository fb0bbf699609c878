#include "scenes/shape/tube.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "scenes/shape/bone_chain.h"
#include "scenes/shape/circle.h"

namespace cscd::scenes {
namespace {

// A point of the profile: its distance along the axis from the first pole, and its distance from the axis.
struct ProfilePoint {
  double along, out;
};

// The point at an arc length of the profile.
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

// The axis at one arc length, and the frame of the cross-section there.
struct Section {
  Vec3 centre, tangent, inwards, binormal;  // `inwards` points to the centre of the arc

  Vec3 at(double out, const CirclePoint& turn) const {
    return centre + out * (turn.cosine * inwards + turn.sine * binormal);
  }
};

class Axis {
 public:
  explicit Axis(const TubeParameters& p)
      : start_{p.start, p.direction.normalized(), across(p.direction.normalized(), p.arc_side), Vec3::Zero()},
        radius_(p.arc_radius),
        turns_(p.arc_turns),
        arc_(2 * std::numbers::pi * p.arc_turns * p.arc_radius),
        leg_((p.length - arc_) / 2) {
    start_.binormal = start_.tangent.cross(start_.inwards);
  }
  double leg() const { return leg_; }

  Section at(double along) const {
    if (arc_ == 0 || along <= leg_) return moved(start_, along);
    const double on_arc = std::min(along - leg_, arc_);
    const CirclePoint turn = circle_point(on_arc / arc_ * turns_);
    Section section = moved(start_, leg_);
    section.centre += radius_ * ((1 - turn.cosine) * start_.inwards + turn.sine * start_.tangent);
    section.tangent = turn.cosine * start_.tangent + turn.sine * start_.inwards;
    section.inwards = turn.cosine * start_.inwards - turn.sine * start_.tangent;
    return moved(section, std::max(0.0, along - leg_ - arc_));
  }

 private:
  static Section moved(Section section, double along) {
    section.centre += along * section.tangent;
    return section;
  }
  // The unit vector perpendicular to the axis that lies nearest to `side`, or any perpendicular unit vector
  // if `side` lies along the axis.
  static Vec3 across(const Vec3& axis, const Vec3& side) {
    const Vec3 part = side - side.dot(axis) * axis;
    if (part.norm() > 1e-9 * side.norm()) return part.normalized();
    int least = 0;
    axis.cwiseAbs().minCoeff(&least);
    return axis.cross(Vec3::Unit(least)).normalized();
  }

  Section start_;
  double radius_, turns_, arc_, leg_;
};

void check(const TubeParameters& p) {
  if (p.rings < 2 || p.sides < 3 || p.bones < 1 || !(p.radius > 0) || !(p.length > 2 * p.radius) ||
      !(p.direction.norm() > 0))
    throw InputError("tube: needs at least 2 rings, 3 sides and 1 bone, and a length above two radii");
  if (static_cast<double>(p.rings) * p.sides > 1 << 27)
    throw InputError("tube: more than 2^27 vertices; lower rings or sides");
  if (!(p.arc_turns >= 0) || p.arc_turns > 0.5 || (p.arc_turns > 0 && !(p.arc_radius > p.radius)))
    throw InputError("tube: the arc must turn by 0 to 0.5 turns, with a radius above the tube's");
}

}  // namespace

Shape tube(const TubeParameters& p) {
  check(p);
  const Axis axis(p);
  if (axis.leg() < p.radius) throw InputError("tube: the arc leaves no room for the caps; lengthen the tube");
  const double profile = p.length - 2 * p.radius + std::numbers::pi * p.radius;
  const double bone_length = (p.length - 2 * p.radius) / p.bones;

  Shape shape;
  const auto vertices = static_cast<std::size_t>(p.rings) * static_cast<std::size_t>(p.sides) + 2;
  shape.positions.reserve(vertices);
  shape.weights.reserve(vertices);
  shape.triangles.reserve(2 * (vertices - 2));
  const auto add_vertex = [&](double along, const Vec3& position) {
    shape.positions.push_back(position);
    shape.weights.push_back(spline_weights((along - p.radius) / bone_length, p.bones));
  };
  for (int ring = 0; ring < p.rings; ++ring) {
    const ProfilePoint point = profile_at(profile * (ring + 1) / (p.rings + 1), p.radius, p.length);
    const Section section = axis.at(point.along);
    for (int side = 0; side < p.sides; ++side)
      add_vertex(point.along, section.at(point.out, circle_point(static_cast<double>(side) / p.sides)));
  }
  add_vertex(0, axis.at(0).centre);
  add_vertex(p.length, axis.at(p.length).centre);

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

  std::vector<Vec3> joints;
  for (int i = 0; i <= p.bones; ++i) joints.push_back(axis.at(p.radius + i * bone_length).centre);
  append_chain(joints, shape);
  add_details(p.details, shape);
  return shape;
}

ShapeRow tube_row() {
  static const ParameterRow rows[] = {
      integer_row("rings", "", "rings of vertices between the poles", {2, 1e6}),
      integer_row("sides", "", "vertices of a ring", {3, 1e5}),
      integer_row("bones", "", "bones of the chain on the axis", {1, 1e5}),
      number_row("radius", "length", "radius of the tube", {1e-9, 1e9}),
      number_row("length", "length", "length from pole to pole, above two radii", {1e-9, 1e12}),
      vector_row("start", "length", "place of the first pole").or_else({0, 0, 0}),
      vector_row("direction", "", "direction in which the axis leaves the first pole").or_else({0, 0, 1}),
      number_row("arc_turns", "turn",
                 "how far the axis turns in its middle: 0 for a straight tube, 0.5 for a hairpin", {0, 0.5})
          .or_else({0}),
      number_row("arc_radius", "length", "radius of that arc, above the tube's radius where there is an arc",
                 {0, 1e12})
          .or_else({0}),
      vector_row("arc_side", "", "side to which the axis turns").or_else({1, 0, 0}),
      objects_row("details", "one object for each raised, dented or folded place", detail_rows()).optional(),
  };
  return {"tube", "tube with rounded ends on a chain of bones, straight or a hairpin", rows,
          [](const Parameters& parameters) {
            TubeParameters p;
            p.rings = parameters.integer("rings");
            p.sides = parameters.integer("sides");
            p.bones = parameters.integer("bones");
            p.radius = parameters.number("radius");
            p.length = parameters.number("length");
            p.start = parameters.vector("start");
            p.direction = parameters.vector("direction");
            p.arc_turns = parameters.number("arc_turns");
            p.arc_radius = parameters.number("arc_radius");
            p.arc_side = parameters.vector("arc_side");
            if (parameters.has("details")) p.details = read_details(parameters.objects("details"));
            return tube(p);
          },
          [](const Parameters& parameters, double factor) {
            return parameters.with("rings", scaled_count(parameters.integer("rings"), factor, 2))
                .with("sides", scaled_count(parameters.integer("sides"), factor, 3));
          }};
}

}  // namespace cscd::scenes
