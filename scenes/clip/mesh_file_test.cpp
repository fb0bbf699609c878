#include "scenes/clip/mesh_file.h"

#include <fstream>
#include <gtest/gtest.h>
#include <limits>

#include "core/base/error.h"
#include "core/base/test_folder.h"
#include "core/base/test_refusal.h"
#include "scenes/base/test_says.h"

namespace cscd::scenes {
namespace {

namespace fs = std::filesystem;

class MeshFile : public testing::Test {
 protected:
  const test::Folder folder;
  const fs::path path = folder / "some.h5";

  static PosedMesh tetrahedron(std::size_t intervals, bool with_bones) {
    PosedMesh mesh;
    for (const auto& [a, b, c] : {std::array{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}})
      mesh.triangles.push_back({VertexId{a}, VertexId{b}, VertexId{c}});
    const auto pose = [&](double by) {
      PosedMesh::Pose out{{Vec3(by, 0, 0), Vec3(1, 0.1, 0), Vec3(0, 1, by), Vec3(0, 0, 1)}, {}};
      if (with_bones) out.bones = {{Vec3(by, 0, 0), Vec3(0, 0, 1)}, {Vec3(0, 0, 1), Vec3(0, by, 2)}};
      return out;
    };
    if (with_bones) mesh.bone_parent = {BoneId{-1}, BoneId{0}};
    mesh.reference = pose(0);
    for (std::size_t i = 0; i < intervals; ++i) {
      const double by = 1.0 / static_cast<double>(3 + i);
      mesh.intervals.push_back({pose(by), pose(-by)});
    }
    return mesh;
  }

  void write(const PosedMesh& first, const PosedMesh& second) const {
    MeshFileWriter writer(path, true);
    writer.add("first", first);
    writer.add("second", second);
    writer.finish();
  }

  static void expect_same(const PosedMesh::Pose& a, const PosedMesh::Pose& b) {
    EXPECT_EQ(a.positions, b.positions);
    ASSERT_EQ(a.bones.size(), b.bones.size());
    for (std::size_t i = 0; i < a.bones.size(); ++i) {
      EXPECT_EQ(a.bones[i].head, b.bones[i].head);
      EXPECT_EQ(a.bones[i].tail, b.bones[i].tail);
    }
  }
  static void expect_same(const PosedMesh& a, const PosedMesh& b) {
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.bone_parent, b.bone_parent);
    expect_same(a.reference, b.reference);
    ASSERT_EQ(a.intervals.size(), b.intervals.size());
    for (std::size_t i = 0; i < a.intervals.size(); ++i) {
      expect_same(a.intervals[i].start, b.intervals[i].start);
      expect_same(a.intervals[i].end, b.intervals[i].end);
    }
  }

  std::string bytes() const { return test::read(path); }
};

// Mutation: with start and end of the bones swapped in the reader, the second comparison fails.
TEST_F(MeshFile, ReadsWhatWasWritten) {
  const PosedMesh plain = tetrahedron(3, false), boned = tetrahedron(2, true);
  write(plain, boned);
  const MeshFileReader reader(path);
  expect_same(reader.read("first"), plain);
  expect_same(reader.read("second"), boned);
}

TEST_F(MeshFile, EqualMeshesGiveEqualBytes) {
  write(tetrahedron(3, false), tetrahedron(2, true));
  const std::string first = bytes();
  write(tetrahedron(3, false), tetrahedron(2, true));
  EXPECT_EQ(bytes(), first);
}

TEST_F(MeshFile, RefusesWhatIsNotThereOrCannotBeUsed) {
  const auto refused = [&](const char* mesh, const std::string& reason) {
    EXPECT_TRUE(says(test::refusal([&] { MeshFileReader(path).read(mesh); }), reason));
  };
  EXPECT_THROW(MeshFileReader{path}, InputError);
  PosedMesh wrong_corner = tetrahedron(1, false), no_number = tetrahedron(1, true);
  wrong_corner.triangles[1][2] = VertexId{4};
  no_number.intervals[0].end.positions[2].y() = std::numeric_limits<double>::quiet_NaN();
  write(wrong_corner, no_number);
  refused("third", "has no mesh third");
  refused("first", "/first/triangles: holds 4, which is outside [0, 4)");
  refused("second", "/second/end");

  PosedMesh short_bones = tetrahedron(1, true), short_pose = tetrahedron(1, false);
  short_bones.bone_parent.pop_back();
  for (PosedMesh::Pose* pose : {&short_bones.reference, &short_bones.intervals[0].start})
    pose->bones.pop_back();
  short_bones.bone_parent[0] = BoneId{0};
  short_bones.intervals[0].end.bones.pop_back();
  short_pose.reference.positions.pop_back();
  for (auto member : {&PosedMesh::Interval::start, &PosedMesh::Interval::end})
    (short_pose.intervals[0].*member).positions.pop_back();
  write(short_bones, short_pose);
  refused("first", "/first/bones");
  refused("second", "holds 3, which is outside [0, 3)");

  std::ofstream(path, std::ios::binary) << "no HDF5 at all";
  EXPECT_THROW(MeshFileReader{path}, InputError);
}

TEST_F(MeshFile, AppearsWholeOrNotAtAll) {
  {
    MeshFileWriter writer(path, false);
    writer.add("first", tetrahedron(1, false));
  }
  EXPECT_TRUE(fs::is_empty(folder.path));
  write(tetrahedron(1, false), tetrahedron(1, false));
  EXPECT_THROW(MeshFileWriter(path, false), InputError);
}

}  // namespace
}  // namespace cscd::scenes
