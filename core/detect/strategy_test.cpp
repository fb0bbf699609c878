#include "core/detect/strategy.h"

#include <gtest/gtest.h>

namespace cscd {
namespace {

TEST(Guarantee, PromisesAllContactsFromStartsThatItCovers) {
  for (const bool embedded : {false, true}) {
    EXPECT_TRUE(promises_all(Guarantee::complete, embedded));
    EXPECT_EQ(promises_all(Guarantee::all_from_embedded, embedded), embedded);
    EXPECT_FALSE(promises_all(Guarantee::first_contact, embedded));
    EXPECT_FALSE(promises_all(Guarantee::heuristic, embedded));
  }
}

}  // namespace
}  // namespace cscd
