#include "scenes/catalog/resized.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <optional>

#include "core/base/error.h"
#include "scenes/catalog/test_scenes.h"
#include "scenes/shape/test_shapes.h"

namespace cscd::scenes {
namespace {

constexpr const char* kPlain[] = {"rope", "hand", "octopus", "man", "box", "urchin"};

TEST(Resized, SceneAtItsOwnSizeIsTheSceneBitByBit) {
  const Scene scene = parse_scene("small", kSmallScene, "small.json");
  std::optional<Clip> clip;
  run_scene(scene, [&](ClipHeader header) -> FrameSink& { return clip.emplace(std::move(header)); });
  const Shape shape = resized_shape(scene, triangle_count(scene));
  const std::size_t frames[] = {0, 2, 5};
  const std::vector<BonePose> poses = poses_at(scene, frames);
  ASSERT_EQ(poses.size(), 3u);
  for (const BonePose& pose : poses) {
    EXPECT_TRUE(std::ranges::equal(carried(scene, shape, pose), clip->frame(pose.frame).positions))
        << "frame " << pose.frame;
    for (std::size_t b = 0; b < pose.bones.size(); ++b)
      EXPECT_EQ(pose.bones[b].tail, clip->frame(pose.frame).bones[b].tail);
  }
}

TEST(Resized, EverySceneHasAboutTheTrianglesAskedFor) {
  for (const char* name : kPlain) {
    const Scene scene = load_scene(name);
    for (const std::size_t triangles : {12'000u, 48'000u}) {
      const Shape shape = resized_shape(scene, triangles);
      expect_well_formed(shape);
      EXPECT_NEAR(std::log2(static_cast<double>(shape.triangles.size()) / static_cast<double>(triangles)), 0,
                  0.2)
          << name << ": " << shape.triangles.size();
      EXPECT_EQ(shape.rig.parent.size(), scene.expected.bones.value()) << name;
    }
  }
}

TEST(Resized, FinerSurfacesFollowTheSameMotion) {
  for (const char* name : {"rope", "urchin"}) {
    const Scene scene = load_scene(name);
    const std::size_t frames[] = {30};
    const BonePose pose = poses_at(scene, frames).front();
    const auto middle = [&](std::size_t triangles) {
      Vec3 sum = Vec3::Zero();
      const std::vector<Vec3> positions = carried(scene, resized_shape(scene, triangles), pose);
      for (const Vec3& position : positions) sum += position;
      return Vec3(sum / static_cast<double>(positions.size()));
    };
    EXPECT_LT((middle(12'000) - middle(48'000)).norm(), 0.1) << name;
  }
}

TEST(Resized, RefusesWhatItCannotCarry) {
  const std::size_t past[] = {1000};
  EXPECT_THROW(poses_at(load_scene("rope"), past), InputError);
  const std::size_t first[] = {0};
  for (const char* name : {"hand_contact", "sheet", "bag", "skirt"})
    EXPECT_THROW(poses_at(load_scene(name), first), InputError) << name;
}

}  // namespace
}  // namespace cscd::scenes
