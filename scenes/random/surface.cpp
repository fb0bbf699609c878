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

void append_box(Surface& surface, const Vec3& low, const Vec3& high) {
  constexpr std::size_t kQuads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  const std::size_t first = surface.positions.size();
  for (unsigned corner = 0; corner < 8; ++corner)
    surface.positions.emplace_back(corner & 1 ? high.x() : low.x(), corner & 2 ? high.y() : low.y(),
                                   corner & 4 ? high.z() : low.z());
  for (const auto& [a, b, c, d] : kQuads) {
    surface.triangles.push_back(triangle(first + a, first + b, first + c));
    surface.triangles.push_back(triangle(first + a, first + c, first + d));
  }
}

void append_sheet(Surface& surface, int along, int across, double length, double width) {
  const std::size_t first = surface.positions.size();
  const auto rows = static_cast<std::size_t>(along), columns = static_cast<std::size_t>(across);
  for (std::size_t i = 0; i <= rows; ++i)
    for (std::size_t j = 0; j <= columns; ++j)
      surface.positions.emplace_back(0, width * (static_cast<double>(j) / static_cast<double>(columns) - 0.5),
                                     length * (static_cast<double>(i) / static_cast<double>(rows) - 0.5));
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) {
      const std::size_t a = first + i * (columns + 1) + j, b = a + 1, c = a + columns + 1, d = c + 1;
      surface.triangles.push_back(triangle(a, b, d));
      surface.triangles.push_back(triangle(a, d, c));
    }
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

void append_hooked_finger(Surface& surface) {
  const std::size_t first = surface.positions.size();
  std::vector<Vec3>& x = surface.positions;
  const Vec3 tip(1, 0, 1.2), section[3] = {{-1, -0.97, -1.467}, {-1, 1.09, -1.467}, {-0.71, -0.6, 1.4}};
  x.push_back(tip);
  x.insert(x.end(), section, section + 3);
  const auto turned = [](const Vec3& p, double angle, double shift) -> Vec3 {
    constexpr double kX = -1, kZ = 3.5;  // the bends' axis
    const double u = p.x() - kX, w = p.z() - kZ, c = std::cos(angle), s = std::sin(angle);
    return {kX + shift + c * u + s * w, p.y(), kZ - s * u + c * w};
  };
  for (int bend = 0; bend < 2; ++bend)
    for (int step = bend == 0 ? 1 : 0; step <= 4; ++step)
      for (const Vec3& p : section)
        x.push_back(turned(p, (bend + step / 4.0) * std::numbers::pi, bend == 0 ? 0 : 4));
  const Vec3 way = kFingerPoke.normalized(), up(-way.z(), 0, way.x());
  for (const Vec3& p : {Vec3(0, -0.09, -0.06), Vec3(0, 0.09, -0.06), Vec3(0, 0, 0.1)})
    x.push_back(tip + 0.968 * kFingerPoke + p.y() * Vec3::UnitY() + p.z() * up);

  const std::size_t sections = (x.size() - first - 1) / 3;
  const auto at = [&](std::size_t k, std::size_t i) { return first + 1 + 3 * k + i % 3; };
  for (std::size_t i = 0; i < 3; ++i) {
    surface.triangles.push_back(triangle(at(0, i), at(0, i + 1), first));
    for (std::size_t k = 0; k + 1 < sections; ++k) {
      surface.triangles.push_back(triangle(at(k, i), at(k + 1, i + 1), at(k, i + 1)));
      surface.triangles.push_back(triangle(at(k, i), at(k + 1, i), at(k + 1, i + 1)));
    }
  }
  surface.triangles.push_back(triangle(at(sections - 1, 0), at(sections - 1, 2), at(sections - 1, 1)));
}

}  // namespace cscd::scenes
