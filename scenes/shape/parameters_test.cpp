#include "scenes/shape/parameters.h"

#include <gtest/gtest.h>
#include <limits>

#include "core/base/test_refusal.h"

namespace cscd::scenes {
namespace {

const ParameterRow kPartRows[] = {number_row("weight", "", "how heavy").or_else({7})};
const ParameterRow kRows[] = {
    integer_row("count", "", "how many", {1, 10}),
    number_row("size", "length", "how large", {0, 5}).or_else({0.5}),
    vector_row("place", "", "where").or_else({1, 2, 3}),
    text_row("label", "what").optional(),
    table_row("path", "", 2, "time, height").optional(),
    objects_row("parts", "parts", kPartRows).optional(),
};

using Values = std::map<std::string, Parameters::Value, std::less<>>;

std::string refusal(const Values& values) {
  return test::refusal([&] { (void)checked(Parameters("scene s, effect e", values), kRows); });
}

TEST(Parameters, HandsOutWhatTheyHold) {
  const Parameters given("here", {{"count", 3.0},
                                  {"place", std::vector<double>{1, 2, 3}},
                                  {"label", std::string("rope")},
                                  {"path", Parameters::Table{{0, 1}, {2, 3}}}});
  const Parameters p = checked(given, kRows);
  EXPECT_EQ(p.integer("count"), 3);
  EXPECT_EQ(p.vector("place"), Vec3(1, 2, 3));
  EXPECT_EQ(p.text("label"), "rope");
  EXPECT_EQ(p.table("path")[1][0], 2);
  EXPECT_EQ(given.number("size", 4), 4);
}

TEST(Parameters, HaveTheDefaultsOfTheirRows) {
  const Parameters p = checked({"here", {{"count", 3.0}, {"parts", std::vector<Parameters>(2)}}}, kRows);
  EXPECT_EQ(p.number("size"), 0.5);
  EXPECT_EQ(p.vector("place"), Vec3(1, 2, 3));
  EXPECT_FALSE(p.has("label"));
  ASSERT_EQ(p.objects("parts").size(), 2u);
  EXPECT_EQ(p.objects("parts")[1].number("weight"), 7);
}

TEST(Parameters, NameWhatIsWrong) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal({{"count", 3.0}}), "");
  EXPECT_EQ(
      refusal({{"count", 3.0}, {"colour", 1.0}}),
      "scene s, effect e: parameter colour is unknown; known are: count, size, place, label, path, parts");
  EXPECT_EQ(refusal({{"colour", 1.0}, {"count", 11.0}, {"zise", 1.0}}).substr(0, 42),
            "scene s, effect e: parameter colour is unk")
      << "names before values";
  EXPECT_EQ(refusal({{"count", 11.0}, {"zise", 1.0}}).substr(0, 40),
            "scene s, effect e: parameter zise is unk");
  EXPECT_EQ(refusal({}),
            "scene s, effect e: parameter count is missing (how many); add it to the scene file");
  EXPECT_EQ(refusal({{"count", 2.5}}), "scene s, effect e: parameter count must be a whole number");
  EXPECT_EQ(refusal({{"count", 11.0}}), "scene s, effect e: parameter count is 11; it must be in [1, 10]");
  EXPECT_EQ(refusal({{"count", 1.0}, {"size", nan}}),
            "scene s, effect e: parameter size must be a finite number");
  EXPECT_EQ(refusal({{"count", 1.0}, {"size", std::string("big")}}),
            "scene s, effect e: parameter size must be a finite number");
  EXPECT_EQ(refusal({{"count", 1.0}, {"place", std::vector<double>{1, 2}}}),
            "scene s, effect e: parameter place must be a list of three numbers");
  EXPECT_EQ(refusal({{"count", 1.0}, {"place", std::vector<double>{1, 2, nan}}}),
            "scene s, effect e: parameter place must be finite");
  EXPECT_EQ(refusal({{"count", 1.0}, {"label", 7.0}}), "scene s, effect e: parameter label must be a text");
  EXPECT_EQ(refusal({{"count", 1.0}, {"path", 7.0}}),
            "scene s, effect e: parameter path must be a list of lists of numbers");
  EXPECT_EQ(refusal({{"count", 1.0}, {"path", Parameters::Table{{1, 2, 3}}}}),
            "scene s, effect e: parameter path has a row of 3 numbers; give 2 (time, height)");
}

TEST(Parameters, MayHaveAnyNameWhereARowSaysSo) {
  const ParameterRow rows[] = {vector_row("*", "", "of a thing of that name").optional(),
                               integer_row("count", "", "how many")};
  const auto refused = [&](std::map<std::string, Parameters::Value, std::less<>> values) -> std::string {
    return test::refusal([&] { (void)checked(Parameters("scene s, effect e", std::move(values)), rows); });
  };
  EXPECT_EQ(refused({{"count", 3.0}, {"anything", std::vector<double>{1, 2, 3}}}), "");
  EXPECT_EQ(refused({{"count", 3.0}, {"anything", 1.0}}),
            "scene s, effect e: parameter anything must be a list of three numbers");
  EXPECT_EQ(refused({{"count", 0.5}}), "scene s, effect e: parameter count must be a whole number");
  EXPECT_EQ(refused({{"other", std::vector<double>{1, 2, 3}}}),
            "scene s, effect e: parameter count is missing (how many); add it to the scene file");
}

}  // namespace
}  // namespace cscd::scenes
