#include <cmath>
#include <gtest/gtest.h>
#include <utility>

#include "core/base/test_refusal.h"
#include "scenes/base/number_word.h"
#include "scenes/base/test_says.h"
#include "scenes/base/text_encoding.h"

namespace cscd::scenes {
namespace {

using namespace std::string_view_literals;

TEST(NumberWords, AreNumbersAsAWhole) {
  for (const auto& [word, value] : {std::pair("2"sv, 2.0),
                                    {"+2.0"sv, 2.0},
                                    {"-.5"sv, -0.5},
                                    {"+1e+3"sv, 1000.0},
                                    {"5."sv, 5.0},
                                    {"1e-400"sv, 0.0},
                                    {"-1E2"sv, -100.0},
                                    {"5e-324"sv, 5e-324}})
    EXPECT_EQ(number_of(word), value) << word;
  for (const std::string_view word : {"nan"sv, "-NaN"sv, "inf"sv, "-Infinity"sv, "1e400"sv, "-1e400"sv}) {
    ASSERT_TRUE(number_of(word)) << word;
    EXPECT_FALSE(std::isfinite(*number_of(word))) << word;
  }
  for (const std::string_view word :
       {""sv, "+"sv, "-"sv, "."sv, "+-2"sv, "--2"sv, "1,5"sv, "0x10"sv, "1.#IND"sv, "-1.#INF00"sv, "2.0f"sv,
        "1d5"sv, "1e"sv, "2x"sv, " 2"sv, "1_000"sv})
    EXPECT_EQ(number_of(word), std::nullopt) << word;
}

TEST(ByteOrderMarks, AreLeftOutOrNamed) {
  EXPECT_EQ(without_byte_order_mark("\xEF\xBB\xBFv 1"), "v 1");
  EXPECT_EQ(without_byte_order_mark("v 1"), "v 1");
  EXPECT_EQ(without_byte_order_mark(""), "");
  EXPECT_EQ(without_byte_order_mark("v\0 1"sv), "v\0 1"sv);
  for (const std::string_view text : {"\xFF\xFEv\0"sv, "\xFE\xFF\0v"sv, "v\0 \0"sv, "\0v\0 "sv})
    EXPECT_TRUE(says(test::refusal([&] { without_byte_order_mark(text); }), "is text in UTF-16"));
  for (const std::string_view text : {"\xFF\xFE\0\0v\0\0\0"sv, "\0\0\xFE\xFF\0\0\0v"sv})
    EXPECT_TRUE(says(test::refusal([&] { without_byte_order_mark(text); }), "is text in UTF-32"));
}

}  // namespace
}  // namespace cscd::scenes
