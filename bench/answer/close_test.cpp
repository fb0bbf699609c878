#include <gtest/gtest.h>
#include <map>

#include "bench/answer/answer.h"
#include "bench/inputs/test_inputs.h"
#include "bench/inputs/thickness.h"
#include "bench/strategies/catalogue.h"
#include "core/mesh/adjacency.h"

// Answers to intervals with a thickness, held against every pair of features.
namespace cscd::bench {
namespace {

Input thick_balls(std::initializer_list<double> shifts, const std::string& thickness, int rings = 0) {
  Input input = two_balls(shifts);
  set_thickness(input, {.thickness = parse_length("--thickness", thickness), .rings = rings});
  return input;
}

// The earliest time at which each pair comes within a distance.
std::map<FeaturePair, double> within(const Input& input, const Motion& motion, double distance) {
  const TriangleMesh& mesh = input.mesh;
  std::map<FeaturePair, double> out;
  const auto ask = [&](const FeaturePair& pair) {
    if (input.thickness.left_out && input.thickness.left_out->excludes(mesh, pair)) return;
    const Answer said = ask_close(elementary_test_named("exact"), mesh, motion, pair, distance);
    if (said.verdict == Verdict::contact) out.emplace(pair, said.time);
  };
  const auto triangles = static_cast<std::int32_t>(mesh.triangle_count()),
             edges = static_cast<std::int32_t>(mesh.edge_count());
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(mesh.vertex_count()); ++v)
    for (std::int32_t t = 0; t < triangles; ++t)
      if (!contains(mesh.corners(TriangleId{t}), VertexId{v}))
        ask(FeaturePair::of(VertexId{v}, TriangleId{t}));
  for (std::int32_t e = 0; e < edges; ++e)
    for (std::int32_t f = e + 1; f < edges; ++f)
      if (!share_vertex(mesh.ends(EdgeId{e}), mesh.ends(EdgeId{f})))
        ask(FeaturePair::of(EdgeId{e}, EdgeId{f}));
  return out;
}

std::vector<IntervalVerdict> expect_right(Input input, const std::string& strategy) {
  Answerer answerer(input, strategy_named(strategy), elementary_test_named("filtered_exact"), {});
  std::vector<IntervalVerdict> verdicts;
  for (std::size_t i = 0; i < input.clip->interval_count(); ++i) {
    const IntervalAnswer answer = answerer.answer(i, input.clip->load(i));
    verdicts.push_back(answer.verdict);
    const scenes::ClipInterval interval = input.clip->load(i);
    const auto close = within(input, interval.motion, input.thickness.length),
               touching = within(input, interval.motion, 0);
    EXPECT_EQ(answer.found.contacts.size(), close.size()) << i;
    for (const Contact& contact : answer.found.contacts) {
      const auto expected = close.find(contact.pair);
      if (expected == close.end()) {
        ADD_FAILURE() << i << ": a pair that never comes close";
        continue;
      }
      EXPECT_EQ(contact.time, expected->second);
    }
    EXPECT_EQ(answer.touching, touching) << i;
    EXPECT_EQ(answer.close_at_start, static_cast<std::size_t>(std::ranges::count_if(
                                         close, [](const auto& one) { return one.second == 0; })))
        << i;
    EXPECT_TRUE(answer.proven) << i;
  }
  return verdicts;
}

constexpr auto kClear = IntervalVerdict::clear, kClose = IntervalVerdict::close,
               kTouches = IntervalVerdict::touches, kCrosses = IntervalVerdict::intersects_at_start;

// Mutations: verdicts by contacts alone; the thickness is not asked of the strategy; what touches is not
// told from what is close.
TEST(Close, ComesBetweenClearAndTouching) {
  // The gap is more than 0.6 at first, and the balls touch before the second one has moved by 1.2.
  for (const char* strategy : {"drvbc_fast_all", "drvbc_fast_complete", "base"})
    EXPECT_EQ(
        expect_right(thick_balls({0, -0.3, -0.95, -0.95, -0.97, -1.2, -1.2, -0.5, 0}, "0.25"), strategy),
        (std::vector{kClear, kClose, kClose, kClose, kTouches, kCrosses, kCrosses, kClear}))
        << strategy;
}

TEST(Close, IsTouchingAtThicknessZero) {
  EXPECT_EQ(expect_right(thick_balls({0, -0.95, -1.2, -1.2}, "0.001"), "drvbc_fast_all"),
            (std::vector{kClear, kTouches, kCrosses}));
  Input input = thick_balls({0, -0.95, -1.2, -1.2}, "0");
  Answerer answerer(input, strategy_named("drvbc_fast_all"), elementary_test_named("filtered_exact"), {});
  EXPECT_EQ(answerer.answer(0, input.clip->load(0)).verdict, kClear);
  const IntervalAnswer touches = answerer.answer(1, input.clip->load(1));
  EXPECT_EQ(touches.verdict, kTouches);
  EXPECT_TRUE(touches.touching.empty()) << "contacts say it";
}

// At so large a thickness every ball is close to itself. Mutation: pairs are left out that are not near.
TEST(Close, LeavesOutWhatIsNearOnTheSurfaceWhereAsked) {
  EXPECT_EQ(expect_right(thick_balls({0, -0.3, -0.6}, "1e"), "drvbc_fast_complete"),
            (std::vector{kClose, kClose}));
  EXPECT_EQ(expect_right(thick_balls({0, -0.3, -0.6}, "1e", 3), "drvbc_fast_complete"),
            (std::vector{kClear, kClose}));
}

}  // namespace
}  // namespace cscd::bench
