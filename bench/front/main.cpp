#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cscd/cscd.h>
#include <cstdio>
#include <ctime>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "bench/query/input/input.h"
#include "core/elementary/catalogue.h"
#include "core/fast/drvbc_fast.h"

// The price of the library's front, in shares of the detector behind it:
//   cscd_front [ROUNDS]
// Each line compares two ways to ask the same steps. The two take turns over the whole clip, every second
// round in the other order, and the median of the rounds' ratios is printed. Times are processor times of
// this thread, so that other programs disturb them little.
namespace cscd::bench {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using FaceRows = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Ask = std::function<void(const Rows& start, const Rows& end)>;

double microseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

// A mesh and a way of it through free poses, there and back, so that each step starts where one ended.
struct Way {
  FaceRows faces;
  std::vector<Rows> poses;

  double microseconds_of(const Ask& ask) const {
    const double before = microseconds();
    for (std::size_t i = 0; i + 1 < poses.size(); ++i) ask(poses[i], poses[i + 1]);
    return (microseconds() - before) / static_cast<double>(poses.size() - 1);
  }
};

void compare(const std::string& what, const Way& way, int rounds, const Ask& plain, const Ask& dear) {
  std::vector<double> ratios, plain_us, extra_us;
  way.microseconds_of(plain), way.microseconds_of(dear);
  for (int round = 0; round < rounds; ++round) {
    double first = 0, second = 0;
    if (round % 2 == 0) first = way.microseconds_of(plain);
    second = way.microseconds_of(dear);
    if (round % 2 == 1) first = way.microseconds_of(plain);
    ratios.push_back(second / first), plain_us.push_back(first), extra_us.push_back(second - first);
  }
  std::printf("%-66s %9.1f us  %+7.1f us  ratio %.3f\n", what.c_str(), median(plain_us), median(extra_us),
              median(ratios));
  std::fflush(stdout);
}

std::span<const Vec3> points(const Rows& rows) {
  return {reinterpret_cast<const Vec3*>(rows.data()), static_cast<std::size_t>(rows.rows())};
}

FaceRows faces_of(std::span<const Triangle> triangles) {
  FaceRows faces(static_cast<Eigen::Index>(triangles.size()), 3);
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    for (int k = 0; k < 3; ++k)
      faces(f, k) = static_cast<int>(triangles[static_cast<std::size_t>(f)][static_cast<std::size_t>(k)]);
  return faces;
}

Way rope() {
  const Input input = open_input("rope");
  Way way{faces_of(input.mesh.triangles()), {}};
  for (std::size_t i = 0; i < 12; ++i) {
    const scenes::ClipInterval interval = input.clip->load(i);
    way.poses.emplace_back(Eigen::Map<const Rows>(interval.motion.start()[0].data(),
                                                  static_cast<Eigen::Index>(input.mesh.vertex_count()), 3));
  }
  for (std::size_t i = 11; i-- > 0;) way.poses.push_back(way.poses[i]);
  return way;
}

// A bent strip of n by m quads, closed to a tube where `closed`, that sways. It meets nothing.
Way tube(int around, int along, bool closed = true) {
  Way way;
  std::vector<Triangle> triangles;
  const auto at = [&](int i, int j) { return VertexId{j * around + i % around}; };
  for (int j = 0; j + 1 < along; ++j)
    for (int i = 0; i < around - (closed ? 0 : 1); ++i) {
      triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  const int poles = closed ? 2 : 0, count = around * along + poles;
  for (int i = 0; closed && i < around; ++i) {
    triangles.push_back({at(i + 1, 0), at(i, 0), VertexId{around * along}});
    triangles.push_back({at(i, along - 1), at(i + 1, along - 1), VertexId{around * along + 1}});
  }
  way.faces = faces_of(triangles);
  for (int pose = 0; pose < 24; ++pose) {
    const double sway = 0.3 * std::sin(2 * 3.14159265358979 * pose / 23);
    Rows rows(count, 3);
    for (int j = 0; j < along; ++j)
      for (int i = 0; i < around; ++i) {
        const double z = 10.0 * j / along, angle = 2 * 3.14159265358979 * i / around;
        const double x = closed ? std::cos(angle) : 4.0 * i / around;
        rows.row(j * around + i) << x + sway * z * z / 20, closed ? std::sin(angle) : 0.2 * std::sin(z + x),
            z;
      }
    if (closed) rows.row(count - 2) << 0, 0, -0.2;
    if (closed) rows.row(count - 1) << sway * 5, 0, 10.2;
    way.poses.push_back(rows);
  }
  return way;
}

void front_over_detector(const std::string& name, const Way& way, int rounds) {
  SelfCollision body(way.faces, way.poses[0]);
  std::vector<Triangle> triangles;
  for (Eigen::Index f = 0; f < way.faces.rows(); ++f)
    triangles.push_back({VertexId{way.faces(f, 0)}, VertexId{way.faces(f, 1)}, VertexId{way.faces(f, 2)}});
  const TriangleMesh mesh(triangles, static_cast<std::size_t>(way.poses[0].rows()));
  const Setup setup{mesh, points(way.poses[0]), nullptr, *find_elementary_test("filtered_exact"), 1, true};
  const std::unique_ptr<Detector> detector =
      make_drvbc_fast(setup, {.complete = !mesh.closed_and_oriented()}).detector;
  ContactSet found;
  const Ask ask_detector = [&](const Rows& start, const Rows& end) {
    detector->detect({Motion(points(start), points(end))}, found);
  };
  SelfCollision::Answer answer;
  compare(name + ": detect(), then is_free()", way, rounds, ask_detector,
          [&](const Rows& start, const Rows& end) { body.is_free(start, end); });
  compare(name + ": detect(), then first_contact()", way, rounds, ask_detector,
          [&](const Rows& start, const Rows& end) { body.first_contact(start, end, answer); });
  SelfCollision::Options unchecked;
  unchecked.check_positions = unchecked.check_start = false;
  SelfCollision bare(way.faces, way.poses[0], unchecked);
  compare(name + ": detect(), then is_free() without checks", way, rounds, ask_detector,
          [&](const Rows& start, const Rows& end) { bare.is_free(start, end); });
}

void filters(const std::string& name, const Way& way, int rounds) {
  const auto body_with = [&](const std::function<void(SelfCollision::Exclusions&)>& set) {
    SelfCollision::Options options;
    set(options.exclude);
    return std::make_shared<SelfCollision>(way.faces, way.poses[0], options);
  };
  const auto count = static_cast<std::size_t>(way.poses[0].rows());
  const auto last = static_cast<int>(way.faces.rows()) - 1;
  const std::pair<const char*, std::function<void(SelfCollision::Exclusions&)>> kinds[] = {
      {"groups",
       [&](auto& exclude) {
         exclude.group.assign(count, 0);
         exclude.group[0] = 1;
         exclude.groups_that_ignore_each_other = {{1, 1}};
       }},
      {"100 pairs of vertices",
       [&](auto& exclude) {
         for (int i = 0; i < 100; ++i) exclude.vertex_pairs.emplace_back(i, static_cast<int>(count) - 1 - i);
       }},
      {"100 pairs of faces",
       [&](auto& exclude) {
         for (int i = 0; i < 100; ++i) exclude.face_pairs.emplace_back(i, last - i);
       }},
      {"2 rings", [](auto& exclude) { exclude.rings = 2; }},
      {"a rest distance", [](auto& exclude) { exclude.rest_distance = 1e-3; }}};
  const auto plain = body_with([](auto&) {});
  for (const auto& [kind, set] : kinds) {
    const auto filtered = body_with(set);
    compare(
        name + ": is_free(), then with " + kind, way, rounds,
        [&](const Rows& start, const Rows& end) { plain->is_free(start, end); },
        [&](const Rows& start, const Rows& end) { filtered->is_free(start, end); });
  }
  const auto groups = body_with(kinds[0].second);
  SelfCollision::Answer answer;
  compare(
      name + ": all_contacts(), then with groups", way, rounds,
      [&](const Rows& start, const Rows& end) { plain->all_contacts(start, end, answer); },
      [&](const Rows& start, const Rows& end) { groups->all_contacts(start, end, answer); });
}

void candidates(const std::string& name, const Way& way, int rounds) {
  SelfCollision body(way.faces, way.poses[0]);
  SelfCollision::Answer answer;
  const Ask all = [&](const Rows& start, const Rows& end) { body.all_contacts(start, end, answer); };
  compare(name + ": all_contacts(), then candidates(0)", way, rounds, all,
          [&](const Rows& start, const Rows& end) { body.candidates(start, end, 0); });
}

// A terrain of so many quads a side below a mesh, at rest, in the distance or within the mesh's box.
SelfCollision::Obstacle terrain(int quads, double below) {
  FaceRows faces(2 * quads * quads, 3);
  Rows positions((quads + 1) * (quads + 1), 3);
  for (int i = 0, v = 0; i <= quads; ++i)
    for (int j = 0; j <= quads; ++j)
      positions.row(v++) << 40.0 * i / quads - 20, below, 40.0 * j / quads - 20;
  for (int i = 0, f = 0; i < quads; ++i)
    for (int j = 0; j < quads; ++j) {
      const int v = i * (quads + 1) + j;
      faces.row(f++) << v, v + 1, v + quads + 1;
      faces.row(f++) << v + 1, v + quads + 2, v + quads + 1;
    }
  // One high edge of the terrain makes its box surround the mesh.
  for (int j = 0; j <= quads; ++j) positions(j, 1) += 10;
  return {faces, positions};
}

void obstacles(const std::string& name, const Way& way, int rounds) {
  SelfCollision plain(way.faces, way.poses[0]);
  const Ask without = [&](const Rows& start, const Rows& end) { plain.is_free(start, end); };
  for (const auto& [where, below] : {std::pair("far away", -100.0),
                                     {"around it", -3.0},
                                     {"close below", -1.2},
                                     {"that it lies on", way.poses[0].col(1).minCoeff() - 1e-9}}) {
    SelfCollision::Options options;
    options.obstacles.push_back(terrain(224, below));
    SelfCollision body(way.faces, way.poses[0], options);
    compare(name + ": is_free(), then with " + std::to_string(options.obstacles[0].faces.size()) +
                " triangles " + where,
            way, rounds, without, [&](const Rows& start, const Rows& end) { body.is_free(start, end); });
  }
}

void preparation(const std::string& name, const Way& way, int rounds) {
  const std::unique_ptr<SelfCollision> body = std::make_unique<SelfCollision>(way.faces, way.poses[0]);
  const Way one{way.faces, {way.poses[0], way.poses[1]}};
  compare(
      name + ": is_free(), then preparing anew", one, rounds,
      [&](const Rows& start, const Rows& end) { body->is_free(start, end); },
      [&](const Rows& start, const Rows&) { SelfCollision(way.faces, start); });

  SelfCollision::Options kept;
  kept.preparation = body->preparation();
  const Ask anew = [&](const Rows& start, const Rows&) { SelfCollision(way.faces, start); };
  compare(name + ": preparing anew, then from what was kept", one, rounds, anew,
          [&](const Rows& start, const Rows&) { SelfCollision(way.faces, start, kept); });
  // Six faces meet at a vertex, and there are two for each, so these vertices change one face in a hundred.
  const Eigen::Index vertices = way.poses[0].rows(), moved = vertices / 300 + 1;
  for (const bool scattered : {true, false}) {
    Way changed = one;
    for (Rows& pose : changed.poses)
      for (Eigen::Index i = 0; i < moved; ++i) pose(scattered ? 300 * i % vertices : i, 0) += 1e-9;
    compare(name + ": preparing anew, then with 1 % of the faces changed, " +
                (scattered ? "scattered" : "in one place"),
            changed, rounds, anew,
            [&](const Rows& start, const Rows&) { SelfCollision(way.faces, start, kept); });
  }
}

int run(int rounds) {
  std::printf("%-66s %12s  %10s\n", "", "the first", "more");
  const Way small = tube(20, 25), body = tube(50, 50), sheet = tube(50, 51, false);
  const auto name = [](const Way& way) { return std::to_string(way.faces.rows()) + " triangles"; };
  front_over_detector(name(small), small, rounds * 8);
  front_over_detector(name(sheet) + ", open", sheet, rounds * 4);
  filters(name(sheet) + ", open", sheet, rounds * 4);
  candidates(name(sheet) + ", open", sheet, rounds * 4);
  obstacles(name(body), body, rounds * 4);
  preparation(name(small), small, 3);
  if (rounds == 1) return 0;  // a test that all this runs; preparing the rope over and over takes long
  const Way long_rope = rope();
  front_over_detector("rope", long_rope, rounds);
  filters("rope", long_rope, rounds);
  candidates("rope", long_rope, rounds);
  preparation("rope", long_rope, 1);
  return 0;
}

}  // namespace
}  // namespace cscd::bench

int main(int argc, char** argv) {
  try {
    return cscd::bench::run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 15);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cscd_front: %s\n", error.what());
    return 2;
  }
}
