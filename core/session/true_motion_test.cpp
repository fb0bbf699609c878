#include "core/session/true_motion.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "core/detect/compose.h"
#include "core/detect/plain_culler.h"
#include "core/detect/start/embedding.h"
#include "core/elementary/catalogue.h"
#include "core/fast/drvbc_fast.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

// The second of two octahedra moves along x from one place to another, and every path may leave its line by
// as much as a bound on the acceleration says.
struct Sliding : VertexPaths {
  const std::vector<Vec3>& rest;
  double from, to;

  Sliding(const std::vector<Vec3>& shape, double x0, double x1) : rest(shape), from(x0), to(x1) {}
  std::size_t vertex_count() const override { return rest.size(); }
  std::vector<Vec3> pose(double time) const {
    std::vector<Vec3> out = rest;
    for (std::size_t v = 6; v < out.size(); ++v) out[v] += Vec3(from + time * (to - from), 0.1, 0.2);
    return out;
  }
  void positions(double time, std::span<const VertexId> vertices, std::span<Vec3> at,
                 std::span<double> error) const override {
    const std::vector<Vec3> all = pose(time);
    for (std::size_t i = 0; i < vertices.size(); ++i) at[i] = all[+vertices[i]], error[i] = 1e-15;
  }
  void deviations(double begin, double end, std::span<const VertexId>, std::span<double> out) const override {
    std::ranges::fill(out, 0.5 * (end - begin) * (end - begin) / 8);
  }
};

// The same, with jumps: at each of them the second octahedron is where it would be later.
struct Stepping : Sliding {
  std::vector<double> jumps;
  double later = 0;
  double unknown_from = 2;  // from this time on nothing is known of places

  using Sliding::Sliding;
  void positions(double time, std::span<const VertexId> vertices, std::span<Vec3> at,
                 std::span<double> error) const override {
    const auto passed = std::ranges::count_if(jumps, [&](double jump) { return jump <= time; });
    Sliding::positions(time + later * static_cast<double>(passed), vertices, at, error);
    if (time >= unknown_from) std::ranges::fill(error, std::numeric_limits<double>::infinity());
  }
  std::optional<Jump> next_jump(double begin, double end) const override {
    for (const double jump : jumps)
      if (jump > begin && jump <= end) return Jump{std::nextafter(jump, 0), jump};
    return std::nullopt;
  }
};

// How often a detector was told that a step starts embedded.
int told_embedded = 0;
struct Watched : Detector {
  std::unique_ptr<Detector> detector;
  Report detect(const Step& step, ContactSet& out) override {
    told_embedded += step.starts_embedded;
    return detector->detect(step, out);
  }
};
constexpr Strategy kWatched{.name = "watched",
                            .source = "",
                            .guarantee = Guarantee::complete,
                            .needs = Needs::any_mesh,
                            .kind = StrategyKind::fixed,
                            .make =
                                [](const StrategyInput& setup) {
                                  auto watched = std::make_unique<Watched>();
                                  watched->detector =
                                      compose(std::make_unique<PlainCuller<Kdop16>>(setup), setup);
                                  return Prepared{std::move(watched), {}};
                                },
                            .sees_start = true,
                            .knows_distance = true};

// Two octahedra, the second of which moves as paths say.
struct TwoOctahedra {
  test::Shape shape = test::together(test::octahedron(), test::octahedron(0.8));
  TriangleMesh mesh = shape.mesh();

  TrueMotion motion(const VertexPaths& paths,
                    const TrueMotionOptions& options = true_motion_options(1)) const {
    return {
        paths, {mesh, shape.positions, nullptr, *find_elementary_test("filtered_exact")}, kWatched, options};
  }
};

// Features of surfaces that cross need not be close, and signs say nothing of such a start.
// Mutation: a part that ends with nothing close starts the next one embedded, whatever crosses.
TEST(TrueMotion, TakesNoStartForEmbeddedWherePairsThatCrossAreLeftOut) {
  const TwoOctahedra two;
  for (const bool crosses : {false, true}) {
    const Sliding paths(two.shape.positions, crosses ? 1.0 : 3.0, crosses ? 1.01 : 3.01);
    const std::vector<Vec3> start = paths.pose(0);
    const Crossings at_rest = EmbeddingTest(two.mesh, start).find_all(start, 1000);
    ASSERT_EQ(at_rest.total > 0, crosses);
    const RestCrossings left_out(two.mesh, at_rest);
    TrueMotionOptions options = true_motion_options(1);
    options.coarse = 1e-3;
    options.left_out = &left_out;
    TrueMotion motion = two.motion(paths, options);
    ASSERT_FALSE(motion.meeting_at(0));
    told_embedded = 0;
    const TrueAnswer answer = motion.answer(0, 1);
    EXPECT_EQ(answer.verdict, IntervalVerdict::clear);
    EXPECT_GT(answer.parts, 4u);
    EXPECT_EQ(told_embedded > 0, !crosses);
  }
}

// A jump brings the second octahedron from x = 3 into the first one. Mutation: the pose after a jump at the
// very end is not searched.
TEST(TrueMotion, SearchesThePoseAfterEveryJump) {
  const TwoOctahedra two;
  for (const double at : {0.25, 0.5, 1.0}) {
    Stepping paths(two.shape.positions, 3, 3.01);
    paths.jumps = {at};
    for (const double later : {0.0, -200.0}) {  // -200 times 0.01
      paths.later = later;
      const TrueAnswer answer = two.motion(paths).answer(0, 1);
      EXPECT_EQ(answer.verdict, later < 0 ? IntervalVerdict::intersects_at_start : IntervalVerdict::clear)
          << at;
      EXPECT_EQ(answer.jumps, 1u);
      if (later < 0) {
        EXPECT_EQ(answer.from, at);
      }
    }
  }
}

// Mutations: what is not known of places is taken for clear, at the end of a span or behind a jump.
TEST(TrueMotion, DecidesNothingWherePlacesAreNotKnown) {
  const TwoOctahedra two;
  for (const bool jumps : {false, true})
    for (const double unknown_from : {0.0, 0.3, 1.0}) {
      Stepping paths(two.shape.positions, 3, 3.01);
      if (jumps) paths.jumps = {1};
      paths.unknown_from = unknown_from;
      EXPECT_EQ(two.motion(paths).answer(0, 1).verdict, IntervalVerdict::undecided);
    }
}

// Mutation: the deviation is that of the first stretch alone.
TEST(TrueMotion, LeavesItsLinesByTheMostBetweenAnyTwoJumps) {
  const TwoOctahedra two;
  Stepping paths(two.shape.positions, 3, 3.01);
  paths.jumps = {0.125, 0.875};
  EXPECT_NEAR(two.motion(paths).answer(0, 1).deviation, 0.5 * 0.75 * 0.75 / 8, 1e-6);
}

// Mutation: the largest of deviations passes over one that is no number.
TEST(TrueMotion, SaysNothingOfPathsWithoutABound) {
  struct Unknown : Sliding {
    using Sliding::Sliding;
    void deviations(double, double, std::span<const VertexId>, std::span<double> out) const override {
      std::ranges::fill(out, 0);
      out[0] = std::numeric_limits<double>::quiet_NaN();
    }
  };
  const TwoOctahedra two;
  const Unknown paths(two.shape.positions, 3, 4);
  TrueMotionOptions options = true_motion_options(1);
  options.most_parts = 16;
  EXPECT_EQ(two.motion(paths, options).answer(0, 1).verdict, IntervalVerdict::undecided);
}

// A narrow blade goes through a narrow post within a hundredth of the span: at neither end of a part as long
// as the resolution asks for does it pierce the post. Mutation: nothing is looked at below the resolution.
TEST(TrueMotion, LooksCloserThanTheResolutionWhileItPays) {
  constexpr double kWidth = 0.01;
  // The post stands along z, beside a triangle far away, and the blade lies along y; six vertices each.
  std::vector<Vec3> shape{{0, -0.1, -1.2}, {kWidth, -0.1, -1.2}, {0, -0.1, 1},
                          {0, 50, 0},      {1, 50, 0},           {0, 51, 0}};
  for (const Vec3& x : {Vec3(0, -1.1, -0.2), Vec3(kWidth, -1.1, -0.2), Vec3(0, 0.9, -0.2), Vec3(0, 60, 0),
                        Vec3(1, 60, 0), Vec3(0, 61, 0)})
    shape.push_back(x);
  std::vector<Triangle> triangles;
  for (int t = 0; t < 4; ++t)
    triangles.push_back({VertexId{3 * t}, VertexId{3 * t + 1}, VertexId{3 * t + 2}});
  const TriangleMesh mesh(triangles, shape.size());
  const StrategyInput setup{mesh, shape, nullptr, *find_elementary_test("filtered_exact")};
  const Sliding paths(shape, -0.7, 0.8);
  TrueMotionOptions options{.resolution = 0.01, .coarse = 0.05};
  const TrueAnswer found = TrueMotion(paths, setup, kDrvbcFastComplete, options).answer(0, 1);
  EXPECT_EQ(found.verdict, IntervalVerdict::touches);
  EXPECT_LT(found.to - found.from, 1.0 / 256 + 1e-9);
  options.more_pieces = 0;
  EXPECT_EQ(TrueMotion(paths, setup, kDrvbcFastComplete, options).answer(0, 1).verdict,
            IntervalVerdict::close);
}

// Paths that leave their lines by nothing but rounding.
struct Straight : Sliding {
  using Sliding::Sliding;
  void deviations(double, double, std::span<const VertexId>, std::span<double> out) const override {
    std::ranges::fill(out, 0);
  }
};

// What flies straight through a surface within one part is told at once as near as what lies on it. Mutation:
// nothing so near is looked at in shorter pieces.
TEST(TrueMotion, TellsWhatFliesStraightThrough) {
  const TwoOctahedra two;
  const StrategyInput setup{two.mesh, two.shape.positions, nullptr, *find_elementary_test("filtered_exact")};
  const Straight paths(two.shape.positions, -3, 4);
  TrueMotionOptions options{.resolution = 0.01, .coarse = 0.05};
  EXPECT_EQ(TrueMotion(paths, setup, kDrvbcFastComplete, options).answer(0, 1).verdict,
            IntervalVerdict::touches);
  options.more_pieces = 0;
  EXPECT_EQ(TrueMotion(paths, setup, kDrvbcFastComplete, options).answer(0, 1).verdict,
            IntervalVerdict::close);
}

// A needle's tip goes through a face at a moment at which halving divides the span: there it cannot be told
// whether it has come through. Mutations: nothing is looked at round the ends of pieces; what is proven there
// is not narrowed down.
TEST(TrueMotion, ProvesAContactAtTheMomentThatDividesASpan) {
  std::vector<Vec3> shape{{0, -1, -1}, {0, 2, -1}, {0, -1, 2}, {0, 50, 0}, {1, 50, 0}, {0, 51, 0}};
  for (const Vec3& x :
       {Vec3(0, 0, 0), Vec3(-4, 0, 0), Vec3(-4, 0.01, 0), Vec3(0, 60, 0), Vec3(1, 60, 0), Vec3(0, 61, 0)})
    shape.push_back(x);
  std::vector<Triangle> triangles;
  for (int t = 0; t < 4; ++t)
    triangles.push_back({VertexId{3 * t}, VertexId{3 * t + 1}, VertexId{3 * t + 2}});
  const TriangleMesh mesh(triangles, shape.size());
  const StrategyInput setup{mesh, shape, nullptr, *find_elementary_test("filtered_exact")};
  for (const double at : {0.5, 0.25, 0.8125, 0.3}) {
    SCOPED_TRACE(at);
    const Sliding bent(shape, -at, 1 - at);
    const Straight straight(shape, -at, 1 - at);
    for (const VertexPaths* paths :
         {static_cast<const VertexPaths*>(&bent), static_cast<const VertexPaths*>(&straight)}) {
      const TrueAnswer found =
          TrueMotion(*paths, setup, kDrvbcFastComplete, {.resolution = 0.01, .coarse = 0.05}).answer(0, 1);
      EXPECT_EQ(found.verdict, IntervalVerdict::touches);
      EXPECT_LE(found.from, at);
      EXPECT_GE(found.to, at);
      EXPECT_LT(found.to - found.from, 1.0 / 256 + 1e-9);
    }
  }
}

// Mutation: what touches where a span starts is said to cross.
TEST(TrueMotion, TellsWhatTouchesFromWhatCrosses) {
  const TwoOctahedra two;
  for (const double gap : {0.0, -0.125, 0.125}) {
    // The second octahedron's left corner lies on, in, or before the first one's right one.
    std::vector<Vec3> shape = two.shape.positions;
    for (std::size_t v = 6; v < shape.size(); ++v) shape[v] -= Vec3(0, 0.1, 0.2);
    struct Exact : Straight {
      using Straight::Straight;
      void positions(double, std::span<const VertexId> vertices, std::span<Vec3> at,
                     std::span<double> error) const override {
        for (std::size_t i = 0; i < vertices.size(); ++i) at[i] = rest[+vertices[i]], error[i] = 0;
      }
    };
    double right = 0, left = 0;
    for (std::size_t v = 0; v < shape.size(); ++v)
      (v < 6 ? right : left) = v < 6 ? std::max(right, shape[v].x()) : std::min(left, shape[v].x());
    for (std::size_t v = 6; v < shape.size(); ++v) shape[v] += Vec3(right - left + gap, 0.1, 0.2);
    const Exact paths(shape, 0, 0);
    const auto met = two.motion(paths).meeting_at(0);
    EXPECT_EQ(met.has_value(), gap <= 0) << gap;
    if (met) {
      EXPECT_EQ(met->crosses, gap < 0) << gap;
    }
  }
}

}  // namespace
}  // namespace cscd
