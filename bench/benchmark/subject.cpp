#include "bench/benchmark/subject.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "bench/harness/interval_choice.h"
#include "bench/strategies/catalogue.h"
#include "scenes/hard/disturbance.h"
#include "scenes/random/random_interval.h"
#include "scenes/random/surface.h"

namespace cscd::bench {

namespace {

namespace hard = scenes::hard;
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
  const int across = 2 * random.integer(1, 3);
  scenes::append_sheet(sheet, random.integer(2, 5), across, 2, 2);
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

std::string numbered(const std::string& name, std::uint64_t number) {
  char text[24];
  std::snprintf(text, sizeof text, "-%05llu", static_cast<unsigned long long>(number));
  return name + text;
}

PosedMesh::Pose pose(const scenes::FrameView& frame) {
  return {{frame.positions.begin(), frame.positions.end()}, {frame.bones.begin(), frame.bones.end()}};
}

PosedMesh::Interval ends(const scenes::ClipInterval& interval) {
  const auto bones = interval.bones.value_or(Rig::Interval{});
  return {pose({interval.motion.start(), bones.start}), pose({interval.motion.end(), bones.end})};
}

Subject one_interval(std::string name, std::string family, PosedMesh mesh) {
  Subject subject{name, std::move(family), std::move(mesh), {}};
  subject.ids.push_back(std::move(name));
  return subject;
}

Subject clip_subject(std::string name, std::string family, const scenes::Clip& clip) {
  return one_interval(
      std::move(name), std::move(family),
      {clip.header().triangles, clip.header().bone_parent, pose(clip.frame(0)), {ends(clip.interval(0))}});
}

// Positions of both tetrahedra, as they are made: the corners of the first, then those of the second.
struct Tetrahedra {
  std::vector<Vec3> start, end;

  void add(const MovingPoint& point) {
    start.push_back(point.start);
    end.push_back(point.end);
  }
  // A corner that moves along with a point, some way off it.
  void add_beside(const MovingPoint& point, const Vec3& offset) {
    const MovingPoint corner{point.start + offset, point.end + offset};
    const bool fits = corner.start.allFinite() && corner.end.allFinite();
    add(fits ? corner : point);  // a huge query has no room, and the tetrahedron is flat there
  }
};

// The largest extent of the four points along any axis, at the start.
double size_of(const Query& query) {
  Vec3 low = query.points[0].start, high = low;
  for (const MovingPoint& point : query.points) {
    low = low.cwiseMin(point.start);
    high = high.cwiseMax(point.start);
  }
  const double size = (high - low).maxCoeff();
  return size > 0 && std::isfinite(size) ? size : 1;
}

Tetrahedra around(const Query& query, hard::Kind kind) {
  const MovingPoint* p = query.points;
  const bool face = kind == hard::Kind::vertex_face;
  const double size = size_of(query);
  // From the first feature to the second.
  Vec3 away = p[face ? 1 : 2].start - p[0].start;
  if (!away.allFinite() || away == Vec3::Zero()) away = size * Vec3(1, 0.5, 0.25);
  const Vec3 across = size * Vec3(-0.25, 0.125, 0.5), up = size * Vec3(0.125, 0.5, -0.25);
  Tetrahedra out;
  out.add(p[0]);
  if (face) {
    out.add_beside(p[0], -away);
    out.add_beside(p[0], across - away);
    out.add_beside(p[0], up - away);
    for (int i = 1; i < 4; ++i) out.add(p[i]);
    out.add_beside(p[1], away);
  } else {
    out.add(p[1]);
    out.add_beside(p[0], across - away);
    out.add_beside(p[1], up - away);
    out.add(p[2]);
    out.add(p[3]);
    out.add_beside(p[2], across + away);
    out.add_beside(p[3], up + away);
  }
  return out;
}

}  // namespace

std::span<const ShapeFamily> shape_families() {
  return kFamilies;
}

Subject random_subject(std::uint64_t seed) {
  const scenes::RandomInterval random = scenes::make_random_interval(seed);
  return clip_subject(numbered("random", seed), "random/" + std::string(random.family), random.clip);
}

Subject torn_subject(std::uint64_t seed) {
  const scenes::RandomInterval random = scenes::make_torn_interval(seed);
  return clip_subject(numbered("torn", seed), "torn/" + std::string(random.family), random.clip);
}

Subject hard_subject(const hard::Family& family, hard::Kind kind, std::size_t number, std::uint64_t seed) {
  Tetrahedra both = around(hard::suite_query(family, kind, number, seed), kind);
  PosedMesh mesh;
  for (const int first : {0, 4})
    for (const auto& [a, b, c] : {std::array{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}})
      mesh.triangles.push_back({VertexId{first + a}, VertexId{first + b}, VertexId{first + c}});
  mesh.reference.positions = both.start;
  mesh.intervals.push_back({{std::move(both.start), {}}, {std::move(both.end), {}}});
  const std::string name(family.name);
  return one_interval(numbered("hard-" + name + (kind == hard::Kind::vertex_face ? "-vf" : "-ee"), number),
                      "hard/" + name, std::move(mesh));
}

Subject shape_subject(const ShapeFamily& family, std::size_t number, std::uint64_t seed) {
  const std::string name(family.name);
  return one_interval(numbered("shape-" + name, number), "shapes/" + name, family.make(seed + number));
}

Subject scene_subject(Input& input, const std::string& scene, std::size_t count) {
  const scenes::ClipHeader& header = input.clip->header();
  const std::size_t intervals = input.clip->interval_count();
  const auto detector =
      complete_fallback().make(input.setup(elementary_test_named("filtered_exact"))).detector;
  const std::vector<std::size_t> touching = intervals_with_contacts(input, *detector, {0, intervals});
  std::vector<std::size_t> chosen = spread(count, intervals);
  if (!touching.empty() && count > 1) {
    const std::vector<std::size_t> middle = spread(1, intervals);
    const bool middle_touches = std::ranges::binary_search(touching, middle.front());
    chosen = with_contacts(middle, touching, count - 1 + (middle_touches ? 1 : 0));
  }
  Subject subject{"scene-" + scene,
                  "scenes/" + scene,
                  {header.triangles, header.bone_parent, pose(input.clip->load_frame(0)), {}},
                  {}};
  for (const std::size_t i : chosen) {
    subject.mesh.intervals.push_back(ends(input.clip->load(i)));
    subject.ids.push_back(numbered(subject.name, i));
  }
  return subject;
}

}  // namespace cscd::bench
