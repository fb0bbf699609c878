#include "baselines/cgal_boxes/cgal_boxes.h"

#include "baselines/test_packages.h"

namespace cscd {
namespace {

TEST(CgalBoxes, PassesOnTheSamePairsAsTheHierarchyOfBoxes) {
  test::expect_the_pairs_of_boxes(make_cgal_boxes);
}

}  // namespace
}  // namespace cscd
