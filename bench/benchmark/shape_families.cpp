#include <array>
#include <cmath>
#include <numbers>

#include "bench/benchmark/subject.h"
#include "scenes/random/surface.h"

// Small surfaces in a motion that is hard as a whole.
namespace cscd::bench {
namespace {

using scenes::PosedMesh;
using scenes::Random;
using scenes::Surface;

// With one bone, along z through the origin.
PosedMesh moved(const Surface& surface, std::vector<Vec3> end) {
  const std::vector<Bone> bone{{Vec3(0, 0, -0.1), Vec3(0, 0, 0.1)}};
  const PosedMesh::Pose start{surface.positions, bone};
  return {surface.triangles, {BoneId{-1}}, start, {{start, {std::move(end), bone}}}};
}

template <class Map>
std::vector<Vec3> mapped(const std::vector<Vec3>& positions, const Map& map) {
  std::vector<Vec3> out;
  for (const Vec3& p : positions) out.push_back(map(p));
  return out;
}

Surface random_body(Random& random) {
  Surface body;
  if (random.integer(0, 1) == 0)
    scenes::append_sphere(body, random.integer(1, 2), 1, Vec3::Zero());
  else
    scenes::append_box(body, Vec3(-1, -1, -1), Vec3(1, 1, 1));
  return body;
}

// Every ring of the second half goes through the axis where the ends turn by half a turn or more.
PosedMesh twisted(std::uint64_t seed) {
  Random random(seed);
  Surface tube;
  scenes::append_tube(tube, {random.integer(6, 10), random.integer(4, 8), 4, {0.5, 0.5}});
  const double turns = std::array{0.25, 0.5, 0.5, 0.75, 1.0}[static_cast<std::size_t>(random.integer(0, 4))];
  return moved(tube, mapped(tube.positions, [&](const Vec3& p) {
                 const double angle = 2 * std::numbers::pi * turns * (p.z() / 4 + 0.5);
                 const double c = std::cos(angle), s = std::sin(angle);
                 return Vec3(c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z());
               }));
}

PosedMesh flattened(std::uint64_t seed) {
  Random random(seed);
  const Surface body = random_body(random);
  const double height = std::array{0.0, -1.0, -3.0, 0x1p-40}[static_cast<std::size_t>(random.integer(0, 3))];
  return moved(body,
               mapped(body.positions, [&](const Vec3& p) { return Vec3(p.x(), p.y(), height * p.z()); }));
}

// A ball goes through a plate, from far on one side to far on the other. Returns the surface and its end.
PosedMesh through_a_plate(Random& random, double distance) {
  Surface surface;
  scenes::append_sphere(surface, random.integer(0, 2), 1, Vec3(-distance, 0.25, 0.125));
  const std::size_t ball = surface.positions.size();
  scenes::append_box(surface, Vec3(-0.25, -4, -4), Vec3(0.25, 4, 4));
  std::vector<Vec3> end = surface.positions;
  for (std::size_t i = 0; i < ball; ++i) end[i].x() += 2 * distance;
  return moved(surface, std::move(end));
}

PosedMesh tunnelling(std::uint64_t seed) {
  Random random(seed);
  return through_a_plate(random, std::ldexp(1.0, random.integer(1, 24)));
}

PosedMesh at_one_instant(std::uint64_t seed) {
  Random random(seed);
  Surface surface;
  scenes::append_box(surface, Vec3(-1, -1, -1), Vec3(1, 1, 1));
  std::vector<Vec3> end = surface.positions;
  const int splits = random.integer(0, 1);
  const double reach = random.integer(3, 6);
  for (const Vec3& way : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, -1)}) {
    const std::size_t first = surface.positions.size();
    scenes::append_sphere(surface, splits, 1, reach * way);
    for (std::size_t i = first; i < surface.positions.size(); ++i)
      end.push_back(surface.positions[i] - (reach - 1) * way);
  }
  return moved(surface, std::move(end));
}

// The sizes are powers of two and the offset is representable, so that the times stay what they are.
PosedMesh scaled(std::uint64_t seed) {
  Random random(seed);
  PosedMesh mesh = through_a_plate(random, std::ldexp(1.0, random.integer(1, 4)));
  const double scale = std::ldexp(1.0, random.integer(-250, 250));
  const Vec3 offset = random.integer(0, 1) == 1 ? Vec3(0x1p30, -0x1p28, 0x1p20) : Vec3(0, 0, 0);
  const auto place = [&](const Vec3& p) { return Vec3(scale * (p + offset)); };
  for (PosedMesh::Pose* pose : {&mesh.reference, &mesh.intervals[0].start, &mesh.intervals[0].end}) {
    pose->positions = mapped(pose->positions, place);
    pose->bones.clear();
  }
  mesh.bone_parent.clear();
  return mesh;
}

// One half turns over onto the other about the middle line, exactly or a little beyond or short of it.
PosedMesh folded(std::uint64_t seed) {
  Random random(seed);
  Surface sheet;
  scenes::append_sheet(sheet, random.integer(2, 5), 2 * random.integer(1, 3), 2, 2);
  const double gap =
      std::array{0.0, 0.0, 0x1p-30, -0.25, 0.25}[static_cast<std::size_t>(random.integer(0, 4))];
  return moved(sheet, mapped(sheet.positions, [&](const Vec3& p) {
                 return p.y() <= 0 ? p : Vec3(p.x() + gap * p.y(), -p.y(), p.z());
               }));
}

constexpr ShapeFamily kFamilies[] = {
    {"twisted", "a tube of which one end turns against the other, by half a turn and more", twisted},
    {"flattened", "a ball or a box that is pressed flat within the interval, at its end, or nearly",
     flattened},
    {"tunnelling", "a ball that goes through a plate within one interval, from up to 2^24 away", tunnelling},
    {"at_one_instant", "four balls that reach a box at the same instant, at corners, edges and faces",
     at_one_instant},
    {"scaled", "a ball that goes through a plate, at sizes from 2^-250 to 2^250 and far from the origin",
     scaled},
    {"folded", "an open sheet whose one half is laid onto the other", folded},
};

}  // namespace

std::span<const ShapeFamily> shape_families() {
  return kFamilies;
}

}  // namespace cscd::bench
