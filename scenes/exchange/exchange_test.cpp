#include <bit>
#include <cstdint>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "core/base/test_refusal.h"
#include "scenes/base/test_says.h"
#include "scenes/exchange/mesh_cache.h"
#include "scenes/exchange/number_bytes.h"
#include "scenes/exchange/surface_file.h"
#include "scenes/exchange/usd_file.h"
#include "scenes/exchange/vtk_file.h"

// Files of other programs, as those programs write them and as this one does.
namespace cscd::scenes {
namespace {

using Corners = std::array<std::int32_t, 3>;

const std::vector<Vec3> kPositions = {{0, 0.1, -1e-300}, {1.0 / 3, 2e10, 3}, {-1, -2, -3.5}, {7, 8, 9}};
const std::vector<Triangle> kTriangles = {{VertexId{0}, VertexId{1}, VertexId{2}},
                                          {VertexId{0}, VertexId{2}, VertexId{3}}};

TEST(SurfaceFiles, GiveEveryPositionBackBitForBit) {
  for (const SurfaceFile& read :
       {read_obj(to_obj(kPositions, kTriangles)), read_ply(to_ply(kPositions, kTriangles))}) {
    EXPECT_EQ(read.positions, kPositions);
    EXPECT_EQ(read.triangles, (std::vector<Corners>{{0, 1, 2}, {0, 2, 3}}));
  }
}

TEST(SurfaceFiles, ObjIsReadAsOthersWriteIt) {
  const SurfaceFile read = read_obj(
      "# a comment\r\nmtllib x.mtl\no part\nv 0 0 0 1.0\nv 1 0 0\r\nv 1 1 0\nvn 0 0 1\nvt 0 0\nv 0 1 0\n\n"
      "usemtl m\ns 1\nf 1/1/1 2//1 3/1 4\nf -4 -3 -2\nl 1 2");
  EXPECT_EQ(read.positions.size(), 4u);
  EXPECT_EQ(read.triangles, (std::vector<Corners>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
  EXPECT_TRUE(
      says(test::refusal([] { read_obj("v 0 0 0\nf 1 2\n"); }), "line 2: a face has fewer than three"));
  EXPECT_TRUE(says(test::refusal([] { read_obj("v 0 0 x\n"); }), "line 1: 'x' is no coordinate"));
  EXPECT_TRUE(
      says(test::refusal([] { read_obj("v 0 0 0\nv 0 0 nan\n"); }), "line 2: a coordinate is not finite"));
  EXPECT_TRUE(says(test::refusal([] { read_obj("v 0 0 0\nf -2 1 1\n"); }), "line 2: '-2' names no vertex"));
  EXPECT_TRUE(says(test::refusal([] { read_obj("v 0 0 0\nf 1 1 1\nf 1 3 2\nv 1 0 0\n"); }),
                   "line 3: a face names vertex 3, and the file has 2 vertices"));
  EXPECT_TRUE(says(test::refusal([] { read_obj(""); }), "no vertices"));
}

TEST(SurfaceFiles, PlyIsReadInAllThreeFormats) {
  const std::string head =
      "element vertex 3\nproperty float x\nproperty uchar red\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar short vertex_index\nend_header\n";
  const std::string ascii = "ply\nformat ascii 1.0\n" + head + "0 255 0 0\n1 0 0.5 0\n0 0 1 -2\n3 0 1 2\n";
  std::string binary[2];
  for (const bool big : {false, true}) {
    std::string& out = binary[big];
    out = std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\n" + head;
    const auto number = [&](float x) { append_bits(std::bit_cast<std::uint32_t>(x), 4, big, out); };
    for (const auto& x :
         {std::array{0.F, 0.F, 0.F}, std::array{1.F, 0.5F, 0.F}, std::array{0.F, 1.F, -2.F}}) {
      number(x[0]);
      out += '\7';
      number(x[1]);
      number(x[2]);
    }
    out += '\3';
    for (const unsigned v : {0U, 1U, 2U}) append_bits(v, 2, big, out);
  }
  for (const std::string& file : {ascii, binary[0], binary[1]}) {
    const SurfaceFile read = read_ply(file);
    EXPECT_EQ(read.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0.5, 0}, {0, 1, -2}}));
    EXPECT_EQ(read.triangles, (std::vector<Corners>{{0, 1, 2}}));
    for (std::size_t cut = 0; cut + 1 < file.size(); ++cut)
      EXPECT_NE(test::refusal([&] { read_ply(file.substr(0, cut)); }), "") << "of " << cut << " bytes";
  }
}

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
