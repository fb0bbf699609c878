#include "bench/inputs/thickness.h"

#include <cmath>
#include <gtest/gtest.h>

#include "bench/inputs/test_inputs.h"
#include "bench/strategies/catalogue.h"
#include "core/base/test_refusal.h"

namespace cscd::bench {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Length, IsANumberOfUnitsOrOfEdges) {
  const WrittenLength units = parse_length("--thickness", "0.25"),
                      edges = parse_length("--thickness", "0.5e");
  EXPECT_EQ(units.length(LengthScale{8, 0}), 0.25);
  EXPECT_EQ(edges.length(LengthScale{8, 0}), 4);
  EXPECT_EQ(edges.text, "0.5e");
  EXPECT_EQ(parse_length("--thickness", "1e-3").length(LengthScale{8, 0}), 1e-3) << "an exponent is no unit";
  EXPECT_EQ(parse_length("--thickness", "1e-3e").length(LengthScale{8, 0}), 8e-3);
  EXPECT_EQ(parse_length("--thickness", "0").length(LengthScale{8, 0}), 0);
}

// Mutations: an inch is a centimetre; the unit of the positions does not matter.
TEST(Length, IsANumberOfMillimetresCentimetresMetresOrInches) {
  const LengthScale metres{8, 100}, inches{8, 2.54};
  for (const auto& [text, length] :
       {std::pair("5mm", 0.005), {"1cm", 0.01}, {"1e1cm", 0.1}, {"0.5m", 0.5}, {"2in", 0.0508}})
    EXPECT_DOUBLE_EQ(parse_length("--thickness", text).length(metres), length) << text;
  EXPECT_DOUBLE_EQ(parse_length("--thickness", "2in").length(inches), 2);
  EXPECT_DOUBLE_EQ(parse_length("--thickness", "2e").length(inches), 16);
  EXPECT_DOUBLE_EQ(parse_length("--thickness", "2").length(inches), 2);
}

// Mutation: a centimetre of an input without a unit is taken for one unit.
TEST(Length, WithAUnitIsRefusedWhereTheInputTellsNone) {
  const test::Shape shape = test::octahedron();
  Input input = input_of(shape, {shape.positions, shape.positions});
  const ThicknessRequest thick{.thickness = parse_length("--thickness", "5cm")};
  EXPECT_TRUE(has(test::refusal([&] { set_thickness(input, thick); }),
                  "--thickness 5cm: test does not tell how long its unit is; write 0.01 for a length"));
  EXPECT_TRUE(has(test::refusal([&] {
                    set_thickness(input,
                                  {.rings = 1, .near_rest = parse_length("--exclude-near-rest", "5cm")});
                  }),
                  "--exclude-near-rest 5cm: test does not tell"));
  input.import.emplace().centimetres_per_unit = 2.5;
  set_thickness(input, thick);
  EXPECT_DOUBLE_EQ(input.thickness.length, 2);
}

TEST(Length, IsRefusedInOneLineThatNamesTheOption) {
  const auto text = [](const std::string& written) {
    return test::refusal([&] { parse_length("--thickness", written); });
  };
  EXPECT_TRUE(has(text("-1"), "--thickness -1: is negative; write ")) << text("-1");
  EXPECT_TRUE(has(text("-0.1e"), "is negative"));
  for (const char* infinite : {"inf", "nan", "-nan", "infe"})
    EXPECT_TRUE(has(text(infinite), "is not finite")) << infinite;
  for (const char* garbage :
       {"", "e", "thick", "0.1x", "0.1 e", "0.1ee", "0,1", "1 cm", "1km", "1M", "cm", " 0.1", "0x1"})
    EXPECT_TRUE(has(text(garbage), "is no length")) << garbage;
  EXPECT_TRUE(has(text("1e999"), "no number that a double holds"));
}

// Mutation: pairs at exactly the distance do not count.
TEST(Thickness, IsMeasuredInTheMeanEdgeOfThePoseAtRest) {
  const test::Shape shape = test::octahedron();
  Input input = input_of(shape, {shape.positions, shape.positions});
  set_thickness(input, {.thickness = parse_length("--thickness", "2e")});
  EXPECT_DOUBLE_EQ(input.thickness.length, 2 * std::sqrt(2.0)) << "all edges are as long";
  EXPECT_TRUE(
      has(test::refusal([&] { set_thickness(input, {.thickness = parse_length("--thickness", "3.5")}); }),
          "--thickness 3.5: is more than all of test at rest"))
      << "its box is 3.46 across";
  EXPECT_EQ(input.thickness.left_out, nullptr);
  EXPECT_EQ(close_at_rest(input).contacts.size(), 24u + 30u) << "all pairs that share no vertex";
  set_thickness(input, {.thickness = parse_length("--thickness", "0.001e")});
  EXPECT_TRUE(close_at_rest(input).contacts.empty());
  set_thickness(input, {.thickness = parse_length("--thickness", "2e"), .rings = 2});
  ASSERT_NE(input.thickness.left_out, nullptr);
  for (const Contact& contact : close_at_rest(input).contacts)
    EXPECT_TRUE(input.thickness.left_out->excludes(input.mesh, contact.pair));
  EXPECT_TRUE(close_at_rest(input, input.thickness.left_out.get()).contacts.empty());
  EXPECT_TRUE(has(
      test::refusal([&] { set_thickness(input, {.thickness = parse_length("--thickness", "1.5e308e")}); }),
      "--thickness 1.5e308e: is more than a number holds"));
}

TEST(Thickness, IsRefusedWhereNothingKnowsDistances) {
  const ThicknessRequest thick{.thickness = parse_length("--thickness", "0.1")}, rings{.rings = 2}, none;
  for (const Strategy& strategy : strategies()) {
    const std::string text = test::refusal([&] { require_fit(thick, strategy); });
    EXPECT_EQ(text.empty(), strategy.knows_distance) << text;
    EXPECT_TRUE(text.empty() || has(text, "choose one of base, ")) << text;
    EXPECT_EQ(test::refusal([&] { require_fit(none, strategy); }), "");
  }
  EXPECT_TRUE(has(test::refusal([&] { require_fit(rings, strategy_named("drvbc_fast")); }),
                  "--exclude-rings: strategy drvbc_fast cannot answer that, as it cannot leave pairs out"));
  EXPECT_EQ(test::refusal([&] { require_fit(rings, strategy_named("mcd")); }), "");
  EXPECT_TRUE(has(test::refusal([&] { require_fit(thick, elementary_test_named("newton")); }),
                  "knows no distances; choose one with --elementary: "));
  EXPECT_EQ(test::refusal([&] { require_fit(thick, elementary_test_named("filtered_exact")); }), "");
}

}  // namespace
}  // namespace cscd::bench
