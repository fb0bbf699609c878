#include "scenes/character/pieces.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mesh/test_shapes.h"

namespace cscd::scenes {
namespace {

// An open sheet of 2 triangles, a box of 12, and a sphere of 80 that faces inward, far away at x = 1e4.
test::Shape three_pieces() {
  test::Shape sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                    {test::corners(0, 1, 2), test::corners(0, 2, 3)}};
  test::Shape sphere = test::moved(test::icosphere(1), {1e4, 0, 0});
  for (Triangle& t : sphere.triangles) std::swap(t[1], t[2]);
  return test::together(test::together(sheet, test::moved(test::box(), {5, 0, 0})), sphere);
}

TEST(Pieces, AreMeshesOfTheirOwn) {
  const test::Shape shape = three_pieces();
  const std::vector<Piece> pieces = pieces_of(shape.mesh());
  ASSERT_EQ(pieces.size(), 3u);
  EXPECT_EQ(pieces[0].mesh.triangle_count(), 2u);
  EXPECT_FALSE(pieces[0].mesh.closed_and_oriented());
  EXPECT_EQ(pieces[1].vertices.size(), 8u);
  EXPECT_TRUE(pieces[1].mesh.closed_and_oriented());
  EXPECT_NEAR(signed_volume(pieces[1], shape.positions), 1, 1e-12);
  EXPECT_LT(signed_volume(pieces[2], shape.positions), -3);  // a unit sphere, far away
  EXPECT_GT(signed_volume(pieces[2], shape.positions), -4.2);
}

TEST(Pieces, AreChosenByKindSizeOrNumber) {
  const std::vector<Piece> pieces = pieces_of(three_pieces().mesh());
  using Numbers = std::vector<std::size_t>;
  EXPECT_EQ(choose_pieces(pieces, "auto"), Numbers{2});
  EXPECT_EQ(choose_pieces(pieces, "largest"), Numbers{2});
  EXPECT_EQ(choose_pieces(pieces, "all"), (Numbers{0, 1, 2}));
  EXPECT_EQ(choose_pieces(pieces, "1"), Numbers{1});
  for (const char* wrong : {"3", "-1", "big", ""})
    EXPECT_THROW(choose_pieces(pieces, wrong), InputError) << wrong;
  // The closed piece is chosen before the open piece; where none is closed, the open piece is.
  EXPECT_EQ(choose_pieces(std::span(pieces).first(2), "auto"), Numbers{1});
  EXPECT_EQ(choose_pieces(std::span(pieces).first(1), "auto"), Numbers{0});
}

}  // namespace
}  // namespace cscd::scenes
