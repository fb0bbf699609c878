#include "baselines/cgal_boxes/cgal_boxes.h"

#include "baselines/test_packages.h"

namespace cscd {
namespace {

TEST(CgalBoxes, PassesOnTheSamePairsAsTheHierarchyOfBoxes) {
  test::expect_the_pairs_of_boxes(make_cgal_boxes);
}

TEST(CgalBoxes, LosesNothingBeyondTheFloats) {
  test::expect_pairs_beyond_floats(make_cgal_boxes);
}

TEST(CgalBoxes, TestsSubnormalTrianglesAsTheyAre) {
  test::expect_pairs_of_subnormal_triangles(make_cgal_boxes);
}

}  // namespace
}  // namespace cscd
