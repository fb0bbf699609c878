#include "core/base/number_text.h"

#include <gtest/gtest.h>
#include <limits>
#include <utility>

namespace cscd {
namespace {

// Mutation: 999.6 is "1e+03", as printf has it.
TEST(NumberText, OfAFigureHasThreeDigitsAndCommas) {
  const std::pair<double, const char*> texts[] = {
      {0, "0"},          {0.0001234, "0.000123"}, {0.00924, "0.00924"}, {0.1, "0.1"},     {0.1234, "0.123"},
      {5.678, "5.68"},   {99.96, "100"},          {999.4, "999"},       {999.6, "1,000"}, {12345.6, "12,346"},
      {48440, "48,440"}, {1234567, "1,234,567"},  {-5.678, "-5.68"},    {-123, "-123"},   {-1234, "-1,234"}};
  for (const auto& [value, text] : texts) EXPECT_EQ(figure_text(value), text);
  EXPECT_EQ(figure_text(1e15), "1e+15");
  EXPECT_EQ(figure_text(std::numeric_limits<double>::infinity()), "inf");
}

TEST(NumberText, InASentenceHasFourDigitsAndAllBeforeThePoint) {
  EXPECT_EQ(short_text(0.123456), "0.1235");
  EXPECT_EQ(short_text(9999.4), "9,999");
  EXPECT_EQ(short_text(12345.6), "12,346");
  EXPECT_EQ(short_text(1e300), "1e+300");
  EXPECT_EQ(exact_text(0.1), "0.1");
}

}  // namespace
}  // namespace cscd
