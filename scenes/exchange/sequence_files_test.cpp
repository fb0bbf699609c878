#include "scenes/exchange/sequence_files.h"

#include <algorithm>
#include <filesystem>
#include <gtest/gtest.h>

#include "core/base/test_folder.h"
#include "core/base/test_refusal.h"
#include "scenes/base/test_says.h"
#include "scenes/exchange/mesh_cache.h"
#include "scenes/exchange/mesh_sequence.h"
#include "scenes/exchange/surface_file.h"

namespace cscd::scenes {
namespace {

namespace fs = std::filesystem;

class Sequence : public testing::Test {
 protected:
  void put(std::initializer_list<const char*> names) {
    for (const char* name : names) test::write(scratch.path / name, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  }
  // The names of the files of a sequence, with a blank behind each.
  std::string names(const std::string& of) {
    std::string out;
    for (const fs::path& file : files_of_sequence(scratch.path / of).files)
      out += file.filename().string() + " ";
    return out;
  }
  std::string refusal(const std::string& of) {
    return test::refusal([&] { files_of_sequence(scratch.path / of); });
  }
  std::string folder_refusal() {
    return test::refusal([&] { sequence_file(scratch.path); });
  }
  const test::Folder scratch;
};

TEST_F(Sequence, IsInTheOrderOfItsNumbers) {
  put({"walk.9.obj", "walk.10.obj", "walk.0008.OBJ", "walk.note.obj", "walk.9.ply", "run.1.obj",
       ".walk.11.obj"});
  EXPECT_EQ(names("walk.9.obj"), "walk.0008.OBJ walk.9.obj walk.10.obj ");
  EXPECT_EQ(files_of_sequence(scratch.path / "walk.10.obj").first_frame, 8);
  EXPECT_EQ(files_of_sequence(scratch.path / "run.1.obj").files.size(), 1u);
  EXPECT_EQ(files_of_sequence(scratch.path / "walk.note.obj").files.size(), 1u);
  put({"walk.12.obj"});
  EXPECT_TRUE(says(refusal("walk.9.obj"), "frame 11 of its sequence is missing before walk.12.obj"));
  put({"walk.11.obj", "walk.011.obj"});
  EXPECT_TRUE(says(refusal("walk.9.obj"), "frame 11 is there twice"));
}

// Mutations: a dash is never a sign; a dash is always one.
TEST_F(Sequence, MayBeginBelowZero) {
  put({"cloth.-10.obj", "cloth.-9.obj", "cloth.-8.obj"});
  EXPECT_EQ(names("cloth.-9.obj"), "cloth.-10.obj cloth.-9.obj cloth.-8.obj ");
  put({"cloth.-07.obj", "cloth.-6.obj", "cloth.-5.obj", "cloth.-4.obj", "cloth.-3.obj", "cloth.-2.obj",
       "cloth.-1.obj", "cloth.1.obj"});
  EXPECT_TRUE(says(refusal("cloth.1.obj"), "frame 0 of its sequence is missing before cloth.1.obj"));
  put({"cloth.+0.obj"});
  EXPECT_EQ(files_of_sequence(scratch.path / "cloth.1.obj").files.size(), 12u);
  EXPECT_EQ(files_of_sequence(scratch.path / "cloth.1.obj").first_frame, -10);
  put({"-1.ply", "0.ply", "a_-2.ply", "a_-1.ply"});
  EXPECT_EQ(names("0.ply"), "-1.ply 0.ply ");
  EXPECT_EQ(names("a_-1.ply"), "a_-2.ply a_-1.ply ");
}

TEST_F(Sequence, MayJoinItsNumbersByADash) {
  put({"walk-1.obj", "walk-2.obj", "walk1.obj", "walk2.obj"});
  EXPECT_EQ(names("walk-2.obj"), "walk-1.obj walk-2.obj ");
  EXPECT_EQ(names("walk2.obj"), "walk1.obj walk2.obj ");
  put({"walk0.obj"});
  for (const char* name : {"walk-2.obj", "walk2.obj"})
    EXPECT_TRUE(
        says(refusal(name), "whether the dash of walk-1.obj is a sign cannot be told beside walk0.obj"));
}

// Mutation: any number of a name may differ, or none.
TEST_F(Sequence, IsNotedWhereAnEarlierNumberDiffers) {
  const auto note = [&](const char* of) { return files_of_sequence(scratch.path / of).note; };
  put({"w_0001_v2.obj", "w_v2.obj", "u_0002_v2.obj", "w_0003_v2.ply"});
  EXPECT_EQ(note("w_0001_v2.obj"), "");
  put({"w_0002_v2.obj"});
  EXPECT_EQ(
      note("w_0001_v2.obj"),
      "beside it lies 1 file that differs in a number before the last, as w_0002_v2.obj does; for frames "
      "of one sequence, let their number be the last in their names");
  EXPECT_EQ(open_mesh_sequence(scratch.path / "w_0001_v2.obj")->notes(),
            std::vector<std::string>{note("w_0001_v2.obj")});
  put({"w_0003_v2.obj"});
  EXPECT_TRUE(
      says(note("w_0002_v2.obj"), "lie 2 files that differ in a number before the last, as w_0001_v2"));
  put({"w_0001_v3.obj"});  // two frames by the last number
  EXPECT_EQ(note("w_0001_v2.obj"), "");
}

TEST_F(Sequence, IsFoundInItsFolder) {
  EXPECT_TRUE(says(folder_refusal(), "is a folder without OBJ or PLY files"));
  put({"notes.txt", "cloth.-1.obj", "cloth.0.obj"});
  EXPECT_EQ(sequence_file(scratch.path).filename(), "cloth.-1.obj");
  EXPECT_EQ(sequence_file(scratch.path / "cloth.0.obj").filename(), "cloth.0.obj");
  put({"walk.1.ply"});
  EXPECT_TRUE(
      says(folder_refusal(), "is a folder with 2 sequences, such as those of cloth.-1.obj and walk.1.ply"));
  for (const char* name : {"walk.1.ply", "cloth.-1.obj", "cloth.0.obj"}) fs::remove(scratch.path / name);
  put({"cache.mdd", "cache.obj"});
  EXPECT_EQ(sequence_file(scratch.path).filename(), "cache.mdd");
}

// A polygon that lies in a point or on a line at first is cut as it lies in the first frame that shows it.
// Mutations: it is cut in the first frame; in the last; all polygons are cut in the frame of one of them.
TEST_F(Sequence, CutsPolygonsWhereTheyFirstEncloseArea) {
  const std::vector<Vec3> square = {{9, 0, 0}, {9, 2, 0}, {9, 2, 2}, {9, 0, 2}},
                          dart = {{0, 0, 0}, {2, 1, 0}, {4, 0, 0}, {2, 4, 0}};
  // The quadrilateral of the first four vertices is a point, a line, a dart, and a dart with another notch.
  // The other one is a dart in the first frame alone.
  const std::vector<std::vector<Vec3>> moving = {std::vector<Vec3>(4, Vec3::Zero()),
                                                 {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
                                                 dart,
                                                 {{2, 1, 0}, {4, 0, 0}, {2, 4, 0}, {0, 0, 0}}};
  const auto frame = [&](std::size_t f) {
    std::vector<Vec3> all = moving[f];
    const std::vector<Vec3>& second = f == 0 ? dart : square;
    all.insert(all.end(), second.begin(), second.end());
    return all;
  };
  const std::vector<std::array<std::int32_t, 3>> right = {{0, 1, 3}, {1, 2, 3}, {4, 5, 7}, {5, 6, 7}};
  std::string cache = mesh_cache_head(MeshCacheFormat::pc2, 8, 4, 25, 0);
  for (std::size_t f = 0; f < 4; ++f) {
    const std::string text = to_obj(frame(f), {});
    test::write(scratch.path / ("f." + std::to_string(f) + ".obj"), text + "f 1 2 3 4\nf 5 6 7 8\n");
    cache += mesh_cache_frame(MeshCacheFormat::pc2, frame(f));
  }
  test::write(scratch.path / "c.pc2", cache);
  test::write(scratch.path / "c.obj", to_obj(frame(1), {}) + "f 1 2 3 4\nf 5 6 7 8\n");
  for (const char* name : {"f.0.obj", "c.pc2"})
    EXPECT_TRUE(std::ranges::equal(open_mesh_sequence(scratch.path / name)->triangles(), right)) << name;
}

// The first frame says how polygons are cut; faces of other frames are the same, however they lie.
TEST_F(Sequence, CutsItsPolygonsOnce) {
  const std::string faces = "f 1 2 3 4\n";
  test::write(scratch.path / "f.0.obj", "v 0 0 0\nv 2 1 0\nv 4 0 0\nv 2 4 0\n" + faces);
  test::write(scratch.path / "f.1.obj", "v 1 0 0\nv 2 -1 0\nv 3 0 0\nv 2 -0.5 0\n" + faces);
  const std::vector<std::array<std::int32_t, 3>> right = {{0, 1, 3}, {1, 2, 3}};
  const auto sequence = open_mesh_sequence(scratch.path / "f.1.obj");
  EXPECT_TRUE(std::ranges::equal(sequence->triangles(), right));
  std::vector<Vec3> positions;
  sequence->read_frame(1, positions);
  EXPECT_EQ(positions[1], Vec3(2, -1, 0));

  const std::vector<Vec3> first = {{0, 0, 0}, {2, 1, 0}, {4, 0, 0}, {2, 4, 0}};
  for (const MeshCacheFormat format : {MeshCacheFormat::pc2, MeshCacheFormat::mdd}) {
    const char* name = format == MeshCacheFormat::pc2 ? "f.pc2" : "f.mdd";
    test::write(scratch.path / name, mesh_cache_head(format, 4, 1, 25, 0) + mesh_cache_frame(format, first));
    test::write(scratch.path / "f.obj", "v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\n" + faces);
    EXPECT_TRUE(std::ranges::equal(open_mesh_sequence(scratch.path / name)->triangles(), right));
  }
  test::write(scratch.path / "f.1.obj", "v 1 0 0\nv 2 -1 0\nv 3 0 0\nv 2 -0.5 0\nf 1 2 3\nf 1 3 4\n");
  const auto other = open_mesh_sequence(scratch.path / "f.0.obj");
  EXPECT_TRUE(
      says(test::refusal([&] { other->read_frame(1, positions); }), "has other faces than the first file"));
}

// Mutation: the notes on the first frame stand for all.
TEST_F(Sequence, NotesWhatOnlyLaterFramesHold) {
  const std::string plain = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (int f = 0; f < 4; ++f)
    test::write(scratch.path / ("f." + std::to_string(f) + ".obj"), f < 2 ? plain : "wibble 1\n" + plain);
  const auto sequence = open_mesh_sequence(scratch.path / "f.0.obj");
  const std::size_t before = sequence->notes().size();
  std::vector<Vec3> positions;
  for (const int round : {1, 2}) {
    for (std::size_t f = 0; f < 4; ++f) sequence->read_frame(f, positions);
    ASSERT_EQ(sequence->notes().size(), before + 1) << round;
  }
  EXPECT_EQ(
      sequence->notes().back(),
      "f.2.obj: line 1 begins with a word that OBJ files do not have, and is left out; likewise 1 further "
      "file");
}

}  // namespace
}  // namespace cscd::scenes
