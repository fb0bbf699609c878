#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

#include "scenes/motion/test_rigs.h"

// The bounds on paths against paths that are sampled by the code that poses frames.
namespace cscd::scenes {
namespace {

using namespace test_rigs;

std::vector<VertexId> all_vertices(std::size_t count) {
  std::vector<VertexId> out;
  for (std::size_t v = 0; v < count; ++v) out.push_back(VertexId{static_cast<std::int32_t>(v)});
  return out;
}

// Poses halve angles until chords are straight to 1e-12, and sine and cosine are cut off at 2^-40.
constexpr double kPosing = 1e-10;

struct Seen {
  std::size_t spans = 0, unbounded = 0;  // of short spans alone
  double fullest = 0;                    // the largest share that a path takes of the bound of its span
};

// Compares the paths of a span with its bounds at `samples` times.
void compare(const CharacterMotion& motion, const Character& character, double from, double to, int samples,
             Seen& seen) {
  const std::vector<VertexId> vertices = all_vertices(motion.vertex_count());
  std::vector<double> bound(vertices.size()), error_from(vertices.size()), error_to(vertices.size());
  std::vector<Vec3> start(vertices.size()), end(vertices.size());
  motion.deviations(from, to, vertices, bound);
  motion.positions(from, vertices, start, error_from);
  motion.positions(to, vertices, end, error_to);
  const bool is_short = to - from < 0.01;
  seen.spans += is_short;
  if (!std::isfinite(*std::ranges::max_element(bound))) {
    seen.unbounded += is_short;
    return;
  }
  double most = 0, largest = 0;
  for (int i = 0; i <= samples; ++i) {
    const double share = static_cast<double>(i) / samples, time = from + share * (to - from);
    if (i == samples && motion.next_jump(time - 1e-9, to + 1e-9)) continue;  // on the far side of a jump
    const std::vector<Vec3> at = sampled(character, time);
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const double off = (at[v] - (1 - share) * start[v] - share * end[v]).norm();
      ASSERT_LE(off, bound[v] + error_from[v] + error_to[v] + kPosing)
          << "vertex " << v << " at " << share << " of " << from << " to " << to;
      most = std::max(most, off);
    }
  }
  for (const double b : bound) largest = std::max(largest, b);
  if (largest > 1e-6) seen.fullest = std::max(seen.fullest, most / largest);
}

TEST(MotionBounds, NoPathLeavesThem) {
  for (const auto& [name, kinds] : kinds_of_rigs()) {
    Seen seen;
    for (unsigned seed = 0; seed < 8; ++seed) {
      RigMaker make(100 * seed + 7);
      const Character character = make.tube(kinds, 1 + static_cast<int>(seed % 4));
      validate(character, {});
      const CharacterMotion motion(whole_surface(character));
      for (int n = 0; n < 10; ++n) {
        const double width = std::pow(10, make.uniform(-3, -0.5)), from = make.uniform(0, 1 - width);
        double to = from + width;
        if (const auto jump = motion.next_jump(from, to)) to = jump->before;
        if (!(from < to)) continue;
        SCOPED_TRACE(name + ", seed " + std::to_string(seed));
        compare(motion, character, from, to, 40, seen);
        if (HasFatalFailure()) return;
      }
    }
    EXPECT_LT(seen.unbounded, seen.spans / 4 + 1) << name;
    EXPECT_GT(seen.fullest, 0.4) << name << ": the bounds are far from the paths";
  }
}

TEST(MotionBounds, GrowShortWithTheSquareOfTheSpan) {
  RigMaker make(3);
  const Character character = make.tube({}, 3);
  const CharacterMotion motion(whole_surface(character));
  const std::vector<VertexId> vertices = all_vertices(motion.vertex_count());
  std::vector<double> bound(vertices.size());
  const auto largest = [&](double from, double to) {
    motion.deviations(from, to, vertices, bound);
    return *std::ranges::max_element(bound);
  };
  // Away from keys.
  const double from = 0.02;
  EXPECT_LT(largest(from, from + 0.005), largest(from, from + 0.01) / 3.5);
}

// Each vertex has one bone, and the bone turns at a constant speed about an axis through its origin.
TEST(MotionBounds, OfARigidBodyFallWithTheSquareOfTheSpan) {
  RigMaker make(4);
  Character character = make.tube({}, 1);
  Animation& clip = character.animations[0];
  clip.channels = {{1, {}, {}, {}}};
  clip.channels[0].rotations = {{clip.start, {}}, {clip.start + 1, {std::cos(1), 0, 0, std::sin(1)}}};
  const CharacterMotion motion(whole_surface(character));
  const std::vector<VertexId> vertices = all_vertices(motion.vertex_count());
  std::vector<double> bound(vertices.size());
  double last = 0;
  for (const double h : {0.08, 0.04, 0.02, 0.01}) {
    motion.deviations(0.3, 0.3 + h, vertices, bound);
    const std::vector<Vec3> start = sampled(character, 0.3), middle = sampled(character, 0.3 + h / 2),
                            end = sampled(character, 0.3 + h);
    double largest = 0;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const double off = (middle[v] - (start[v] + end[v]) / 2).norm();
      EXPECT_LE(off, bound[v] + kPosing);
      largest = std::max(largest, off);
    }
    const double most = *std::ranges::max_element(bound);
    EXPECT_LT(most, 1.5 * largest);
    if (last > 0) {
      EXPECT_NEAR(last / most, 4, 0.5);
    }
    last = most;
  }
}

// A tube whose vertices two joints take along by dual quaternions, half each.
Character half_and_half() {
  RigMaker make(9);
  Character character = make.tube({.dual = true}, 2);
  Part& part = character.parts[0];
  part.dual_quaternion.assign(part.positions.size(), 1);
  part.influences.clear();
  for (std::size_t v = 0; v < part.positions.size(); ++v) {
    part.first[v] = part.influences.size();
    part.influences.insert(part.influences.end(), {{0, 0.5}, {1, 0.5}});
  }
  part.first.back() = part.influences.size();
  return character;
}

// A vertex that two joints take to places that stay, half each, while one of them begins to turn about its
// place: what the blend does comes from that joint's angular acceleration alone. Mutation: the second
// derivative of a joint's quaternion without its angular acceleration.
TEST(MotionBounds, HoldTheAngularAccelerationOfDualQuaternions) {
  Character character = half_and_half();
  Part& part = character.parts[0];
  Animation& clip = character.animations[0];
  part.joints[1].offset.origin = -part.positions[0];
  character.nodes[2].local.origin = part.positions[0] + Vec3(0, 1, 0);
  const Quaternion start{std::cos(0.5), 0, 0, std::sin(0.5)}, end{std::cos(0.9), 0, 0, std::sin(0.9)};
  clip.channels = {{2, {}, {}, {}}};
  clip.channels[0].rotations = {{clip.start, start, Between::cubic}, {clip.start + 1, end}};
  const CharacterMotion motion(whole_surface(character));
  Seen seen;
  compare(motion, character, 0, 0.009, 40, seen);
  EXPECT_EQ(seen.unbounded, 0u);
}

TEST(MotionBounds, PlacesAreThoseOfFrames) {
  for (const auto& [name, kinds] : kinds_of_rigs()) {
    RigMaker make(11);
    const Character character = make.tube(kinds, 3);
    const CharacterMotion motion(whole_surface(character));
    const std::vector<VertexId> vertices = all_vertices(motion.vertex_count());
    std::vector<Vec3> at(vertices.size());
    std::vector<double> error(vertices.size());
    for (int i = 0; i <= 24; ++i) {
      const std::vector<Vec3> expected = sampled(character, i / 24.0);
      motion.positions(i / 24.0, vertices, at, error);
      for (std::size_t v = 0; v < vertices.size(); ++v) {
        ASSERT_LE((at[v] - expected[v]).norm(), error[v] + kPosing) << name << ", frame " << i;
        ASSERT_LT(error[v], 1e-10) << name;
      }
    }
  }
}

// Two joints turn against each other, and are half a turn apart at some moment, where a blend of dual
// quaternions jumps. Mutation: what cannot be enclosed ends the program.
TEST(MotionBounds, PlacesWithoutAnEnclosureHaveNoFiniteError) {
  Character character = half_and_half();
  Animation& clip = character.animations[0];
  // From a sixth of a turn to seven twelfths of one, in a second.
  const double from = std::numbers::pi / 6, to = 7 * std::numbers::pi / 12;
  clip.channels = {{2, {}, {}, {}}};
  clip.channels[0].rotations = {{clip.start, {std::cos(from), 0, 0, std::sin(from)}},
                                {clip.start + 1, {std::cos(to), 0, 0, std::sin(to)}}};
  const CharacterMotion motion(whole_surface(character));
  const std::vector<VertexId> vertices = all_vertices(motion.vertex_count());
  std::vector<Vec3> at(vertices.size());
  std::vector<double> error(vertices.size());
  std::size_t unknown = 0;
  for (int i = -200; i <= 200; ++i) {
    motion.positions(0.8 + i * 0x1p-53, vertices, at, error);
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      ASSERT_TRUE(at[v].allFinite());
      unknown += error[v] == std::numeric_limits<double>::infinity();
    }
  }
  EXPECT_GT(unknown, 0u);
}

// What a key that turns at a constant speed is at one moment, and how fast, against the same in numbers of 64
// bits of precision. Mutations: a thousandth of the bound on roundings; slerp the long way round.
TEST(MotionBounds, TurnsAreOffByNoMoreThanTheirRounding) {
  using Matrix = Eigen::Matrix<long double, 3, 3>;
  using Turn = Eigen::Quaternion<long double>;
  RigMaker make(5);
  long double worst = 0;
  for (int i = 0; i < 20'000; ++i) {
    const auto quaternion = [&] {
      return Quaternion{make.uniform(-1, 1), make.uniform(-1, 1), make.uniform(-1, 1), make.uniform(-1, 1)};
    };
    const Quaternion a = quaternion();
    Quaternion b = quaternion();
    if (i % 4 == 0) {  // next to no turn
      const double little = std::ldexp(1.0, -2 - i % 50);
      b = {a.w + little * b.w, a.x + little * b.x, a.y + little * b.y, a.z + little * b.z};
    }
    const double start = make.uniform(-2, 2), end = start + make.uniform(0.01, 2),
                 at = start + make.uniform(0, 1) * (end - start);
    const std::vector<Key<Quaternion>> keys = {{start, a}, {end, b}};
    const std::optional<MovingMatrix> found = turning_of(keys, {at, at});
    ASSERT_TRUE(found);
    const auto unit = [](const Quaternion& q) {
      return Turn(static_cast<long double>(q.w), static_cast<long double>(q.x), static_cast<long double>(q.y),
                  static_cast<long double>(q.z))
          .normalized();
    };
    const Turn from = unit(a), to = unit(b);
    const Turn by = from.dot(to) < 0 ? Turn(-(to * from.conjugate()).coeffs()) : to * from.conjugate();
    const long double length = by.vec().norm(), angle = 2 * std::atan2(length, by.w());
    const Eigen::Matrix<long double, 3, 1> axis = length > 0
                                                      ? Eigen::Matrix<long double, 3, 1>(by.vec() / length)
                                                      : Eigen::Matrix<long double, 3, 1>::UnitX();
    const long double whole = static_cast<long double>(end) - start,
                      share = (static_cast<long double>(at) - start) / whole;
    const Matrix value = (Eigen::AngleAxis<long double>(share * angle, axis) * from).toRotationMatrix();
    Matrix cross;
    cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
    const Matrix rate = (angle / whole) * cross * value;
    const auto off = [&](const Ball<Eigen::Matrix3d>& ball, const Matrix& truth) {
      const long double away = (ball.centre.cast<long double>() - truth).norm();
      EXPECT_LE(away, ball.radius) << i;
      worst = std::max(worst, away / ball.radius);
    };
    off(found->value, value);
    off(found->rate, rate);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(worst, 1e-3) << "the bound is of use";
}

TEST(MotionBounds, StepsAreJumps) {
  RigMaker make(5);
  Character character = make.tube({}, 2);
  character.animations[0].start = 0.3;
  for (Key<Quaternion>& key : character.animations[0].channels[1].rotations) key.next = Between::constant;
  const CharacterMotion motion(whole_surface(character));
  const auto jump = motion.next_jump(0, 1);
  ASSERT_TRUE(jump);
  EXPECT_LT(jump->before, jump->after);
  EXPECT_LT(jump->after - jump->before, 1e-15);
  const std::vector<VertexId> vertices = all_vertices(motion.vertex_count());
  std::vector<double> bound(vertices.size());
  motion.deviations(0, jump->before, vertices, bound);
  EXPECT_TRUE(std::isfinite(bound[0]));
  motion.deviations(jump->before, jump->after, vertices, bound);
  EXPECT_FALSE(std::isfinite(bound[0]));
  EXPECT_NE(sampled(character, jump->before), sampled(character, jump->after));
}

}  // namespace
}  // namespace cscd::scenes
