#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "scenes/import/fbx/test_fbx.h"

namespace cscd::scenes {
namespace {

constexpr double kConstant = 2, kNext = 0x102, kLinear = 4, kCubicUser = 0x408, kCubicAuto = 0x2108,
                 kCubicTcb = 0x208, kWeighted = 0x3000408;

// A triangle on one node whose x is a curve.
FbxText sliding(const std::vector<double>& times, const std::vector<double>& values,
                const std::vector<double>& flags = {}, const std::vector<double>& data = {}) {
  FbxText file = triangle_file(property("Lcl Translation", {9, 8, 7}));
  file.clip(0, 2);
  file.curve_node(60, 51, 20, "Lcl Translation", property("d|Y", {5}));
  file.curve(61, 60, "d|X", times, values, flags, data);
  return file;
}

double x_at(const Character& character, double seconds) {
  return vertices_at(character, seconds)[1].x();  // the vertex (0, 1, 0)
}

TEST(FbxAnimation, AComponentWithoutCurveTakesTheNodesValueThenTheModels) {
  const Character character = read(sliding({0, 1}, {1, 2}, {kLinear, kLinear}));
  const Vec3 vertex = vertices_at(character, 0.5)[1];
  EXPECT_NEAR(vertex.x(), 1.5, 1e-12);
  EXPECT_NEAR(vertex.y(), 5 + 1, 1e-12);
  EXPECT_NEAR(vertex.z(), 7, 1e-12);
}

TEST(FbxAnimation, KeysThatHoldStepAtTheirOwnTime) {
  const Character character = read(sliding({0, 1.1, 2}, {1, 4, 6}, {kConstant, kNext, kConstant}));
  EXPECT_EQ(x_at(character, 0.9), 1);
  // The step must act however the time of the key was rounded.
  EXPECT_EQ(x_at(character, std::nextafter(1.1, 0)), 4);
  EXPECT_EQ(x_at(character, std::nextafter(1.1, 2)), 4);
  EXPECT_EQ(x_at(character, 1.2), 6);
}

double hermite(double p, double m, double q, double n, double length, double s) {
  return (2 * s * s * s - 3 * s * s + 1) * p + (s * s * s - 2 * s * s + s) * length * m +
         (3 * s * s - 2 * s * s * s) * q + (s * s * s - s * s) * length * n;
}

TEST(FbxAnimation, CubicKeysFollowTheirStoredSlopes) {
  const Character character =
      read(sliding({0, 2}, {1, 3}, {kCubicUser, kCubicUser}, {1.5, -2.5, 0, 0, 0, 0, 0, 0}));
  for (const double time : {0.3, 1.0, 1.7})
    EXPECT_NEAR(x_at(character, time), hermite(1, 1.5, 3, -2.5, 2, time / 2), 1e-12);
}

// Newer text files write the bits of slopes as integers: 1069547520 is 1.5, and -1071644672 is -2.5.
TEST(FbxAnimation, SlopesMayBeWrittenAsTheirBits) {
  const Character character = read(sliding({0, 2}, {1, 3}, {kCubicUser, kCubicUser},
                                           {1069547520, -1071644672, 218434821, 0, 0, 0, 218434821, 0}));
  EXPECT_NEAR(x_at(character, 1), hermite(1, 1.5, 3, -2.5, 2, 0.5), 1e-12);
}

TEST(FbxAnimation, WeightedTangentsAreBezierCurvesInThePlane) {
  // Weights of 0.6 after the first key and 0.2 before the next, packed as ten-thousandths.
  const double packed = 6000 + 65536.0 * 2000;
  const Character character =
      read(sliding({0, 2}, {1, 3}, {kWeighted, kWeighted}, {1.5, -2.5, packed, 0, 0, 0, packed, 0}));
  for (const double time : {0.25, 1.0, 1.6}) {
    const auto bezier = [](double a, double b, double c, double d, double s) {
      return std::pow(1 - s, 3) * a + 3 * std::pow(1 - s, 2) * s * b + 3 * (1 - s) * s * s * c +
             s * s * s * d;
    };
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      (bezier(0, 1.2, 1.6, 2, middle) < time ? low : high) = middle;
    }
    EXPECT_NEAR(x_at(character, time), bezier(1, 1 + 1.5 * 1.2, 3 + 2.5 * 0.4, 3, low), 1e-6);
  }
}

TEST(FbxAnimation, AutomaticAndTcbKeysTakeTheirSlopesFromTheirNeighbours) {
  for (const double flags : {kCubicAuto, kCubicTcb}) {
    const Character character = read(sliding({0, 1, 2}, {0, 1, 4}, {flags, flags, flags}));
    const double middle = flags == kCubicAuto ? 2 : 0.5 * (1 + 3);
    EXPECT_NEAR(x_at(character, 0.5), hermite(0, 1, 1, middle, 1, 0.5), 1e-9);
    EXPECT_NEAR(x_at(character, 1.5), hermite(1, middle, 4, 3, 1, 0.5), 1e-9);
  }
}

TEST(FbxAnimation, TheStackSaysWhichPartOfTheKeysIsShown) {
  FbxText file = sliding({-1, 3}, {0, 4}, {kLinear, kLinear});
  const Character character = read(file);
  ASSERT_EQ(character.animations.size(), 1u);
  EXPECT_EQ(character.animations[0].start, 0);
  EXPECT_NEAR(character.animations[0].seconds, 2, 1e-12);
  EXPECT_NEAR(x_at(character, 0), 1, 1e-9);
  EXPECT_NEAR(x_at(character, 2), 3, 1e-9);
}

TEST(FbxAnimation, WithoutARangeTheKeysGiveIt) {
  FbxText file = sliding({0.5, 1.25}, {0, 4}, {kLinear, kLinear});
  const std::size_t start = file.objects.find("P: \"LocalStart\"");
  file.objects.erase(start, file.objects.find("}\n", start) - start);
  const Character character = read(file);
  EXPECT_NEAR(character.animations[0].start, 0.5, 1e-12);
  EXPECT_NEAR(character.animations[0].seconds, 0.75, 1e-12);
}

TEST(FbxAnimation, TicksMayBeTheNewOnes) {
  FbxText file = sliding({0, 1}, {0, 4}, {kLinear, kLinear});
  std::string text = file.text();
  text.insert(text.find(" FBXVersion"), " FBXHeaderVersion: 1004\n OtherFlags:  {\n  TCDefinition: 0\n }\n");
  const Character character = read_fbx(text, {});
  EXPECT_NEAR(character.animations[0].seconds, 2 * 46186158000.0 / 141120000.0, 1e-9);
}

FbxText layered(const std::string& properties, double x) {
  FbxText file = sliding({0, 1}, {1, 2}, {kLinear, kLinear});
  file.layer(52, properties);
  file.curve_node(70, 52, 20, "Lcl Translation",
                  property("d|X", {0}) + property("d|Y", {0}) + property("d|Z", {0}));
  file.curve(71, 70, "d|X", {0, 0.5, 1}, {x, x, x + 10}, {kLinear, kLinear, kLinear});
  return file;
}

TEST(FbxAnimation, LayersAddReplaceOrAreMuted) {
  EXPECT_NEAR(x_at(read(layered("", 100)), 0.75), 1.75 + 105, 1e-9) << "added";
  EXPECT_NEAR(x_at(read(layered(property("Weight", {50}), 100)), 0.75), 1.75 + 52.5, 1e-9) << "half of it";
  EXPECT_NEAR(x_at(read(layered(property("BlendMode", {1}), 100)), 0.75), 105, 1e-9) << "replaces";
  EXPECT_NEAR(x_at(read(layered(property("BlendMode", {2}) + property("Weight", {25}), 100)), 0.75),
              0.75 * 1.75 + 0.25 * 105, 1e-9)
      << "passes through";
  EXPECT_NEAR(x_at(read(layered(property("Mute", {1}), 100)), 0.75), 1.75, 1e-9) << "muted";
  EXPECT_NEAR(x_at(read(layered(property("Weight", {0}), 100)), 0.75), 1.75, 1e-9) << "without weight";
}

TEST(FbxAnimation, TheWeightOfALayerMayChange) {
  // The weight rises from -50 to 150 per cent in one second; shares end at 0 and 1.
  for (const double mode : {0.0, 1.0, 2.0}) {
    FbxText file = layered(property("BlendMode", {mode}) + property("Weight", {30}), 100);
    file.curve_node(90, 52, 52, "Weight", property("d|Weight", {30}));
    file.curve(91, 90, "d|Weight", {0, 1}, {-50, 150}, {kLinear, kLinear});
    const Character character = read(file);
    for (const double time : {0.125, 0.5, 0.625, 0.875}) {
      const double share = std::clamp(2 * time - 0.5, 0.0, 1.0), below = 1 + time,
                   own = time < 0.5 ? 100 : 100 + 20 * (time - 0.5);
      const double expected = mode == 0   ? below + share * own
                              : mode == 1 ? own
                                          : (1 - share) * below + share * own;
      EXPECT_NEAR(x_at(character, time), expected, 1e-9) << "mode " << mode << ", time " << time;
    }
  }
}

// A node that two layers turn and scale. The upper layer's weight falls from 100 to 0 per cent in two
// seconds.
FbxText turning(double mode, double by_channel, double order = 0) {
  FbxText file = sliding({0, 1}, {0, 0}, {kLinear, kLinear});
  file.objects.insert(file.objects.find("P: \"Lcl Translation\""),
                      property("RotationOrder", {order}) + property("RotationActive", {1}));
  file.layer(52, property("BlendMode", {mode}) + property("RotationAccumulationMode", {by_channel}) +
                     property("ScaleAccumulationMode", {by_channel}));
  file.curve_node(90, 52, 52, "Weight", "");
  file.curve(91, 90, "d|Weight", {0, 2}, {100, 0}, {kLinear, kLinear});
  file.curve_node(80, 51, 20, "Lcl Rotation", property("d|X", {40}) + property("d|Z", {-30}));
  file.curve(81, 80, "d|Y", {0, 1}, {0, 90}, {kLinear, kLinear});
  file.curve_node(82, 52, 20, "Lcl Rotation", property("d|X", {-20}) + property("d|Y", {50}));
  file.curve(83, 82, "d|Z", {0, 1}, {10, 100}, {kLinear, kLinear});
  file.curve_node(84, 51, 20, "Lcl Scaling", property("d|Y", {3}) + property("d|Z", {4}));
  file.curve(85, 84, "d|X", {0, 1}, {1, 2}, {kLinear, kLinear});
  file.curve_node(86, 52, 20, "Lcl Scaling", property("d|X", {4}) + property("d|Y", {0.25}));
  file.curve(87, 86, "d|Z", {0, 1}, {-1, -9}, {kLinear, kLinear});
  return file;
}

// The share of a rotation, about its own axis.
Transform share_of_turn(const Transform& turn, double share) {
  const double angle = std::acos((turn.column[0].x() + turn.column[1].y() + turn.column[2].z() - 1) / 2);
  const Vec3 axis = Vec3(turn.column[1].z() - turn.column[2].y(), turn.column[2].x() - turn.column[0].z(),
                         turn.column[0].y() - turn.column[1].x()) /
                    (2 * std::sin(angle));
  Transform part;
  const double c = std::cos(share * angle), s = std::sin(share * angle);
  for (int k = 0; k < 3; ++k) {  // Rodrigues' formula
    const Vec3 x = Vec3::Unit(k);
    part.column[static_cast<std::size_t>(k)] = c * x + s * axis.cross(x) + (1 - c) * axis.dot(x) * axis;
  }
  return part;
}

TEST(FbxAnimation, LayersTurnAndScaleByChannelOrAsMaps) {
  const std::array<int, 3> zxy = {2, 0, 1};
  for (const double mode : {0.0, 2.0})
    for (const bool by_channel : {false, true}) {
      // The order of axes is ZXY, except where that is refused.
      const bool xyz = mode == 2 && !by_channel;
      const std::array<int, 3> order = xyz ? std::array{0, 1, 2} : zxy;
      const Character character = read(turning(mode, by_channel, xyz ? 0 : 4));
      for (const double time : {0.0, 0.5, 1.0, 1.6, 2.0}) {
        const double t = std::min(time, 1.0), w = 1 - time / 2, keep = mode == 0 ? 1 : 1 - w;
        const Vec3 below_turn(40, 90 * t, -30), own_turn(-20, 50, 10 + 90 * t);
        const Vec3 below_scale(1 + t, 3, 4), own_scale(4, 0.25, -1 - 8 * t);
        Transform turn = turned(keep * below_turn + w * own_turn, order);
        Vec3 scale = keep * below_scale + w * own_scale;
        if (!by_channel) {
          const Transform below = turned(below_turn, order), own = turned(own_turn, order);
          turn = mode == 0 ? composed(below, share_of_turn(own, w))
                           : composed(below, share_of_turn(composed(inverse(below), own), w));
          for (int k = 0; k < 3; ++k) {
            const double sign = own_scale[k] < 0 && w > 0 ? -1 : 1;
            scale[k] = std::pow(below_scale[k], keep) * sign * std::pow(std::abs(own_scale[k]), w);
          }
        }
        const Transform expected = product({moved({0, 5, 7}), turn, scaled_by(scale)});
        const std::vector<Vec3> was = vertices_at(character, time);
        for (std::size_t v = 0; v < 3; ++v)
          EXPECT_LT((was[v] - expected(kPoints[v])).norm(), 1e-9)
              << "mode " << mode << ", by channel " << by_channel << ", time " << time << ", vertex " << v;
      }
    }
}

TEST(FbxAnimation, LayersOfRotationsWithoutADeterminedResultAreRefusedByName) {
  EXPECT_EQ(refusal_of(turning(2, 1, 4)), "");
  EXPECT_TRUE(says(refusal_of(turning(2, 0, 4)),
                   "'node', clip 'clip': a layer overrides rotations with a weight and by layer"));
  FbxText mixed = turning(0, 0);
  mixed.layer(53, property("RotationAccumulationMode", {1}));
  mixed.curve_node(95, 53, 20, "Lcl Rotation", property("d|X", {10}));
  EXPECT_TRUE(says(refusal_of(mixed), "a layer adds angles by channel above"));
  FbxText bypass = layered(property("BlendModeBypass", {131584}), 100);
  EXPECT_EQ(refusal_of(bypass), "") << "switches and enumerations";
  bypass = layered(property("BlendModeBypass", {1 << 14}), 100);
  EXPECT_TRUE(says(refusal_of(bypass), "layer 'layer52' does not apply its blend mode"));
  FbxText nan = layered("", 100);
  nan.curve_node(90, 52, 52, "Weight", property("d|Weight", {std::nan("")}));
  EXPECT_TRUE(says(refusal_of(nan), "layer 'layer52' has a weight that is no number"));
}

// A curve from (0, 1) over (0.25, 3) to (1, 2) that goes on by `kind` in both directions.
FbxText going_on(const std::string& kind, const std::string& count = "-1") {
  FbxText file = sliding({0, 0.25, 1}, {1, 3, 2}, {kLinear, kLinear, kLinear});
  const std::string body = "-Extrapolation: {\n Type: " + kind + "\n Repetition: " + count + "\n}\n";
  file.objects.insert(file.objects.find("KeyTime"), "Pre" + body + "Post" + body);
  return file;
}

TEST(FbxAnimation, CurvesGoOnBeyondTheirKeys) {
  const auto at = [](const std::string& kind, double time, const std::string& count = "-1") {
    return x_at(read(going_on(kind, count)), time);
  };
  for (const double cycle : {-3.0, 1.0, 2.0, 1e6}) {
    EXPECT_NEAR(at("R", cycle + 0.25), 3, 1e-8) << "repeats, cycle " << cycle;
    EXPECT_NEAR(at("A", cycle + 0.25), 3 + cycle, 1e-8) << "rises, cycle " << cycle;
    const bool back = cycle != 2 && cycle != 1e6;
    EXPECT_NEAR(at("M", cycle + (back ? 0.75 : 0.25)), 3, 1e-8) << "mirrors, cycle " << cycle;
  }
  EXPECT_NEAR(at("K", -2), 1 - 2 * 8, 1e-12);
  EXPECT_NEAR(at("K", 4), 2 - 3 / 0.75, 1e-12);
  EXPECT_EQ(at("C", 4), 2);
  EXPECT_NEAR(at("R", 1.25, "1"), 3, 1e-9);
  EXPECT_EQ(at("R", 2.25, "1"), 2) << "holds after one repetition";
  EXPECT_EQ(at("R", 1.25, "0"), 2) << "no repetition";
  EXPECT_EQ(at("M", 2.25, "1"), 1) << "a repetition backwards ends at the first key";
  EXPECT_NEAR(at("82", 1.25), 3, 1e-9) << "binary files write the number of the letter R";
  const Character unknown = read(going_on("Q"));
  EXPECT_EQ(x_at(unknown, 4), 2);
  ASSERT_EQ(unknown.notes.size(), 1u);
  EXPECT_TRUE(says(unknown.notes[0], "go on in an unknown way"));
}

// A file can ask for 10^18 repetitions of keys that are one tick apart.
TEST(FbxAnimation, RepetitionsCostNothing) {
  const double tick = 1 / 46186158000.0;
  for (const char* kind : {"R", "A", "M", "K"}) {
    FbxText file = sliding({0, tick}, {1, 2}, {kLinear, kLinear});
    const std::string body =
        "Post-Extrapolation: {\n Type: " + std::string(kind) + "\n Repetition: 1000000000000000000\n}\n";
    file.objects.insert(file.objects.find("KeyTime"), body);
    EXPECT_TRUE(std::isfinite(x_at(read(file), 1e9))) << kind;
  }
}

TEST(FbxAnimation, RefusesWhatItCannotShow) {
  FbxText pivot = sliding({0, 1}, {0, 4}, {kLinear, kLinear});
  pivot.curve_node(90, 51, 20, "RotationPivot", "");
  pivot.curve(91, 90, "d|X", {0, 1}, {0, 4}, {kLinear, kLinear});
  EXPECT_TRUE(says(refusal_of(pivot), "animates its RotationPivot"));
  EXPECT_TRUE(says(refusal_of(sliding({0, 1}, {0}, {})), "2 times and 1 values"));
  EXPECT_TRUE(says(refusal_of(sliding({0, 1}, {0, 1}, {kLinear})), "do not fit its 2 keys"));
}

// Mutation: such a key is left out, and another motion is shown.
TEST(FbxAnimation, KeysOutOfOrderAreRefused) {
  const auto four = [](const std::vector<double>& times, const std::vector<double>& values) {
    return sliding(times, values, {kLinear, kLinear, kLinear, kLinear});
  };
  const std::string why = "key 2 (counted from 0) is not later than the key before";
  EXPECT_TRUE(says(refusal_of(four({0, 0.5, 0.5, 1}, {0, 2, 7, 4})), why));
  EXPECT_TRUE(says(refusal_of(four({0, 1, 0.5, 2}, {0, 2, 2, 4})), why));
  const Character character = read(four({0, 0.5, 0.5, 1}, {0, 2, 2, 4}));
  ASSERT_EQ(character.notes.size(), 1u);
  EXPECT_EQ(character.notes[0], "1 keys ignored that repeat the key before");
  EXPECT_NEAR(x_at(character, 0.5), 2, 1e-9);
}

// Mutations: such keys are left out; slopes of straight segments are looked at; those of curved ones are not.
TEST(FbxAnimation, KeysThatAreNoNumbersAreRefusedByTheirCurve) {
  const double nan = std::nan("");
  for (const double value : {nan, HUGE_VAL, -HUGE_VAL})
    EXPECT_TRUE(says(refusal_of(sliding({0, 0.5, 1}, {0, value, 4}, {kLinear, kLinear, kLinear})),
                     "clip 'clip', node 'node', Lcl Translation (X): animation curve 61: the value of key 1 "
                     "(counted from 0) is not a number"));
  const std::vector<double> slopes = {nan, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(refusal_of(sliding({0, 1}, {0, 4}, {kLinear, kLinear}, slopes)), "");
  EXPECT_TRUE(says(refusal_of(sliding({0, 1}, {0, 4}, {kCubicUser, kLinear}, slopes)),
                   "animation curve 61: the tangent of key 0 (counted from 0) is not a number"));
  for (const std::string word : {"1.#QNAN", "-1.#IND00", "nan(ind)", "-nan", "1.#INF", "inf", "1e400"}) {
    std::string text = sliding({0, 1}, {0, 4}, {kLinear, kLinear}).text();
    const std::string values = "KeyValueFloat: *2 {\n a: 0,4";
    text.replace(text.find(values), values.size(), "KeyValueFloat: *2 {\n a: 0," + word);
    EXPECT_TRUE(says(test::refusal([&] { read_fbx(text, {}); }),
                     "the value of key 1 (counted from 0) is not a number"))
        << word;
  }
}

}  // namespace
}  // namespace cscd::scenes
