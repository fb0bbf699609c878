#include "scenes/base/closest_name.h"

#include <gtest/gtest.h>

namespace cscd {
namespace {

TEST(EditDistance, CountsLettersThatDiffer) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("rope", "rope"), 0u);
  EXPECT_EQ(edit_distance("", "rope"), 4u);
  EXPECT_EQ(edit_distance("rope", "ropes"), 1u);
  EXPECT_EQ(edit_distance("rope", "rpoe"), 1u) << "neighbours swapped";
  EXPECT_EQ(edit_distance("rope", "hope"), 1u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("ca", "abc"), edit_distance("abc", "ca"));
}

TEST(ClosestName, IsNearOrNone) {
  const std::string_view names[] = {"query", "inspect", "run", "rope", "drvbc_fast", "--json"};
  EXPECT_EQ(closest_name("qurey", names), "query");
  EXPECT_EQ(closest_name("drvbc-fast", names), "drvbc_fast");
  EXPECT_EQ(closest_name("--jsno", names), "--json");
  EXPECT_EQ(closest_name("rn", names), "run");
  EXPECT_EQ(closest_name("xyz", names), "");
  EXPECT_EQ(closest_name("", names), "");
  EXPECT_EQ(closest_name(std::string(1000, 'q'), names), "");
  EXPECT_EQ(closest_name("query", {}), "");
  EXPECT_EQ(did_you_mean("inspekt", names), "; did you mean inspect?");
  EXPECT_EQ(did_you_mean("walrus", names), "");
}

}  // namespace
}  // namespace cscd
