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
  FbxText file;
  file.model(20, "node", 0, property("Lcl Translation", {9, 8, 7}), "Mesh");
  file.triangle(10, 20);
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

TEST(FbxAnimation, LayersOfRotationsAboutSeveralAxesAreRefusedByName) {
  FbxText file = layered("", 100);
  file.curve_node(80, 51, 20, "Lcl Rotation", "");
  file.curve(81, 80, "d|X", {0, 1}, {0, 90}, {kLinear, kLinear});
  file.curve_node(82, 52, 20, "Lcl Rotation", "");
  file.curve(83, 82, "d|X", {0, 1}, {0, 30}, {kLinear, kLinear});
  const Vec3 one = vertices_at(read(file), 1)[1];
  EXPECT_NEAR(one.y(), 6 - 1 + std::cos(120 * 3.14159265358979 / 180), 1e-9)
      << "angles about one axis add up";
  file.curve(84, 82, "d|Y", {0, 1}, {0, 30}, {kLinear, kLinear});
  EXPECT_NE(refusal_of(file.text()).find("'node', clip 'clip': two layers of rotations"), std::string::npos);
}

TEST(FbxAnimation, RefusesWhatItCannotShow) {
  FbxText pivot = sliding({0, 1}, {0, 4}, {kLinear, kLinear});
  pivot.curve_node(90, 51, 20, "RotationPivot", "");
  pivot.curve(91, 90, "d|X", {0, 1}, {0, 4}, {kLinear, kLinear});
  EXPECT_NE(refusal_of(pivot.text()).find("animates its RotationPivot"), std::string::npos);
  EXPECT_NE(refusal_of(sliding({0, 1}, {0}, {}).text()).find("2 times and 1 values"), std::string::npos);
  EXPECT_NE(refusal_of(sliding({0, 1}, {0, 1}, {kLinear}).text()).find("do not fit its 2 keys"),
            std::string::npos);
  std::string cycle = sliding({0, 1}, {0, 4}, {kLinear, kLinear}).text();
  cycle.insert(cycle.find("KeyTime"), "Post-Extrapolation:  {\n Type: R\n}\n");
  EXPECT_NE(refusal_of(cycle).find("goes on beyond its keys"), std::string::npos);
}

TEST(FbxAnimation, KeysThatAreNoneAreLeftOutWithANote) {
  const Character character =
      read(sliding({0, 0.5, 0.5, 1}, {0, std::nan(""), 7, 4}, {kLinear, kLinear, kLinear, kLinear}));
  ASSERT_EQ(character.notes.size(), 1u);
  EXPECT_EQ(character.notes[0], "1 keys out of order or not finite ignored");
  EXPECT_NEAR(x_at(character, 0.25), 3.5, 1e-9);
}

}  // namespace
}  // namespace cscd::scenes
