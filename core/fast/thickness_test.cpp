#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <random>

#include "core/base/error.h"
#include "core/detect/compose.h"
#include "core/detect/plain_culler.h"
#include "core/elementary/catalogue.h"
#include "core/fast/drvbc_fast.h"
#include "core/mesh/mean_edge.h"
#include "core/mesh/test_shapes.h"

// The rows of the engine on steps with a thickness, held against all close pairs that boxes leave.
namespace cscd {
namespace {

// A tube whose vertices come nearer to each other by chance: what is close first is near on the surface. With
// `bend`, the tube bends until its ends come near, too.
struct ThickTube {
  test::Shape shape;
  TriangleMesh mesh;
  std::vector<Vec3> end;
  double edge = 0;  // the mean length

  ThickTube(unsigned seed, double noise, double bend)
      : shape(test::uneven_tube(12, 90, 20, [](double x) { return 0.8 + 0.1 * std::sin(3 * x); })),
        mesh(shape.mesh()) {
    std::mt19937 random(seed);
    const auto dice = [&] { return noise * (static_cast<double>(random() >> 8) * 0x1p-23 - 1); };
    for (const Vec3& p : shape.positions) {
      const double angle = bend * (p.x() / 20 - 0.5), reach = 10 - p.y();
      const Vec3 bent(10 + reach * std::sin(angle), 10 - reach * std::cos(angle), p.z());
      end.push_back((bend == 0 ? p : bent) + Vec3(dice(), dice(), dice()));
    }
    edge = mean_edge(mesh, shape.positions);
  }
  StrategyInput setup(bool first_only = false) const {
    return {mesh, shape.positions, nullptr, *find_elementary_test("filtered_exact"), 1, first_only};
  }
  Motion motion() const { return Motion(shape.positions, end); }
};

ContactSet answer_of(Detector& detector, const Step& step, Report* report = nullptr) {
  ContactSet found;
  const Report own = detector.detect(step, found);
  if (report != nullptr) *report = own;
  found.sort();
  return found;
}

// From clear starts, drvbc_fast keeps a close pair of the earliest time, drvbc_fast_all and
// drvbc_fast_complete keep all close pairs, and all of them leave most pairs unexamined.
// Mutations: every pair near on the surface is settled; triangles are tall whatever their heights; one ring
// instead of two settles; rings are not spread; bounds do not grow; only one side of a pair's bounds grows;
// clear triangles need no clear ring; planes are asked, or one-rings as if nothing but touching counted.
TEST(Thickness, EveryRowKeepsWhatItPromises) {
  std::size_t clear = 0, near_first = 0;
  std::uint64_t plain = 0, by_signs = 0, by_caps = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const double noise = seed % 3 == 0 ? 0.02 : seed % 3 == 1 ? 0.05 : 0.12, bend = seed % 2 == 0 ? 0 : 5.6;
    const ThickTube tube(seed, noise, bend);
    std::mt19937 random(seed);
    const double r = tube.edge * std::exp2(-5 * static_cast<double>(random()) * 0x1p-32);
    const Step step{.motion = tube.motion(), .thickness = Thickness(r)};
    const auto base = compose(std::make_unique<PlainCuller<Kdop16>>(tube.setup()), tube.setup());
    Report report;
    const ContactSet all = answer_of(*base, step, &report);
    plain += report.cull.pctp;
    const ContactSet complete = answer_of(
        *make_drvbc_fast(tube.setup(), {.name = "complete", .complete = true}).detector, step, &report);
    by_caps += report.cull.pctp;
    EXPECT_EQ(digest(complete), digest(all)) << "seed " << seed;
    if (!all.contacts.empty() && all.contacts.front().time == 0) continue;
    ++clear;
    Step known = step;
    known.starts_embedded = true;
    const ContactSet again =
        answer_of(*make_drvbc_fast(tube.setup(), {.name = "complete", .complete = true}).detector, known);
    EXPECT_EQ(digest(again), digest(all)) << "seed " << seed;
    const ContactSet first = answer_of(*make_drvbc_fast(tube.setup()).detector, step, &report);
    by_signs += report.cull.pctp;
    ASSERT_EQ(first.contacts.empty(), all.contacts.empty()) << "seed " << seed;
    const ContactSet alone = answer_of(*make_drvbc_fast(tube.setup(true)).detector, step);
    if (all.contacts.empty()) continue;
    EXPECT_EQ(first.contacts.front().time, all.contacts.front().time) << "seed " << seed;
    EXPECT_EQ(alone.contacts.front().time, all.contacts.front().time) << "seed " << seed;
    near_first += bend == 0;
  }
  EXPECT_GT(clear, 30u);
  EXPECT_GT(near_first, 10u) << "pairs near on the surface are not put to the test";
  EXPECT_LT(by_signs, plain / 3);
  EXPECT_LT(by_caps, plain / 2);
}

// A thickness by vertex: each pair is held against its own, and the largest bounds what is looked at.
TEST(Thickness, OfVerticesIsThatOfTheirPairs) {
  const ThickTube tube(3, 0.12, 0);
  std::vector<double> of_vertex(tube.mesh.vertex_count());
  std::mt19937 random(7);
  for (double& r : of_vertex) r = 0.2 * tube.edge * static_cast<double>(random()) * 0x1p-32;
  const Step step{.motion = tube.motion(), .thickness = Thickness(0.05 * tube.edge, of_vertex)};
  const auto base = compose(std::make_unique<PlainCuller<Kdop16>>(tube.setup()), tube.setup());
  const ContactSet all = answer_of(*base, step);
  const auto complete = make_drvbc_fast(tube.setup(), {.name = "complete", .complete = true}).detector;
  EXPECT_EQ(digest(answer_of(*complete, step)), digest(all));
  const Step largest{.motion = tube.motion(), .thickness = Thickness(step.thickness.largest())};
  const ContactSet more = answer_of(*complete, largest);
  EXPECT_LT(all.contacts.size(), more.contacts.size());
  EXPECT_GT(all.contacts.size(), 0u);
  for (const Contact& contact : all.contacts) {
    const double r = step.thickness.of(tube.mesh, contact.pair);
    EXPECT_EQ(ask_close(*find_elementary_test("exact"), tube.mesh, tube.motion(), contact.pair, r).time,
              contact.time);
  }
}

// A sheet in a notch: above a floor face lies a ceiling that hinges on one of the face's edges, and above
// that a vertex sinks. It comes within the thickness of the floor face, whose third corner alone has one, and
// of nothing else: the ceiling in between shares a vertex with the face, and lies no way near the sinking
// vertex by its own thickness. So signs, which speak of one thickness for all pairs, lose the only close
// pair.
struct Notch {
  static constexpr std::array<double, 6> kRows = {-60, -15, -5, 5, 15, 60};
  static constexpr std::array<double, 9> kFlat = {-50, -30, -20, -13, -8, -4, 4, 20, 50};
  std::vector<Triangle> triangles;
  std::vector<Vec3> start, end;
  std::vector<double> of_vertex;

  static int at(std::size_t column, std::size_t row) { return static_cast<int>(column * kRows.size() + row); }
  void add(int a, int b, int c) { triangles.push_back({VertexId{a}, VertexId{b}, VertexId{c}}); }
  static std::vector<Vec3> sheet(const std::array<std::array<double, 2>, 9>& columns) {
    std::vector<Vec3> out;
    for (std::size_t u = 0; u < kFlat.size(); ++u)
      for (std::size_t v = 0; v < kRows.size(); ++v) {
        const bool border = v == 0 || v + 1 == kRows.size();
        out.push_back(border ? Vec3(kFlat[u], kRows[v], 0) : Vec3(columns[u][0], kRows[v], columns[u][1]));
      }
    out.emplace_back(0, 0, -60);
    return out;
  }
  Notch() {
    const std::size_t columns = kFlat.size(), rows = kRows.size();
    for (std::size_t u = 0; u + 1 < columns; ++u)
      for (std::size_t v = 0; v + 1 < rows; ++v) {
        add(at(u, v), at(u + 1, v), at(u, v + 1));
        add(at(u + 1, v), at(u + 1, v + 1), at(u, v + 1));
      }
    std::vector<int> border;  // counterclockwise from above
    for (std::size_t u = 0; u < columns; ++u) border.push_back(at(u, 0));
    for (std::size_t v = 1; v < rows; ++v) border.push_back(at(columns - 1, v));
    for (std::size_t u = columns - 1; u-- > 0;) border.push_back(at(u, rows - 1));
    for (std::size_t v = rows - 1; v-- > 1;) border.push_back(at(0, v));
    for (std::size_t i = 0; i < border.size(); ++i)
      add(border[(i + 1) % border.size()], border[i], static_cast<int>(columns * rows));
    start =
        sheet({{{-50, 2}, {-30, 2}, {-6, 2}, {0.4, 2.2}, {1.8, 4}, {3.5, 4.5}, {0, 0}, {20, 0}, {50, 0}}});
    end = start;
    const auto sinking = static_cast<std::size_t>(at(3, 2));
    start[sinking] = Vec3(0.4, 0, 1.3);
    end[sinking] = Vec3(0.4, 0, 0.9);
    of_vertex.assign(start.size(), 0);
    of_vertex[static_cast<std::size_t>(at(7, 2))] = 1;
  }
};

// Mutations: signs are asked where pairs have thicknesses of their own; a row of signs alone answers there.
TEST(Thickness, SignsAreNotAskedWherePairsHaveTheirOwn) {
  const Notch notch;
  const TriangleMesh mesh(notch.triangles, notch.start.size());
  ASSERT_TRUE(mesh.closed_and_oriented());
  const StrategyInput setup{mesh, notch.start, nullptr, *find_elementary_test("filtered_exact")};
  const Step step{.motion = Motion(notch.start, notch.end),
                  .starts_embedded = true,
                  .thickness = Thickness(0, notch.of_vertex)};
  const ContactSet all = answer_of(*compose(std::make_unique<PlainCuller<Kdop16>>(setup), setup), step);
  ASSERT_EQ(all.contacts.size(), 1u);
  EXPECT_DOUBLE_EQ(all.contacts[0].time, 0.75);
  const DrvbcFastOptions complete{.name = "complete", .complete = true};
  EXPECT_EQ(digest(answer_of(*make_drvbc_fast(setup, complete).detector, step)), digest(all));
  EXPECT_THROW(answer_of(*make_drvbc_fast(setup).detector, step), InputError);
}

// Where signs leave many pairs near on the surface, the next steps are looked at by caps alone, until another
// thickness is asked for. Mutations: the pairs are not counted; the count outlives its thickness.
TEST(Thickness, SignsAreNotAskedWhereTheyLeaveMuch) {
  const ThickTube tube(2, 0.02, 0);
  const auto detector = make_drvbc_fast(tube.setup(), {.name = "test", .follows = false, .complete = true});
  const auto looks_by_signs = [&](double r) {
    const Step step{.motion = Motion(tube.shape.positions, tube.shape.positions),
                    .starts_embedded = true,
                    .thickness = Thickness(r * tube.edge)};
    Report report;
    EXPECT_TRUE(answer_of(*detector.detector, step, &report).contacts.empty());
    return report.cull.pctp;
  };
  const double large = 0.2, small = 1e-6;
  const std::uint64_t by_signs = looks_by_signs(large);
  EXPECT_LT(looks_by_signs(large), by_signs / 4);
  EXPECT_LT(looks_by_signs(large), by_signs / 4);
  EXPECT_LT(looks_by_signs(small), by_signs);
  EXPECT_EQ(looks_by_signs(large), by_signs);
}

// What was asked with a thickness before leaves nothing behind.
TEST(Thickness, DoesNotOutliveItsStep) {
  const ThickTube tube(4, 0.1, 5.6);
  for (const bool complete : {false, true}) {
    const DrvbcFastOptions options{.name = "test", .follows = false, .complete = complete};
    const auto used = make_drvbc_fast(tube.setup(), options).detector;
    for (const double r : {0.0, 0.3, 0.0, 0.05, 0.3, 0.0}) {
      const Step step{.motion = tube.motion(), .thickness = Thickness(r * tube.edge)};
      const auto other = make_drvbc_fast(tube.setup(), options).detector;
      EXPECT_EQ(digest(answer_of(*used, step)), digest(answer_of(*other, step))) << r;
    }
  }
}

}  // namespace
}  // namespace cscd
