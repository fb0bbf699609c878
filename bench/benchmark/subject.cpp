#include "bench/benchmark/subject.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/measure/replay/interval_choice.h"
#include "bench/measure/strategies/catalogue.h"
#include "scenes/hard/disturbance.h"
#include "scenes/random/random_interval.h"

namespace cscd::bench {
namespace {

namespace hard = scenes::hard;
using scenes::PosedMesh;

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

std::vector<std::size_t> spread(std::size_t count, std::size_t over) {
  count = std::min(count, over);
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < count; ++k) out.push_back((2 * k + 1) * over / (2 * count));
  return out;
}

}  // namespace

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
