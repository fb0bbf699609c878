#include "scenes/random/random_interval.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scenes/random/surface.h"

namespace cscd::scenes {
namespace {

// A map that bends and moves space at one end of the interval. The surface and the bones are mapped alike.
struct Warp {
  double bend = 0;    // radians per unit of z: wraps z onto a circle
  double spiral = 0;  // how much that circle tightens per unit of z
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

// An interval before its warps and its noise are applied.
struct Build {
  Surface surface;
  std::vector<Vec3> target;  // the vertices at the end, before the warp; empty if they stay
  std::vector<BoneId> parent;
  std::vector<Bone> bones;
  Warp start, end;
  double start_noise = 0.02, noise = 0;  // largest noise of a vertex at the start and at the end, as a length
  bool lattice = false;                  // coordinates are small integers that have to stay exact

  // Adds a chain of `count` bones along z over a length of 0.9 * length, round `centre`.
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
  append_sphere(build.surface, random.integer(1, 2), 1, Vec3::Zero());
  build.add_chain(random.integer(1, 3), 1);
  build.noise = random.uniform(0.05, 0.5);
  build.end.linear.diagonal() = random.between(Vec3::Constant(0.2), Vec3::Constant(1.5));
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
  build.noise = random.at_times(0, 0.1);
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

// One long bone goes through a bumpy tube. This is the case for segment observers, and for looking at all
// three vertices (rule three-vertices).
Build bumpy_segment(Random& random) {
  Build build;
  const double length = random.uniform(3, 6);
  Tube tube = random_tube(random, length);
  tube.radii = {0.1, random.uniform(0.3, 1), random.uniform(0.1, 0.4), random.uniform(0.3, 1), 0.1};
  append_tube(build.surface, tube);
  build.add_chain(1, length);
  build.end.linear.diagonal() = random.between({-0.2, 0.3, 0.1}, {1, 1, 1});
  build.end.bend = random.uniform(0, 1) * 2 * std::numbers::pi / length;
  build.noise = random.uniform(0, 0.5);
  return build;
}

Build several_components(Random& random) {
  Build build;
  const int count = random.integer(2, 4);
  for (int i = 0; i < count; ++i) {
    const double y = random.uniform(-0.2, 0.2), x = random.uniform(-0.2, 0.2),
                 radius = random.uniform(0.6, 1);
    const Vec3 centre(x, y, 2.3 * i);
    append_sphere(build.surface, random.integer(0, 1), radius, centre);
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
  const std::size_t outer = build.surface.positions.size();
  const Vec3 centre = random.in_box(0.3);
  const double radius = random.uniform(0.3, 0.8);
  append_sphere(build.surface, random.integer(0, 1), radius, centre);
  if (random.integer(0, 1) == 0) {
    build.noise = random.uniform(0.2, 1.2);
    build.add_chain(random.integer(1, 2), 2);
  } else {
    // The outer shell closes down on the inner shell, and both stay positive.
    build.target = build.surface.positions;
    const double shrink = random.uniform(0.1, 0.4);
    for (std::size_t i = 0; i < outer; ++i) build.target[i] *= shrink;
    build.noise = random.uniform(0, 0.05);
    build.add_chain(1, random.uniform(0.1, 1));
  }
  return build;
}

// A flat slab closes like a book.
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

// A ball is positive almost everywhere, so culling drops nearly all pairs that it ever could. Only horns
// stand out and come down on the ball, or on each other, from the side.
Build horned_ball(Random& random) {
  Build build;
  append_sphere(build.surface, 2, 1, Vec3::Zero());
  std::vector<Vec3>& x = build.surface.positions;
  build.target = x;
  for (int horn = random.integer(1, 3); horn > 0; --horn) {
    const auto tip = static_cast<std::size_t>(random.integer(0, static_cast<int>(x.size()) - 1));
    const Vec3 up = x[tip].normalized();
    const Vec3 aside = up.cross(random.in_box(1)).normalized();
    const double fall = random.uniform(0.3, 1.2), high = random.uniform(1.3, 2.2);
    const double low = random.uniform(0.6, 1.1);
    x[tip] = high * up;
    build.target[tip] = low * (std::cos(fall) * up + std::sin(fall) * aside);
  }
  build.add_chain(random.integer(1, 2), 1);
  build.noise = random.at_times(0, 0.05);
  return build;
}

// A smooth tube round one bone or a few is dented in its middle from the side until the walls meet, or its
// ends are bent onto each other.
Build dented_tube(Random& random) {
  Build build;
  const double length = random.uniform(4, 6);
  const Tube tube{random.integer(7, 10), random.integer(6, 9), length, {0.6, random.uniform(0.4, 0.8), 0.6}};
  append_tube(build.surface, tube);
  build.target = build.surface.positions;
  const double angle = random.uniform(0, 2 * std::numbers::pi), centre = random.uniform(-0.3, 0.3) * length;
  const double depth = random.uniform(0.6, 1.6), width = random.uniform(0.3, 0.8);
  const Vec3 inward(-std::cos(angle), -std::sin(angle), 0);
  for (Vec3& p : build.target) {
    const double along = (p.z() - centre) / width, facing = std::max(0.0, -p.dot(inward));
    p += depth * facing * std::exp(-along * along) / 0.6 * inward;
  }
  build.add_chain(random.integer(1, 3), length);
  build.start.bend = random.uniform(0, 0.6) * 2 * std::numbers::pi / length;
  build.end.bend = build.start.bend + random.uniform(0, 0.4) * 2 * std::numbers::pi / length;
  return build;
}

// The underside of a fingertip is positive towards the bone at one corner and negative at another. In this
// case a segment observer has to look at all three vertices (rule three-vertices).
Build finger_over_segment(Random& random) {
  Build build;
  build.start_noise = 0;
  append_hooked_finger(build.surface);
  for (Triangle& corner : build.surface.triangles)
    std::rotate(corner.begin(), corner.begin() + random.integer(0, 2), corner.end());
  build.target = build.surface.positions;
  const Vec3 aside = random.in_box(0.02);
  const Vec3 poke = random.uniform(0.9, 1.5) * kFingerPoke + aside;
  for (std::size_t i = 0; i < 4; ++i) build.target[i] += poke;
  build.parent = {BoneId{-1}};
  build.bones = {{{-1, 0, 0}, {1, 0, 0}}};
  build.noise = random.at_times(0, 0.01);
  return build;
}

// Boxes and octahedra with integer corners come to touch exactly: face on face, edge on edge, tip on face.
// Bounds that are too tight by a single ulp lose these contacts.
Build touching_lattice(Random& random) {
  Build build;
  build.lattice = true;
  build.start_noise = 0;
  append_box(build.surface, {-4, -4, -4}, {4, 4, 4});
  build.target = build.surface.positions;
  build.add_chain(1, 4);
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0 && random.integer(0, 1) == 0) continue;
    const double side = random.integer(0, 1) == 0 ? -1 : 1;
    const int size = random.integer(1, 3);
    Vec3 centre = random.whole(-5, 5);
    centre[axis] = side * (4 + size);  // at the end it touches the side of the box, or lies beside it
    const std::size_t first = build.surface.positions.size();
    if (random.integer(0, 1) == 0)
      append_sphere(build.surface, 0, size, centre);
    else
      append_box(build.surface, centre - Vec3::Constant(size), centre + Vec3::Constant(size));
    Vec3 away = random.whole(-1, 1);
    away[axis] = side * random.integer(5, 9);
    for (std::size_t i = first; i < build.surface.positions.size(); ++i) {
      build.target.push_back(build.surface.positions[i]);
      build.surface.positions[i] += away + 20 * side * Vec3::Unit(axis);
    }
    build.add_chain(1, 1, centre);
  }
  return build;
}

// An open sheet that is flat, waved or rolled at first, and then folds, rolls up or crumples. At rest it may
// lie in one plane exactly.
Build open_sheet(Random& random) {
  Build build;
  const double length = random.uniform(2, 6), circle = 2 * std::numbers::pi / length;
  const double width = random.uniform(0.5, 3);
  const int across = random.integer(2, 8);
  append_sheet(build.surface, random.integer(3, 14), across, length, width);
  build.add_chain(random.integer(1, 3), length);
  build.start_noise = random.at_times(0, 0.1);
  build.start.bend = random.at_times(0, 0.8) * circle;
  build.end.bend = random.uniform(0, 1.6) * circle;
  build.end.pitch = random.at_times(0, 0.3);
  build.end.twist = random.at_times(-1, 1);
  build.end.linear.diagonal() = random.between({0, 0.5, 0.2}, {1, 1, 1});
  build.noise = random.at_times(0, 0.3);
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
    Family{"horned_ball", horned_ball},
    Family{"dented_tube", dented_tube},
    Family{"finger_over_segment", finger_over_segment},
    Family{"touching_lattice", touching_lattice},
};

constexpr auto kNames = [] {
  std::array<std::string_view, kFamilies.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kFamilies[i].name;
  return names;
}();

// The place of the whole interval: near or far, tiny or huge, resting or rushing by.
struct Place {
  double scale = 1;
  Vec3 offset = Vec3::Zero(), rush = Vec3::Zero();
};
Place random_place(Random& random, bool lattice) {
  Place place;
  if (lattice) {
    place.scale = std::ldexp(1, random.integer(-20, 20));
    return place;
  }
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

namespace {

// Returns an interval from its end to its start, with another header.
RandomInterval backwards(const RandomInterval& whole, ClipHeader header) {
  Clip clip(std::move(header));
  for (const std::size_t frame : {1u, 0u}) clip.append(whole.clip.frame(frame));
  return {whole.family, std::move(clip)};
}

constexpr std::uint64_t kOneInIsASheet = 4;  // so many torn intervals hold one of an open sheet

RandomInterval made(Random& random, std::string_view family, Build build) {
  const Place place = random_place(random, build.lattice);
  if (!build.lattice) build.end.shift += random.in_box(0.3);
  if (build.target.empty()) build.target = build.surface.positions;

  ClipHeader header{build.surface.triangles, build.surface.positions.size(), build.parent, false};
  Clip clip(std::move(header));
  for (const bool at_end : {false, true}) {
    const Warp& warp = at_end ? build.end : build.start;
    const auto put = [&](const Vec3& p) -> Vec3 {
      return place.scale * (warp(p) + (at_end ? place.rush : Vec3::Zero())) + place.offset;
    };
    std::vector<Vec3> positions;
    for (const Vec3& p : at_end ? build.target : build.surface.positions) {
      const Vec3 noise = random.in_box(at_end ? build.noise : build.start_noise);
      positions.push_back(put(p) + place.scale * noise);
    }
    std::vector<Bone> bones;
    for (const Bone& bone : build.bones) bones.push_back({put(bone.head), put(bone.tail)});
    clip.append({positions, bones});
  }
  return {family, std::move(clip)};
}

}  // namespace

RandomInterval make_random_interval(std::uint64_t seed) {
  Random random(seed * 0x9e3779b97f4a7c15u + 1);
  const Family& family = kFamilies[seed % kFamilies.size()];
  return made(random, family.name, family.make(random));
}

RandomInterval make_torn_interval(std::uint64_t seed) {
  Random random(seed * 0x9e3779b97f4a7c15u + 2);
  if (seed % kOneInIsASheet == 0) {
    RandomInterval sheet = made(random, "open_sheet", open_sheet(random));
    return seed % (2 * kOneInIsASheet) == 0 ? sheet : backwards(sheet, sheet.clip.header());
  }
  const RandomInterval whole = make_random_interval(seed);
  ClipHeader header = whole.clip.header();
  const int one_in = random.integer(5, 200);
  std::vector<Triangle> left;
  for (Triangle corners : header.triangles) {
    const int fate = random.integer(0, one_in);
    if (fate == 0 && header.triangles.size() > 1) continue;
    if (fate == 1) std::swap(corners[0], corners[1]);
    left.push_back(corners);
    if (fate == 2) left.push_back(corners);
  }
  if (!left.empty()) header.triangles = std::move(left);
  return backwards(whole, std::move(header));
}

}  // namespace cscd::scenes
