#include "baselines/embree/embree.h"

#include "baselines/test_packages.h"

namespace cscd {
namespace {

TEST(Embree, PassesOnTheSamePairsAsTheHierarchyOfBoxes) {
  test::expect_the_pairs_of_boxes(make_embree);
}

}  // namespace
}  // namespace cscd
