#include <algorithm>
#include <gtest/gtest.h>
#include <random>

#include "core/detect/compose.h"
#include "core/detect/plain_culler.h"
#include "core/elementary/catalogue.h"
#include "core/fast/drvbc_fast.h"
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
    for (const Edge& e : mesh.edges()) edge += (shape.positions[+e[0]] - shape.positions[+e[1]]).norm();
    edge /= static_cast<double>(mesh.edge_count());
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
// clear triangles need no clear ring; planes are asked, or stars as if nothing but touching counted.
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
