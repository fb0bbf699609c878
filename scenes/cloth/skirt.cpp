#include "scenes/cloth/skirt.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "scenes/shape/circle.h"
#include "scenes/shape/limbed_sphere.h"

namespace cscd::scenes {
namespace {

struct Vec2 {
  double x, y;
};
double cross(const Vec2& a, const Vec2& b) {
  return a.x * b.y - a.y * b.x;
}
// `a` turned by the angle of the unit vector `turn`.
Vec2 turned(const Vec2& a, const Vec2& turn) {
  return {a.x * turn.x - a.y * turn.y, a.x * turn.y + a.y * turn.x};
}

// A pyramid of many narrow facets that stands for an elliptic cone. Between two neighbouring rays from the
// apex it is flat, so it unrolls into the plane and keeps all lengths.
class UnrolledCone {
 public:
  // The cone unrolls into an angle of `sixths` sixths of a turn. Its half-width is found by bisection,
  // because the unrolled angle grows with it.
  UnrolledCone(int sixths, double aspect) {
    double narrow = 0, wide = 1e3;
    for (int i = 0; i < 100; ++i) {
      const double width = (narrow + wide) / 2;
      place_rays(width, aspect);
      (unrolled_angle() < sixths * std::numbers::pi / 3 ? narrow : wide) = width;
    }
    flat_.push_back({1, 0});
    for (std::size_t i = 0; i < kFacets; ++i) {
      const double chord = (rays_[i + 1] - rays_[i]).norm(), cosine = 1 - chord * chord / 2;
      flat_.push_back(turned(flat_.back(), {cosine, std::sqrt(1 - cosine * cosine)}));
    }
  }

  // Rolls one ring up. Points must come in the order of their angles; the first has angle 0.
  class Ring {
   public:
    explicit Ring(const UnrolledCone& cone) : cone_(cone) {}
    Vec3 next(const Vec2& point) {
      const std::vector<Vec2>& flat = cone_.flat_;
      while (facet_ + 1 < kFacets && cross(flat[facet_ + 1], point) >= 0) ++facet_;
      const Vec2 &low = flat[facet_], &high = flat[facet_ + 1];
      const double area = cross(low, high);
      return cross(point, high) / area * cone_.rays_[facet_] +
             cross(low, point) / area * cone_.rays_[facet_ + 1];
    }

   private:
    const UnrolledCone& cone_;
    std::size_t facet_ = 0;
  };

 private:
  static constexpr std::size_t kFacets = 720;

  void place_rays(double width, double aspect) {
    rays_.clear();
    for (std::size_t i = 0; i <= kFacets; ++i) {
      const CirclePoint at = circle_point(static_cast<double>(i % kFacets) / kFacets);
      const Vec3 ray(width * at.sine, -width * aspect * at.cosine, -1);
      rays_.push_back(ray / ray.norm());
    }
  }
  // The sum of the facets' angles, by three terms of the series of the arc sine. Facets are so narrow that
  // the other terms are below 1e-9.
  double unrolled_angle() const {
    double sum = 0;
    for (std::size_t i = 0; i < kFacets; ++i) {
      const double half = (rays_[i + 1] - rays_[i]).norm() / 2, square = half * half;
      sum += 2 * half * (1 + square * (1.0 / 6 + square * (3.0 / 40)));
    }
    return sum;
  }

  std::vector<Vec3> rays_;  // [kFacets + 1], of length 1
  std::vector<Vec2> flat_;  // [kFacets + 1]: the rays, unrolled
};

JointWeights weights_of_nearest(const Vec3& point, std::span<const Vec3> positions,
                                std::span<const JointWeights> weights) {
  const auto distance = [&](const Vec3& position) { return (position - point).squaredNorm(); };
  return weights[static_cast<std::size_t>(std::ranges::min_element(positions, {}, distance) -
                                          positions.begin())];
}

}  // namespace

void add_skirt(const SkirtParameters& p, Shape& body, const std::string& where) {
  if (p.points < 1 || p.points > 5 || !(p.edge > 0) || !(p.aspect > 0))
    throw InputError(where + ": needs 1 to 5 points, a positive edge and a positive aspect");
  if (p.first_row < 2 || p.last_row <= p.first_row || p.last_row > 3000)
    throw InputError(where + ": parameter last_row must be larger than first_row and at most 3000, and " +
                     "first_row at least 2");
  if (p.band_rows < 1 || p.band_rows > p.last_row - p.first_row)
    throw InputError(where + ": parameter band_rows must be at least 1 and leave a row to the cloth");
  const UnrolledCone cone(p.points, p.aspect);
  const std::size_t body_vertices = body.positions.size();
  constexpr Vec2 sixth{0.5, 0.86602540378443865};  // the cosine and the sine of 60 degrees

  std::vector<int> first;  // first vertex of each ring
  for (int row = p.first_row; row <= p.last_row; ++row) {
    first.push_back(static_cast<int>(body.positions.size()));
    UnrolledCone::Ring ring(cone);
    Vec2 corner{p.edge, 0};
    for (int point = 0; point < p.points; ++point) {
      const Vec2 next = turned(corner, sixth);
      for (int i = 0; i < row; ++i) {
        const double a = row - i, b = i;
        body.positions.push_back(p.apex + ring.next({a * corner.x + b * next.x, a * corner.y + b * next.y}));
        const bool in_band = row < p.first_row + p.band_rows;
        body.weights.push_back(in_band ? weights_of_nearest(body.positions.back(),
                                                            std::span(body.positions).first(body_vertices),
                                                            body.weights)
                                       : JointWeights{});
      }
      corner = next;
    }
  }
  for (int row = p.first_row; row < p.last_row; ++row) {
    const int above = first[static_cast<std::size_t>(row - p.first_row)];
    const int below = first[static_cast<std::size_t>(row - p.first_row) + 1];
    const auto upper = [&](int point, int i) {
      return VertexId{above + (point * row + i) % (p.points * row)};
    };
    const auto lower = [&](int point, int i) {
      return VertexId{below + (point * (row + 1) + i) % (p.points * (row + 1))};
    };
    for (int point = 0; point < p.points; ++point)
      for (int i = 0; i <= row; ++i) {
        body.triangles.push_back({lower(point, i), lower(point, i + 1), upper(point, i)});
        if (i < row) body.triangles.push_back({upper(point, i + 1), upper(point, i), lower(point, i + 1)});
      }
  }
}

ShapeRow skirted_limbed_sphere_row() {
  static const ParameterRow skirt_rows[] = {
      integer_row("points", "", "points of the hem; the cone unrolls into so many sixths of a disc", {1, 5}),
      number_row("aspect", "", "extent along y as a share of that along x", {1e-3, 1e3}),
      number_row("edge", "length", "length of an edge", {1e-9, 1e9}),
      integer_row("first_row", "", "row at the waist, counted from the apex", {2, 3000}),
      integer_row("last_row", "", "row at the hem", {3, 3000}),
      integer_row("band_rows", "", "rows at the waist that the body's bones carry", {1, 3000}),
      vector_row("apex", "length", "apex of the cone"),
  };
  static const std::vector<ParameterRow> rows = [] {
    const std::span<const ParameterRow> body = limbed_sphere_row().parameters;
    std::vector<ParameterRow> all(body.begin(), body.end());
    all.push_back(objects_row("skirts", "one object for each skirt", skirt_rows));
    return all;
  }();
  ShapeRow row = limbed_sphere_row();
  row.name = "skirted_limbed_sphere";
  row.description = "limbed_sphere that wears skirts, which are cloth without bones";
  row.parameters = rows;
  row.make = [](const Parameters& parameters) {
    Shape shape = limbed_sphere_row().make(parameters);
    for (const Parameters& skirt : parameters.objects("skirts")) {
      add_skirt(
          {skirt.integer("points"), skirt.number("aspect"), skirt.number("edge"), skirt.integer("first_row"),
           skirt.integer("last_row"), skirt.integer("band_rows"), skirt.vector("apex")},
          shape, skirt.where());
    }
    return shape;
  };
  row.at_resolution = [](const Parameters& parameters, double factor) {
    std::vector<Parameters> skirts;
    for (const Parameters& skirt : parameters.objects("skirts")) {
      const double first = scaled_count(skirt.integer("first_row"), factor, 2);
      skirts.push_back(
          skirt.with("edge", skirt.number("edge") / factor)
              .with("first_row", first)
              .with("last_row", std::max(first + 1, scaled_count(skirt.integer("last_row"), factor, 3))));
    }
    return limbed_sphere_row().at_resolution(parameters, factor).with("skirts", std::move(skirts));
  };
  return row;
}

}  // namespace cscd::scenes
