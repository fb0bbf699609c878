#include <gtest/gtest.h>

#include "core/detect/start/embedding.h"
#include "scenes/character/pose.h"
#include "scenes/character/test_figure.h"

// Checks the properties of the generated figure that other tests rely on.
namespace cscd::scenes {
namespace {

// Some parts of the figure joined to one surface.
struct Surface {
  Surface(const Character& character, const std::vector<std::size_t>& chosen) {
    for (const std::size_t p : chosen) {
      const Part& part = character.parts[p];
      std::size_t before = 0;
      for (std::size_t q = 0; q < p; ++q) before += character.parts[q].positions.size();
      const auto shift = static_cast<std::int32_t>(vertices.size());
      for (std::size_t v = 0; v < part.positions.size(); ++v) vertices.push_back(before + v);
      for (const auto& t : part.triangles)
        triangles.push_back(test::corners(t[0] + shift, t[1] + shift, t[2] + shift));
    }
  }
  TriangleMesh mesh() const { return TriangleMesh(triangles, vertices.size()); }
  std::vector<Vec3> positions(const Character& character, const Pose& pose) const {
    std::vector<Vec3> all, own;
    skin(character, pose, all);
    for (const std::size_t v : vertices) own.push_back(all[v]);
    return own;
  }
  std::vector<std::size_t> vertices;
  std::vector<Triangle> triangles;
};

bool embedded(const Character& character, const std::vector<std::size_t>& parts, const Pose& pose) {
  const Surface surface(character, parts);
  const TriangleMesh mesh = surface.mesh();
  const std::vector<Vec3> positions = surface.positions(character, pose);
  return EmbeddingTest(mesh, positions).embedded(positions);
}

TEST(Figure, IsAValidCharacterOfAFewThousandTriangles) {
  const Character figure = walking_figure();
  EXPECT_NO_THROW(validate(figure, {}));
  std::size_t triangles = 0;
  for (const Part& part : figure.parts) triangles += part.triangles.size();
  EXPECT_LT(triangles, 4000u);
  EXPECT_EQ(figure.parts[0].triangles.size(), 2272u);
}

TEST(Figure, HasAClosedBodyAndAnOpenShirt) {
  const Character figure = walking_figure();
  EXPECT_TRUE(Surface(figure, {0}).mesh().closed_and_oriented());
  const TriangleMesh shirt = Surface(figure, {3}).mesh();
  EXPECT_EQ(shirt.component_count(), 1);
  ASSERT_EQ(shirt.defects().size(), 1u);
  EXPECT_EQ(shirt.defects()[0].kind, Defect::boundary_edge);
}

TEST(Figure, CrossesItsEyesAloneAtRest) {
  const Character figure = walking_figure();
  const Pose rest = rest_pose(figure);
  EXPECT_TRUE(embedded(figure, {0}, rest));
  EXPECT_TRUE(embedded(figure, {0, 3}, rest)) << "the shirt lies off the body";
  EXPECT_FALSE(embedded(figure, {0, 1}, rest));
  EXPECT_FALSE(embedded(figure, {0, 2}, rest));
}

TEST(Figure, TouchesItselfInOneClipOfTwo) {
  const Character figure = walking_figure();
  const auto touching = [&](const Animation& clip) {
    std::size_t frames = 0;
    for (int frame = 0; frame <= 30; ++frame)
      frames += !embedded(figure, {0}, pose_at(figure, clip, frame / 30.0));
    return frames;
  };
  ASSERT_EQ(figure.animations.size(), 2u);
  EXPECT_EQ(touching(figure.animations[0]), 0u) << figure.animations[0].name;
  EXPECT_GT(touching(figure.animations[1]), 3u) << figure.animations[1].name;
  EXPECT_TRUE(embedded(figure, {0}, pose_at(figure, figure.animations[1], 0)));
}

}  // namespace
}  // namespace cscd::scenes
