#include "scenes/exchange/surface_file.h"

#include <bit>
#include <cstdint>
#include <gtest/gtest.h>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/test_refusal.h"
#include "scenes/base/test_says.h"
#include "scenes/exchange/number_bytes.h"
#include "scenes/exchange/test_surface.h"

namespace cscd::scenes {
namespace {

Polygons polygons(const std::vector<std::vector<std::int32_t>>& faces) {
  Polygons out;
  for (const std::vector<std::int32_t>& face : faces) {
    out.corners.insert(out.corners.end(), face.begin(), face.end());
    out.ends.push_back(out.corners.size());
  }
  return out;
}

std::string obj_refusal(const std::string& text) {
  return test::refusal([&] { read_obj(text); });
}
std::string ply_refusal(const std::string& text) {
  return test::refusal([&] { read_ply(text); });
}

TEST(SurfaceFiles, GiveEveryPositionBackBitForBit) {
  for (const SurfaceFile& read :
       {read_obj(to_obj(kPositions, kTriangles)), read_ply(to_ply(kPositions, kTriangles))}) {
    EXPECT_EQ(read.positions, kPositions);
    EXPECT_EQ(read.faces, polygons({{0, 1, 2}, {0, 2, 3}}));
  }
}

TEST(SurfaceFiles, ObjIsReadAsOthersWriteIt) {
  const SurfaceFile read = read_obj(
      "# a comment\r\nmtllib x.mtl\no part\nv 0 0 0 1.0\nv 1 0 0\r\nv 1 1 0\nvn 0 0 1\nvt 0 0\nv 0 1 0\n\n"
      "usemtl m\ns 1\nf 1/1/1 2//1 3/1 4\nf -4 -3 -2\nl 1 2");
  EXPECT_EQ(read.positions.size(), 4u);
  EXPECT_EQ(read.faces, polygons({{0, 1, 2, 3}, {0, 1, 2}}));
  EXPECT_EQ(read.points_and_lines, 1u);
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
    EXPECT_EQ(read.faces, polygons({{0, 1, 2}}));
    for (std::size_t cut = 0; cut + 1 < file.size(); ++cut)
      EXPECT_NE(test::refusal([&] { read_ply(file.substr(0, cut)); }), "") << "of " << cut << " bytes";
  }
}

constexpr char kPlainObj[] = "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n";

// Other ways to write the same file.
TEST(SurfaceFiles, ObjMayHaveMarksCommentsAndContinuedLines) {
  const SurfaceFile plain = read_obj(kPlainObj);
  for (const std::string text :
       {"\xEF\xBB\xBFv 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n", "v 0 0 0\r\nv 4 0 0\r\nv 0 4 0\r\nf 1 2 3\r\n",
        "v 0 0 0\rv 4 0 0\rv 0 4 0\rf 1 2 3",
        "# v 9 9 9 \\\nv 0 0 0 # a corner\n\tv\t4 0 0#another\nv 0 4 0\nf 1 2 3 # the face, v 8 8 8\n#\n",
        "v 0 0 \\\n0\nv 4\\\n 0 0\nv 0 4 0\nf 1 2\\ # goes on\r\n3\n",
        "v +0.0 -0 +0e0\nv +4 0 0\nv 0 4. 0\nf +1 +2 +3\n",
        "v 0 0 0 1.0\nv 4 0 0 255 0 0\nv 0 4 0 0.5 0.5 0.5 1\nfo 1/1/1 2//1 3/7\n",
        "v 0 0 0\nv 4 0 0\nv 0 4 0\nf -3 -2 -1\n", "v 0 0 0\n\xEF\xBB\xBFv 4 0 0\nv 0 4 0\nf 1 2 3\n",
        "f 1 2 3\nv 0 0 0\nv 4 0 0\nv 0 4 0\n",
        "usemtl C:\\materials\\\nv 0 0 0\nv 4 0 0\nv 0 4 0\ng a b \\\nc d\nf 1 2 3\n"}) {
    const SurfaceFile read = read_obj(text);
    EXPECT_EQ(read.positions, plain.positions) << text;
    EXPECT_EQ(read.faces, plain.faces) << text;
    EXPECT_TRUE(read.notes.empty()) << text;
  }
}

TEST(SurfaceFiles, ObjWordsThatAreUnknownAreLeftOutWithANote) {
  const SurfaceFile read =
      read_obj(std::string("vx 1 2 3\nhello\ncurv 0 1 1 2 \\\n3 4\np 1\nl 1 2\n") + kPlainObj);
  EXPECT_EQ(read.positions.size(), 3u);
  EXPECT_EQ(read.points_and_lines, 2u);
  ASSERT_EQ(read.notes.size(), 2u);
  EXPECT_EQ(read.notes[0], "1 curves and surfaces that are no polygons left out");
  EXPECT_EQ(read.notes[1],
            "2 lines begin with words that OBJ files do not have, as line 1 does, and are left out");
  const SurfaceFile one =
      read_obj(std::string(kPlainObj) + "hello \"v\"\ng \xC3\xBC \\\n\xC3\xA4 b\n# \xC3\xB6\n");
  EXPECT_EQ(one.notes, std::vector<std::string>{
                           "line 5 begins with a word that OBJ files do not have, and is left out"});
}

// Mutations: # begins a comment everywhere; a number ends where it is no number any more.
TEST(SurfaceFiles, ObjNumbersAreNumbersOrRefused) {
  EXPECT_TRUE(says(obj_refusal(std::string("v 0 0 1\0\n", 9)), "line 1: '1?' is no coordinate"));
  EXPECT_TRUE(
      says(obj_refusal(std::string("v 0 0 0\nv\0 0 0 1\n", 18)), "line 2: holds a byte 0, so it is no text"));
  EXPECT_TRUE(says(obj_refusal(std::string("v\0 0 0 1\n", 10)), "line 1: holds a byte 0, so it is no text"));
  for (const auto& [text, what] :
       {std::pair("v 0 0 0\nv 0 0 1.#IND\n", "line 2: '1.#IND' is no coordinate"),
        {"v 1,5 0 0\n", "line 1: '1,5' is no coordinate"},
        {"v 0x10 0 0\n", "line 1: '0x10' is no coordinate"},
        {"v 0 1e400 0\n", "line 1: a coordinate is not finite"},
        {"v 0 -inf 0\n", "line 1: a coordinate is not finite"},
        {"v 0 0\n", "line 1: has 2 coordinates of 3"},
        {"v 0 0 0\nv\n", "line 2: has 0 coordinates of 3"},
        {"v 0 0 0\nv\xC2\xA0 4 0 0\n", "line 2: 'v?\?' is no statement, although"},
        {"v 0 0 0\nv\xC2\xA0"
         "4 0 0\n",
         "line 2: 'v?\?4' is no statement, although"},
        {"v 0 0 0\n\xE2\x80\x8Bv 4 0 0\n", "line 2: '???v' is no statement, although"},
        {"g a \\\n\xC2\xA0v 4 0 0\n", "line 2: '??v' is no statement, although"},
        {"v 0 0 0\n\"v 4 0 0\"\n", "line 2: '\"v' is no statement, although"},
        {"v 0 0 0\n'f' 1 1 1\n", "line 2: ''f'' is no statement, although"},
        {"v 0 0 0\n\xC3\xBC 4 0 0\n", "line 2: '\?\?' is no statement; it holds bytes"},
        {"v 0 0 0 v 1 1 1\n", "line 1: 'v' stands behind a vertex"},
        {"v 0 0 0 1 1\n", "line 1: a vertex has 5 numbers"},
        {"v 0 0 0 1 1 1 1 1\n", "line 1: a vertex has 8 numbers"},
        {"v 0 0 0\nf 1,1,1\n", "line 2: '1,1,1' is no vertex number"},
        {"v 0 0 0\nf 1 1.0 1\n", "line 2: '1.0' is no vertex number"},
        {"v 0 0 0\nf 1 0 1\n", "line 2: '0' names no vertex"},
        {"v 0 0 0\nV 0 0 0\n", "line 2: 'V' is no statement"},
        {"v 0 0 0\nf1 1 1\n", "line 2: 'f1' is no statement"},
        {"v 0 0 0\nf 1 \\ 1 1\n", "line 2: a backslash stands before"},
        {"v 0 0 0\ncall a.obj\n", "line 2: has another file read"},
        {"\xFF\xFEv", "is text in UTF-16"}})
    EXPECT_TRUE(says(obj_refusal(text), what)) << text;
}

const std::string kPlyHead =
    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n";
const std::string kPlainPly = "ply\nformat ascii 1.0\n" + kPlyHead + "0 0 0\n4 0 0\n0 4 0\n3 0 1 2\n";

std::string with(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

TEST(SurfaceFiles, PlyMayHaveMarksAndOtherLineEnds) {
  const SurfaceFile plain = read_ply(kPlainPly);
  for (const std::string& text :
       {"\xEF\xBB\xBF" + kPlainPly, with(kPlainPly, "\n", "\r\n"), with(kPlainPly, "\n", "\r"),
        with(kPlainPly, "4 0 0", "+4.0\t0 0 "), with(kPlainPly, "3 0 1 2\n", "\n3 0 1 2\n\n"),
        with(kPlainPly, "end_header", "obj_info x\ncomment y\nend_header")}) {
    const SurfaceFile read = read_ply(text);
    EXPECT_EQ(read.positions, plain.positions) << text;
    EXPECT_EQ(read.faces, plain.faces) << text;
  }
  // A carriage return that ends the header of a binary file; the first byte of the body looks like a line
  // feed.
  std::string binary = with("ply\nformat binary_little_endian 1.0\n" + kPlyHead, "\n", "\r");
  for (const std::uint32_t bits : {0x0000000aU, 0U, 0U, 0U, 0U, 0U, 0U, 0U, 0U})
    append_bits(bits, 4, false, binary);
  binary += '\3';
  for (const unsigned v : {0U, 1U, 2U}) append_bits(v, 4, false, binary);
  EXPECT_EQ(read_ply(binary).positions[0].x(), std::bit_cast<float>(0x0000000aU));
  EXPECT_TRUE(says(ply_refusal(binary + '\1'), "has 1 bytes behind its last element"));
  EXPECT_EQ(ply_refusal(binary + "\r\n"), "");
}

TEST(SurfaceFiles, PlyNumbersAreNumbersOrRefused) {
  for (const auto& [from, to, what] :
       {std::tuple("4 0 0", "1,5 0 0", "line 11: holds '1,5' where a number"),
        {"4 0 0", "4 0", "line 11: ends before the last number"},
        {"4 0 0", "4 0 0 7", "line 11: holds more numbers"},
        {"4 0 0", "4 0 nan", "vertex 1 (counted from 0): a coordinate is not finite"},
        {"4 0 0", "4 0 -1.#IND", "line 11: holds '-1.#IND'"},
        {"3 0 1 2", "3 0 1.5 2", "face 0 (counted from 0): a corner names no vertex"},
        {"3 0 1 2", "3 0 -1 2", "a corner names no vertex"},
        {"3 0 1 2", "3 0 1 3", "has a face of vertex 3 (counted from 0)"},
        {"3 0 1 2", "2.5 0 1 2", "has a list of 2.5"},
        {"3 0 1 2", "3 0 1 2\n3 0 2 1", "line 14: stands behind the last element"},
        {"vertex 3", "vertex 3.5", "line 3: counts more elements than are read"},
        {"property float y", "proprty float y", "line 5: 'proprty' is no line"},
        {"property float y", "property float x", "has vertices without one x, y and z each"},
        {"element face", "element tristrips", "its faces are strips"},
        {"ascii 1.0", "ascii 2.0", "line 2: the version of PLY is '2.0'"},
        {"ply", "\xFE\xFFply", "is text in UTF-16"}})
    EXPECT_TRUE(says(ply_refusal(with(kPlainPly, from, to)), what)) << to;
}

TEST(SurfaceFiles, FacesAreCutAsTheyLie) {
  const SurfaceFile dart = read_obj("v 0 0 0\nv 2 1 0\nv 4 0 0\nv 2 4 0\nf 1 2 3 4\n");
  using Corners = std::vector<std::array<std::int32_t, 3>>;
  EXPECT_EQ(cut_faces(dart.faces, dart.positions).triangles, (Corners{{0, 1, 3}, {1, 2, 3}}));
  const std::vector<Vec3> other = {{0, 0, 0}, {2, -1, 0}, {4, 0, 0}, {2, 0.5, 0}};
  EXPECT_EQ(cut_faces(dart.faces, other).triangles, (Corners{{0, 1, 3}, {1, 2, 3}}));
  const std::vector<Vec3> bow = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 2, 0}};
  EXPECT_TRUE(says(cut_faces(dart.faces, bow).note, "1 flat polygons overlap themselves"));
}

}  // namespace
}  // namespace cscd::scenes
