#include <bit>
#include <cstdint>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "core/base/test_refusal.h"
#include "scenes/base/test_says.h"
#include "scenes/exchange/mesh_cache.h"
#include "scenes/exchange/number_bytes.h"
#include "scenes/exchange/test_surface.h"
#include "scenes/exchange/usd_file.h"
#include "scenes/exchange/vtk_file.h"

// Files of other programs, as those programs write them and as this one does.
namespace cscd::scenes {
namespace {

TEST(MeshCaches, GiveSinglePrecisionBackAndRefuseOtherLengths) {
  for (const MeshCacheFormat format : {MeshCacheFormat::pc2, MeshCacheFormat::mdd}) {
    const std::vector<Vec3> one = {{1, 2, 3}, {-0.5, 1e10, 0}}, other = {{4, 5, 6}, {7, 8, 9}};
    const std::string bytes = mesh_cache_head(format, 2, 2, 30, 7) + mesh_cache_frame(format, one) +
                              mesh_cache_frame(format, other);
    const MeshCache cache(format, bytes);
    EXPECT_EQ(cache.vertices(), 2u);
    ASSERT_EQ(cache.frames(), 2u);
    EXPECT_EQ(cache.fps(), format == MeshCacheFormat::mdd ? std::optional(30.0) : std::nullopt);
    EXPECT_EQ(cache.first_frame(), 7);
    std::vector<Vec3> read;
    cache.read_frame(0, read);
    EXPECT_EQ(read, one);
    cache.read_frame(1, read);
    EXPECT_EQ(read, other);
    for (std::size_t cut = 0; cut < bytes.size(); ++cut)
      EXPECT_NE(test::refusal([&] { MeshCache(format, std::string_view(bytes).substr(0, cut)); }), "") << cut;
    EXPECT_NE(test::refusal([&] { MeshCache(format, bytes + "x"); }), "");
  }
}

// Mutations: the first second, or frame, is not looked at; frames that are not evenly spaced have a rate; the
// step between the samples of PC2 is not looked at.
TEST(MeshCaches, SayWhenTheirFramesAre) {
  const std::vector<Vec3> one = {{1, 2, 3}};
  const auto with = [&](MeshCacheFormat format, std::size_t at, std::initializer_list<float> numbers) {
    std::string bytes = mesh_cache_head(format, 1, 3, 25, 0);
    for (int f = 0; f < 3; ++f) bytes += mesh_cache_frame(format, one);
    for (const float x : numbers) {
      const auto bits = std::bit_cast<std::uint32_t>(x);
      for (int k = 0; k < 4; ++k, ++at)
        bytes[at] = static_cast<char>(bits >> (format == MeshCacheFormat::pc2 ? 8 * k : 24 - 8 * k));
    }
    return bytes;
  };
  const std::string late = with(MeshCacheFormat::mdd, 8, {2.0F, 2.04F, 2.08F}),
                    uneven = with(MeshCacheFormat::mdd, 8, {2.0F, 2.05F, 2.08F}),
                    named = with(MeshCacheFormat::pc2, 20, {101.0F});
  EXPECT_EQ(MeshCache(MeshCacheFormat::mdd, late).fps(), 25);
  EXPECT_EQ(MeshCache(MeshCacheFormat::mdd, late).first_frame(), 50);
  EXPECT_EQ(MeshCache(MeshCacheFormat::mdd, uneven).fps(), std::nullopt);
  EXPECT_EQ(MeshCache(MeshCacheFormat::mdd, uneven).first_frame(), 0);
  EXPECT_EQ(MeshCache(MeshCacheFormat::pc2, named).first_frame(), 101);
  const std::string falling = with(MeshCacheFormat::mdd, 8, {2.0F, 2.04F, 2.0F});
  EXPECT_TRUE(
      says(test::refusal([&] { MeshCache(MeshCacheFormat::mdd, falling); }), "frame 2: its time is before"));
  const std::string halves = with(MeshCacheFormat::pc2, 20, {10.0F, 0.5F});
  EXPECT_TRUE(says(test::refusal([&] { MeshCache(MeshCacheFormat::pc2, halves); }),
                   "its samples are 0.5 frames apart"));
  std::string other = named;
  other[12] = 2;
  EXPECT_TRUE(says(test::refusal([&] { MeshCache(MeshCacheFormat::pc2, other); }), "is of version 2 of PC2"));
}

TEST(VtkFiles, EscapeNames) {
  VtkSurface surface(kPositions, kTriangles);
  surface.add("<a & \"b\">", std::vector<float>{1, 2});
  EXPECT_TRUE(says(surface.text(), "Name=\"&lt;a &amp; &quot;b&quot;&gt;\""));
  const std::vector<VtkMoment> moments = {{0.5, 1, "a&b.vtp"}};
  EXPECT_TRUE(says(to_pvd(moments), "timestep=\"0.5\" part=\"1\" file=\"a&amp;b.vtp\""));
}

// Mutation: the frame before a change is not written, and readers blend over all frames since the last one.
TEST(UsdFiles, WriteColoursWhereTheyChangeAndInTheFrameBefore) {
  UsdSurface surface(kTriangles, {.fps = 24});
  constexpr UsdSurface::Colour kPalette[] = {{0, 0, 0}, {1, 0, 0}};
  double frame = 0;
  for (const std::uint8_t second : {0, 0, 1})
    surface.append(frame++, kPositions, std::vector<std::uint8_t>{0, second}, kPalette,
                   std::vector<float>{0, 0, 0, 0.5F}, {}, std::vector<std::vector<Vec3>>{kPositions});
  const std::string text = surface.text(0.1);
  EXPECT_TRUE(says(text, "timeCodesPerSecond = 24"));
  EXPECT_TRUE(says(text, "int[] faceVertexIndices = [0, 1, 2, 0, 2, 3]"));
  EXPECT_TRUE(says(text, "float[] primvars:depth.timeSamples = {\n            0: [0, 0, 0, 0.5],\n    }"));
  EXPECT_TRUE(says(text, "int[] curveVertexCounts.timeSamples = {\n            0: [4],"));
  const std::string colours = text.substr(text.find("displayColor.timeSamples"), 200);
  EXPECT_TRUE(says(colours,
                   "0: [(0, 0, 0), (0, 0, 0)],\n            1: [(0, 0, 0), (0, 0, 0)],\n"
                   "            2: [(0, 0, 0), (1, 0, 0)]"))
      << colours;
}

// Mutations: any axis but z is taken for y; the unit is left to USD's default of a centimetre.
TEST(UsdFiles, SayWhichAxisIsUpAndHowLongAUnitIs) {
  const auto head = [](const std::string& up) {
    UsdSurface surface(kTriangles, {24, up, 0.01});
    surface.append(0, kPositions, std::vector<std::uint8_t>{0, 0}, std::vector<UsdSurface::Colour>(1),
                   std::vector<float>(4), {}, {});
    const std::string text = surface.text(0.1);
    return text.substr(0, text.find("def Mesh"));
  };
  EXPECT_TRUE(says(head("y"), "metersPerUnit = 0.01\n    upAxis = \"Y\""));
  EXPECT_TRUE(says(head("z"), "upAxis = \"Z\""));
  EXPECT_FALSE(says((head("y") + head("z")), "rotate"));
  EXPECT_TRUE(says(head("x"), "rotateZ = 90"));
  EXPECT_TRUE(says(head("-x"), "rotateZ = -90"));
  EXPECT_TRUE(says(head("-y"), "rotateX = 180"));
  EXPECT_TRUE(says(head("-z"), "rotateX = 90"));
}

}  // namespace
}  // namespace cscd::scenes
