#include "bench/output/markdown.h"

#include <gtest/gtest.h>

namespace cscd::bench {
namespace {

TEST(Markdown, ATableHasOneLineForTheHeadOneForTheRuleAndOneARow) {
  const std::vector<std::string> head = {"", "rope", "hand"};
  const std::vector<std::vector<std::string>> rows = {{"ms", "0.5", "0.2"}, {"pairs", "12", "–"}};
  EXPECT_EQ(markdown_table(head, rows),
            "|  | rope | hand |\n|---|---:|---:|\n| ms | 0.5 | 0.2 |\n| pairs | 12 | – |\n");
}

}  // namespace
}  // namespace cscd::bench
