#pragma once

#include <algorithm>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>

#include "core/base/test_folder.h"
#include "scenes/character/pose.h"
#include "scenes/clip/point_cache.h"
#include "scenes/export/glb.h"
#include "scenes/import/convert.h"
#include "scenes/import/read_model.h"

// Reads an exported file back as cscd-import does.
namespace cscd::scenes {

struct ReadBack {
  Character character;
  ImportReport report;
  Clip clip;
};

inline ReadBack read_back(const std::string& glb, const ImportOptions& options = {}) {
  const test::Folder folder;
  test::write(folder / "a.glb", glb);
  Character character = read_model(folder / "a.glb", {});
  ImportReport report = convert(character, options, {}, folder / "a.h5", folder / "a.sources");
  PointCacheReader reader(folder / "a.h5");
  Clip clip(reader.header());
  copy_frames(reader, clip);
  return {std::move(character), std::move(report), std::move(clip)};
}

// Rounding to single precision changes a number by at most half of this share.
inline constexpr double kUlp = 0x1p-23;

// Compares the triangles and all frames, vertex by vertex. Positions, offsets, weights and keys lose a few
// roundings of the surface's distance from the origin. The times of keys are rounded too, by a share that
// grows with the frame's number, and a vertex is then off by as much as it moves in that time.
inline void expect_same_frames(const Clip& wanted, const Clip& got) {
  ASSERT_EQ(got.frame_count(), wanted.frame_count());
  ASSERT_EQ(got.header().vertex_count, wanted.header().vertex_count);
  EXPECT_TRUE(got.header().triangles == wanted.header().triangles);
  double farthest = 0;
  for (std::size_t frame = 0; frame < wanted.frame_count(); ++frame) {
    const auto before = wanted.frame(frame > 0 ? frame - 1 : 0).positions,
               expected = wanted.frame(frame).positions,
               after = wanted.frame(std::min(frame + 1, wanted.frame_count() - 1)).positions,
               found = got.frame(frame).positions;
    double size = 0;
    for (const Vec3& x : expected) size = std::max(size, x.norm());
    for (std::size_t v = 0; v < expected.size(); ++v) {
      const double step = std::max((expected[v] - before[v]).norm(), (after[v] - expected[v]).norm());
      const double bound = 4 * kUlp * size + static_cast<double>(frame) * kUlp * step;
      const double off = (found[v] - expected[v]).norm();
      farthest = std::max(farthest, off / bound);
      ASSERT_LT(off, bound) << "frame " << frame << ", vertex " << v;
    }
  }
  testing::Test::RecordProperty("share_of_bound_" + std::to_string(wanted.header().triangles.size()),
                                std::to_string(farthest));
}

}  // namespace cscd::scenes
