#include "scenes/random/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace cscd::scenes {
namespace {

Triangle triangle(std::size_t a, std::size_t b, std::size_t c) {
  const auto id = [](std::size_t i) { return VertexId{static_cast<std::int32_t>(i)}; };
  return {id(a), id(b), id(c)};
}

}  // namespace

void append_sphere(Surface& surface, int splits, double radius, const Vec3& centre) {
  std::vector<Vec3> directions = {Vec3::UnitX(),  -Vec3::UnitX(), Vec3::UnitY(),
                                  -Vec3::UnitY(), Vec3::UnitZ(),  -Vec3::UnitZ()};
  std::vector<std::array<std::size_t, 3>> faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                                   {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int split = 0; split < splits; ++split) {
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> middles;
    const auto middle = [&](std::size_t a, std::size_t b) {
      const auto [place, fresh] = middles.try_emplace(std::minmax(a, b), directions.size());
      if (fresh) directions.push_back((directions[a] + directions[b]).normalized());
      return place->second;
    };
    std::vector<std::array<std::size_t, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const std::size_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  const std::size_t first = surface.positions.size();
  for (const Vec3& direction : directions) surface.positions.push_back(centre + radius * direction);
  for (const auto& [a, b, c] : faces) surface.triangles.push_back(triangle(first + a, first + b, first + c));
}

void append_tube(Surface& surface, const Tube& tube) {
  const std::size_t first = surface.positions.size();
  const auto rings = static_cast<std::size_t>(tube.rings), sides = static_cast<std::size_t>(tube.sides);
  for (std::size_t ring = 0; ring < rings; ++ring) {
    const double s = (static_cast<double>(ring) + 0.5) / static_cast<double>(rings);
    const double place = s * static_cast<double>(tube.radii.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), tube.radii.size() - 2);
    const double radius =
        std::lerp(tube.radii[below], tube.radii[below + 1], place - static_cast<double>(below));
    for (std::size_t side = 0; side < sides; ++side) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(side) / static_cast<double>(sides);
      surface.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                     (s - 0.5) * tube.length);
    }
  }
  const std::size_t bottom = surface.positions.size(), top = bottom + 1;
  surface.positions.emplace_back(0, 0, -tube.length / 2);
  surface.positions.emplace_back(0, 0, tube.length / 2);
  const auto at = [&](std::size_t ring, std::size_t side) { return first + ring * sides + side % sides; };
  for (std::size_t side = 0; side < sides; ++side) {
    surface.triangles.push_back(triangle(bottom, at(0, side + 1), at(0, side)));
    for (std::size_t ring = 0; ring + 1 < rings; ++ring) {
      surface.triangles.push_back(triangle(at(ring, side), at(ring, side + 1), at(ring + 1, side)));
      surface.triangles.push_back(triangle(at(ring, side + 1), at(ring + 1, side + 1), at(ring + 1, side)));
    }
    surface.triangles.push_back(triangle(top, at(rings - 1, side), at(rings - 1, side + 1)));
  }
}

}  // namespace cscd::scenes
