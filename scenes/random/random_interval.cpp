#include "scenes/random/random_interval.h"

#include <array>
#include <cmath>
#include <numbers>

#include "scenes/random/surface.h"

namespace cscd::scenes {
namespace {

// How space is bent and moved at one end of the interval; applied to the surface and to the bones alike.
struct Warp {
  double bend = 0;    // radians per unit of z: wraps z onto a circle
  double spiral = 0;  // by how much that circle tightens, per unit of z
  double pitch = 0;   // sideways rise along the circle, per unit of z
  double twist = 0;   // radians per unit of z about the z axis
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
  Vec3 shift = Vec3::Zero();

  Vec3 operator()(const Vec3& p) const {
    const double c = std::cos(twist * p.z()), s = std::sin(twist * p.z());
    Vec3 q(c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z());
    const double rate = bend + spiral * p.z();
    if (std::abs(rate) > 1e-6) {
      const double angle = rate * p.z(), radius = 1 / rate;
      q = {radius - (radius - q.x()) * std::cos(angle), q.y() + pitch * p.z(),
           (radius - q.x()) * std::sin(angle)};
    }
    return linear * q + shift;
  }
};

struct Build {
  Surface surface;
  std::vector<BoneId> parent;
  std::vector<Bone> bones;
  Warp start, end;
  double noise = 0;  // of every vertex at the end, in units of space

  // A chain of bones along z inside a tube, or one bone where that is all there is room for.
  void add_chain(int count, double length, const Vec3& centre = Vec3::Zero()) {
    for (int i = 0; i < count; ++i) {
      const auto z = [&](int k) { return (static_cast<double>(k) / count - 0.5) * 0.9 * length; };
      parent.push_back(BoneId{i == 0 ? -1 : static_cast<int>(parent.size()) - 1});
      bones.push_back({centre + Vec3(0, 0, z(i)), centre + Vec3(0, 0, z(i + 1))});
    }
  }
};

Tube random_tube(Random& random, double length) {
  Tube tube{random.integer(6, 12), random.integer(3, 7), length, {}};
  for (int i = random.integer(2, 5); i > 0; --i) tube.radii.push_back(random.uniform(0.25, 0.7));
  return tube;
}

Build noisy_ball(Random& random) {
  Build build;
  append_sphere(build.surface, 2, 1, Vec3::Zero());
  build.add_chain(random.integer(1, 3), 1);
  build.noise = random.uniform(0.05, 0.6);
  build.end.linear.diagonal() =
      Vec3(random.uniform(0.2, 1.5), random.uniform(0.2, 1.5), random.uniform(0.2, 1.5));
  return build;
}

Build folding_tube(Random& random) {
  Build build;
  const double length = random.uniform(4, 8);
  append_tube(build.surface, random_tube(random, length));
  build.add_chain(random.integer(1, 5), length);
  const double circle = 2 * std::numbers::pi / length;
  build.start.bend = random.uniform(0, 0.75) * circle;
  build.end.bend = random.uniform(0.7, 1.3) * circle;
  build.end.twist = random.uniform(-0.4, 0.4);
  build.noise = random.uniform(0, 0.1);
  return build;
}

Build tightening_spiral(Random& random) {
  Build build;
  const double length = random.uniform(9, 14);
  Tube tube = random_tube(random, length);
  tube.rings = random.integer(14, 20);
  tube.sides = 4;
  for (double& radius : tube.radii) radius *= 0.6;
  append_tube(build.surface, tube);
  build.add_chain(random.integer(3, 6), length);
  const double circle = 2 * std::numbers::pi / length;
  build.start = {.bend = random.uniform(1.2, 1.8) * circle, .pitch = random.uniform(0.25, 0.4)};
  build.end = {.bend = random.uniform(1.4, 2.2) * circle,
               .spiral = random.uniform(-0.02, 0.02),
               .pitch = random.uniform(-0.1, 0.2)};
  build.noise = random.uniform(0, 0.05);
  return build;
}

// One long bone through a bumpy tube: the case for segment observers, and for looking at all three vertices.
Build bumpy_segment(Random& random) {
  Build build;
  const double length = random.uniform(3, 6);
  Tube tube = random_tube(random, length);
  tube.radii = {0.1, random.uniform(0.3, 1), random.uniform(0.1, 0.4), random.uniform(0.3, 1), 0.1};
  append_tube(build.surface, tube);
  build.add_chain(1, length);
  build.end.linear.diagonal() = Vec3(random.uniform(-0.2, 1), random.uniform(0.3, 1), random.uniform(0.1, 1));
  build.end.bend = random.uniform(0, 1) * 2 * std::numbers::pi / length;
  build.noise = random.uniform(0, 0.5);
  return build;
}

Build several_components(Random& random) {
  Build build;
  const int count = random.integer(2, 4);
  for (int i = 0; i < count; ++i) {
    const Vec3 centre(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 2.3 * i);
    append_sphere(build.surface, random.integer(0, 1), random.uniform(0.6, 1), centre);
    build.add_chain(random.integer(1, 2), 1, centre);
  }
  build.end.linear(2, 2) = random.uniform(0.4, 1.1);
  build.end.bend = random.uniform(0, 0.5);
  build.noise = random.uniform(0, 0.4);
  return build;
}

Build nested_components(Random& random) {
  Build build;
  append_sphere(build.surface, 1, 2, Vec3::Zero());
  append_sphere(build.surface, random.integer(0, 1), random.uniform(0.3, 0.8), random.in_box(0.3));
  build.add_chain(random.integer(1, 2), 2);
  build.noise = random.uniform(0.2, 1.2);
  return build;
}

// A flat slab that closes like a book.
Build closing_fold(Random& random) {
  Build build;
  Tube tube{random.integer(8, 14), 4, 6, {1, 1}};
  append_tube(build.surface, tube);
  for (Vec3& p : build.surface.positions) p.x() *= random.uniform(0.1, 0.12);
  build.add_chain(random.integer(2, 4), 6);
  build.start.bend = random.uniform(0.2, 0.6);
  build.end.bend = random.uniform(0.8, 1.4);
  build.end.pitch = random.uniform(-0.1, 0.1);
  build.noise = random.uniform(0, 0.2);
  return build;
}

struct Family {
  std::string_view name;
  Build (*make)(Random&);
};
constexpr std::array kFamilies = {
    Family{"noisy_ball", noisy_ball},
    Family{"folding_tube", folding_tube},
    Family{"tightening_spiral", tightening_spiral},
    Family{"bumpy_segment", bumpy_segment},
    Family{"several_components", several_components},
    Family{"nested_components", nested_components},
    Family{"closing_fold", closing_fold},
};

constexpr auto kNames = [] {
  std::array<std::string_view, kFamilies.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kFamilies[i].name;
  return names;
}();

// Where the whole interval happens: near or far, tiny or huge, resting or rushing by.
struct Place {
  double scale = 1;
  Vec3 offset = Vec3::Zero(), rush = Vec3::Zero();
};
Place random_place(Random& random) {
  Place place;
  switch (random.integer(0, 4)) {
    case 0:
      place.offset = random.in_box(std::pow(10, random.integer(2, 7)));
      break;
    case 1:
      place.scale = std::pow(10, random.integer(-9, -3));
      break;
    case 2:
      place.scale = std::pow(10, random.integer(3, 9));
      break;
    case 3:
      place.rush = random.in_box(std::pow(10, random.integer(1, 5)));
      break;
    default:
      break;
  }
  return place;
}

}  // namespace

std::span<const std::string_view> random_families() {
  return kNames;
}

RandomInterval make_random_interval(std::uint64_t seed) {
  Random random(seed * 0x9e3779b97f4a7c15u + 1);
  const Family& family = kFamilies[seed % kFamilies.size()];
  Build build = family.make(random);
  const Place place = random_place(random);
  build.end.shift += random.in_box(0.3);

  ClipHeader header{build.surface.triangles, build.surface.positions.size(), build.parent, false};
  Clip clip(std::move(header));
  for (const bool at_end : {false, true}) {
    const Warp& warp = at_end ? build.end : build.start;
    const auto put = [&](const Vec3& p) -> Vec3 {
      return place.scale * (warp(p) + (at_end ? place.rush : Vec3::Zero())) + place.offset;
    };
    std::vector<Vec3> positions;
    for (const Vec3& p : build.surface.positions) {
      const Vec3 noise = random.in_box(at_end ? build.noise : 0.02);
      positions.push_back(put(p) + place.scale * noise);
    }
    std::vector<Bone> bones;
    for (const Bone& bone : build.bones) bones.push_back({put(bone.head), put(bone.tail)});
    clip.append({positions, bones});
  }
  return {family.name, std::move(clip)};
}

}  // namespace cscd::scenes
