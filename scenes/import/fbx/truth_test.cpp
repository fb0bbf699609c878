#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>

#include "scenes/clip/point_cache.h"
#include "scenes/import/fbx/test_fbx.h"

namespace cscd::scenes {
namespace {

namespace fs = std::filesystem;

// Characters that an independent program posed by the FBX SDK's formula ($CSCD_IMPORT, else ../shared/import
// beside the repository), which are no part of the repository.
fs::path import_folder() {
  if (const char* named = std::getenv("CSCD_IMPORT")) return named;
  const fs::path repository = fs::path(__FILE__).parent_path() / ".." / ".." / "..";
  return repository / ".." / "shared" / "import";
}

TEST(FbxTruth, PosesAreThoseOfAnIndependentProgram) {
  std::size_t files = 0;
  std::error_code absent;
  for (const auto& entry : fs::directory_iterator(import_folder(), absent)) {
    fs::path truth = entry.path();
    truth.replace_extension(".truth.h5");
    if (entry.path().extension() != ".fbx" || !fs::exists(truth)) continue;
    SCOPED_TRACE(entry.path().filename().string());
    ++files;
    std::ifstream in(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const Character character = read_fbx(bytes, {});
    ASSERT_FALSE(character.animations.empty());
    const Animation& clip = character.animations[0];
    PointCacheReader reader(truth);
    EXPECT_EQ(static_cast<std::size_t>(std::lround(clip.seconds * 30)) + 1, reader.frame_count());
    for (std::size_t frame = 0; frame < reader.frame_count(); ++frame) {
      const std::vector<Vec3> was = vertices_at(character, clip.start + static_cast<double>(frame) / 30);
      const FrameView expected = reader.load_frame(frame);
      ASSERT_EQ(was.size(), expected.positions.size());
      for (std::size_t v = 0; v < was.size(); ++v)
        ASSERT_LT((was[v] - expected.positions[v]).norm(), 1e-6) << "frame " << frame << ", vertex " << v;
    }
  }
  if (files == 0) GTEST_SKIP() << "no characters in " << import_folder();
}

}  // namespace
}  // namespace cscd::scenes
