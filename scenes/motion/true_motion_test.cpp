#include "core/session/true_motion.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <map>

#include "core/detect/start/embedding.h"
#include "core/elementary/catalogue.h"
#include "core/fast/drvbc_fast.h"
#include "scenes/motion/test_rigs.h"

// Verdicts about the true motion of random skinned tubes and hands that bend and twist by up to half a turn
// in a step, against exact static tests of poses that are sampled by the code that poses frames.
namespace cscd::scenes {
namespace {

using namespace test_rigs;

constexpr double kHalfTurn = 0.5;

// CSCD_TRUE_MOTION_STEPS=2000 CSCD_TRUE_MOTION_SAMPLES=10000 asks for the full comparison.
int wanted(const char* name, int otherwise) {
  const char* const text = std::getenv(name);
  return text != nullptr ? std::atoi(text) : otherwise;
}

TriangleMesh mesh_of(const Character& character) {
  std::vector<Triangle> triangles;
  for (const auto& t : character.parts[0].triangles)
    triangles.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
  return TriangleMesh(triangles, character.parts[0].positions.size());
}

double mean_edge_of(const TriangleMesh& mesh, std::span<const Vec3> at) {
  double sum = 0;
  for (const Edge& e : mesh.edges()) sum += (at[+e[0]] - at[+e[1]]).norm();
  return sum / static_cast<double>(mesh.edge_count());
}

struct Tally {
  std::map<IntervalVerdict, int> verdicts;
  int crossing = 0;  // steps in which some sample crosses
};

// Asks about one step of a second and holds the answer against `samples` poses. Steps that start crossing are
// passed over.
void compare_step(const Character& character, int samples, Tally& tally) {
  const TriangleMesh mesh = mesh_of(character);
  const CharacterMotion motion(whole_surface(character));
  const std::vector<Vec3> start = sampled(character, 0);
  const StrategyInput setup{mesh, start, nullptr, *find_elementary_test("filtered_exact")};
  EmbeddingTest plain(mesh, start);
  if (!plain.embedded(start)) return;
  const double edge = mean_edge_of(mesh, character.parts[0].positions);
  TrueMotion asked(motion, setup, kDrvbcFastComplete, {.resolution = edge / 100, .coarse = edge / 2});
  const TrueAnswer answer = asked.answer(0, 1);
  ++tally.verdicts[answer.verdict];
  bool crosses = false;
  // The first samples may be of any time; those of a `clear` are all asked about.
  for (int i = 0; i <= samples && !crosses; ++i)
    crosses = !plain.embedded(sampled(character, i / double(samples)));
  tally.crossing += crosses;
  if (answer.verdict == IntervalVerdict::clear) {
    EXPECT_FALSE(crosses) << "missed by a clear";
  }
  if (answer.verdict == IntervalVerdict::touches) {
    ASSERT_TRUE(answer.pair);
    EXPECT_LE(answer.to - answer.from, 1);
    const auto meet_at = [&](double time) {
      return plain.find_all(sampled(character, time), 1 << 20).contains(*answer.pair);
    };
    // Both triangles may cross before by other edges.
    EXPECT_TRUE(meet_at(answer.parts_again ? answer.from : answer.to));
  }
}

// A spindle along x whose tip is 2 from the axis z, and a plate above it. A bone turns the spindle about z by
// `turn` in a second and moves it along z; a second bone, halfway to the tip, turns by `more`.
struct Spindle {
  static constexpr double kHeight = 0.75;  // of the plate
  double turn, more;
  test::Shape shape = test::together(test::octahedron(0.5), test::box({-5, kHeight, -4}, {5, 2, 5}));

  Character character() const {
    Character out;
    out.nodes = {{"root", -1, Transform()}, {"first", 0, Transform()}, {"second", 1, Transform()}};
    out.nodes[2].local.origin = Vec3(1, 0, 0);
    Part part;
    part.node = 0;
    part.joints = {{0, Transform()}, {2, Transform()}};
    for (const Vec3& x : shape.positions) {
      const bool is_spindle = part.positions.size() < 6;
      part.first.push_back(part.influences.size());
      part.influences.push_back({is_spindle ? 1 : 0, 1});
      // The spindle's points are those that its bone sees, half of it on either side of the middle.
      part.positions.push_back(is_spindle ? Vec3(x.x() + 0.5, x.y() / 20, x.z() / 20) : x);
    }
    part.first.push_back(part.influences.size());
    for (const Triangle& t : shape.triangles)
      part.triangles.push_back({static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]),
                                static_cast<std::int32_t>(t[2])});
    Animation clip{"clip", 0, 1, 0, {}};
    const auto turned = [](double angle) {
      return std::vector<Key<Quaternion>>{{0, {}}, {1, {std::cos(angle / 2), 0, 0, std::sin(angle / 2)}}};
    };
    clip.channels = {{1, {{0, Vec3::Zero()}, {1, Vec3(0, 0, 0.3)}}, turned(turn), {}},
                     {2, {}, turned(more), {}}};
    out.parts = {part};
    out.animations = {clip};
    out.format = "test";
    return out;
  }
  double tip_height(double time) const { return std::sin(turn * time) + std::sin((turn + more) * time); }
  // When the tip reaches the plate. It rises all the time.
  double contact() const {
    double low = 0, high = 1;
    for (int i = 0; i < 100; ++i) {
      const double middle = (low + high) / 2;
      (tip_height(middle) < kHeight ? low : high) = middle;
    }
    return high;
  }
};

// Mutation: a bound that is too large by a thousandth.
TEST(TrueMotion, OfRigidBodiesClosesInOnTheirScrew) {
  const CharacterMotion motion(whole_surface(Spindle{0.5, 0}.character()));
  const std::vector<VertexId> tip{VertexId{0}};
  double last = 1;
  for (double h = 0.1; h > 1e-4; h /= 2) {
    double bound = 0;
    motion.deviations(0.3, 0.3 + h, tip, {&bound, 1});
    // An arc of radius 2 leaves the middle of its chord by this much.
    const double off = 4 * std::pow(std::sin(0.5 * h / 4), 2);
    EXPECT_GE(bound, off * (1 - 1e-6)) << h;
    const double more = bound / off - 1;
    EXPECT_LT(more, 0.6 * last) << h;
    last = more;
  }
  EXPECT_LT(last, 1e-3);
}

// A screw, and two bones of which one turns the other. Mutation: places a thousandth of a second late.
TEST(TrueMotion, OfRigidAndArticulatedBodiesClosesInOnTheTimeOfContact) {
  for (const Spindle& spindle : {Spindle{0.5, 0}, Spindle{0.5, 0.7}}) {
    const Character character = spindle.character();
    const TriangleMesh mesh = mesh_of(character);
    const CharacterMotion motion(whole_surface(character));
    const std::vector<Vec3> start = sampled(character, 0);
    const StrategyInput setup{mesh, start, nullptr, *find_elementary_test("filtered_exact")};
    const double contact = spindle.contact();
    for (const double share : {0x1p-4, 0x1p-8, 0x1p-12, 0x1p-16, 0x1p-20}) {
      TrueMotion asked(motion, setup, kDrvbcFastComplete,
                       {.resolution = share / 4, .coarse = 0.05, .narrow = share});
      const TrueAnswer answer = asked.answer(0, 1);
      ASSERT_EQ(answer.verdict, IntervalVerdict::touches) << share;
      EXPECT_LE(answer.from, contact) << share;
      EXPECT_GE(answer.to, contact) << share;
      EXPECT_LE(answer.to - answer.from, share);
    }
  }
}

template <class Make>
void compare_steps(const Make& rig, int steps, int samples, unsigned seed, Tally& tally) {
  for (int step = 0; step < steps; ++step) {
    SCOPED_TRACE("step " + std::to_string(step) + ", seed " + std::to_string(seed));
    RigMaker make(seed + 1000 * static_cast<unsigned>(step));
    compare_step(rig(make, step), samples, tally);
    if (testing::Test::HasFailure()) break;
  }
}

TEST(TrueMotion, VerdictsOnRandomTubesAndHandsAreTrue) {
  const int steps = wanted("CSCD_TRUE_MOTION_STEPS", 36), samples = wanted("CSCD_TRUE_MOTION_SAMPLES", 60);
  Tally all;
  for (const auto& [name, kinds] : std::vector<std::pair<std::string, Kinds>>{
           {"linear", {}}, {"cubic", {.cubic = true}}, {"dual quaternions", {.dual = true}}}) {
    SCOPED_TRACE(name);
    const auto tube = [&, &kinds = kinds](RigMaker& make, int step) {
      return make.bending_tube(kinds, kHalfTurn, 2 + step % 4);
    };
    const auto hand = [&, &kinds = kinds](RigMaker& make, int step) {
      return make.bending_hand(kinds, step % 4 == 0 ? kHalfTurn : kHalfTurn / 4);
    };
    compare_steps(tube, steps / 6, samples, 17, all);
    compare_steps(hand, steps / 6, samples, 18, all);
  }
  std::printf("%d clear, %d touch, %d close, %d undecided; %d cross in some sample\n",
              all.verdicts[IntervalVerdict::clear], all.verdicts[IntervalVerdict::touches],
              all.verdicts[IntervalVerdict::close], all.verdicts[IntervalVerdict::undecided], all.crossing);
  EXPECT_GT(all.verdicts[IntervalVerdict::clear], steps / 6);
  EXPECT_GT(all.verdicts[IntervalVerdict::touches], steps / 6);
  EXPECT_LE(all.verdicts[IntervalVerdict::close] + all.verdicts[IntervalVerdict::undecided], steps / 10);
}

}  // namespace
}  // namespace cscd::scenes
