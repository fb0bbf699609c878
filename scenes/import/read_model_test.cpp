#include "scenes/import/read_model.h"

#include <assimp/IOStream.hpp>
#include <filesystem>
#include <gtest/gtest.h>
#include <memory>

#include "core/base/test_folder.h"
#include "core/base/test_refusal.h"
#include "scenes/base/test_says.h"
#include "scenes/character/pose.h"
#include "scenes/character/skeleton.h"
#include "scenes/import/file_system.h"
#include "scenes/import/test_collada.h"

// assimp's parsers leak memory on files that are cut short. This is accepted, because their
// process ends soon after.
extern "C" __attribute__((visibility("default"))) const char* __lsan_default_suppressions() {
  return "leak:libassimp";
}

namespace cscd::scenes {
namespace {

namespace fs = std::filesystem;

class Model : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(root / "models" / "sub");
    test::write(root / "secret.bin", "outside");
    test::write(root / "models" / "near.bin", "0123456789");
    fs::create_symlink(root / "secret.bin", root / "models" / "link.bin");
  }
  std::string write(const std::string& name, const std::string& text) {
    test::write(root / "models" / name, text);
    return (root / "models" / name).string();
  }
  std::string refusal(const std::string& file) {
    return test::refusal([&] { read_model(file, {}); });
  }
  const test::Folder scratch;
  const fs::path root = scratch.path;
};

TEST_F(Model, FilesOutsideItsFolderDoNotExist) {
  FolderFiles files(root / "models" / "near.bin", 100);
  EXPECT_TRUE(files.Exists("near.bin"));
  EXPECT_TRUE(files.Exists((root / "models" / "near.bin").c_str()));
  for (const std::string& name :
       {std::string("../secret.bin"), std::string("sub/../../secret.bin"), (root / "secret.bin").string(),
        std::string("link.bin"), std::string("/etc/passwd"), std::string("sub"), std::string("none.bin"),
        std::string("/dev/zero")}) {
    EXPECT_FALSE(files.Exists(name.c_str())) << name;
    EXPECT_EQ(files.Open(name.c_str(), "rb"), nullptr) << name;
  }
  EXPECT_EQ(files.Open("near.bin", "wb"), nullptr);
  EXPECT_EQ(files.Open("near.bin", "r+b"), nullptr);
}

TEST_F(Model, FilesAreReadUpToALimitInAll) {
  FolderFiles files(root / "models" / "near.bin", 15);
  Assimp::IOStream* file = files.Open("near.bin", "rb");
  ASSERT_NE(file, nullptr);
  EXPECT_EQ(file->FileSize(), 10u);
  char bytes[16] = {};
  EXPECT_EQ(file->Read(bytes, 4, 9), 2u);
  EXPECT_EQ(file->Tell(), 8u);
  EXPECT_EQ(std::string(bytes, 8), "01234567");
  EXPECT_EQ(file->Seek(11, aiOrigin_SET), aiReturn_FAILURE);
  EXPECT_EQ(file->Seek(1, aiOrigin_SET), aiReturn_SUCCESS);
  EXPECT_EQ(file->Read(bytes, 1, 16), 9u);
  EXPECT_EQ(file->Write(bytes, 1, 1), 0u);
  files.Close(file);
  EXPECT_EQ(files.Open("near.bin", "rb"), nullptr);
}

// Two triangles on two joints. The file does not say how many ticks a second has, and animates one joint.
constexpr char kXFile[] = R"(xof 0303txt 0032
Frame Root {
 FrameTransformMatrix { 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;; }
 Frame Upper {
  FrameTransformMatrix { 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 0.0, 1.0;; }
 }
 Mesh Flag {
  4;
  0.0;0.0;0.0;, 1.0;0.0;0.0;, 1.0;2.0;0.0;, 0.0;2.0;0.0;;
  2;
  3;0,1,2;,
  3;0,2,3;;
  XSkinMeshHeader { 1; 1; 2; }
  SkinWeights { "Root"; 2; 0, 1; 0.5, 0.5; 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;; }
  SkinWeights { "Upper"; 2; 2, 3; 1.0, 1.0; 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -2.0, 0.0, 1.0;; }
 }
}
AnimationSet Wave {
 Animation { { Upper }
  AnimationKey { 2; 2; 0; 3; 0.0, 2.0, 0.0;;, 4800; 3; 1.0, 2.0, 0.0;;; }
 }
}
)";

TEST_F(Model, ReadsASkinnedAnimation) {
  const Character flag = read_model(write("flag.x", kXFile), {});
  EXPECT_EQ(flag.format, "DirectX X");
  ASSERT_EQ(flag.parts.size(), 1u);
  EXPECT_EQ(flag.parts[0].triangles.size(), 2u);
  EXPECT_EQ(flag.parts[0].joints.size(), 2u);
  for (const Influence& influence : flag.parts[0].influences)
    EXPECT_EQ(influence.weight, 1) << "made to sum to 1";
  ASSERT_EQ(flag.animations.size(), 1u);
  const Animation& wave = flag.animations[0];
  EXPECT_EQ(wave.name, "Wave");
  EXPECT_GT(wave.seconds, 0);
  std::vector<Vec3> at_rest, waved;
  skin(flag, bind_pose(flag), at_rest);
  skin(flag, pose_at(flag, wave, wave.start + wave.seconds), waved);
  double moved = 0, still = 0;
  for (std::size_t v = 0; v < waved.size(); ++v) {
    const bool upper =
        flag.parts[0]
                .joints[static_cast<std::size_t>(flag.parts[0].influences[flag.parts[0].first[v]].joint)]
                .node != 0 &&
        flag.nodes[static_cast<std::size_t>(flag.parts[0]
                                                .joints[static_cast<std::size_t>(
                                                    flag.parts[0].influences[flag.parts[0].first[v]].joint)]
                                                .node)]
                .name == "Upper";
    (upper ? moved : still) += (waved[v] - at_rest[v]).norm();
  }
  EXPECT_GT(moved, 1.5);
  EXPECT_LT(still, 1e-6);
}

// Mutation: assimp takes a comma for a decimal point.
TEST_F(Model, RefusesKeysOfMoreValuesThanTheyCount) {
  std::string text = kXFile;
  const std::string three = "4800; 3; 1.0, 2.0, 0.0";
  text.replace(text.find(three), three.size(), "4800; 3; 1,0, 2.0, 0.0");
  EXPECT_TRUE(says(test::refusal([&] { read_model(write("flag.x", text), {}); }),
                   "an animation key has more values than it counts"));
}

// The clip lasts 4800 ticks. Where the file does not give the ticks a second, 25 are taken.
TEST_F(Model, TicksPerSecondOfAnyKindBecomeSeconds) {
  for (const int ticks : {1000, 24, 4800, 120, 0}) {
    const std::string said = ticks == 0 ? "" : "AnimTicksPerSecond { " + std::to_string(ticks) + "; }\n";
    const Character flag = read_model(write("flag.x", kXFile + said), {});
    ASSERT_EQ(flag.animations.size(), 1u);
    EXPECT_EQ(flag.animations[0].ticks_per_second, ticks);
    EXPECT_NEAR(flag.animations[0].seconds, 4800.0 / (ticks == 0 ? 25 : ticks), 1e-9);
  }
}

// Two triangles that hang on a bone, in units of 2.54 centimetres. The bone has a pivot, which turns
// it into a chain of helper nodes, and a curve moves it by 3 in a second.
constexpr char kFbxFile[] = R"(; FBX 7.3.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7300
}
GlobalSettings:  {
	Version: 1000
	Properties70:  {
		P: "UnitScaleFactor", "double", "Number", "",2.54
		P: "TimeMode", "enum", "", "",11
	}
}
Objects:  {
	Geometry: 10, "Geometry::Flag", "Mesh" {
		Vertices: *12 { a: 0,0,0,1,0,0,1,2,0,0,2,0 }
		PolygonVertexIndex: *6 { a: 0,1,-3,0,2,-4 }
		GeometryVersion: 124
	}
	Model: 20, "Model::Flag", "Mesh" { Version: 232 }
	Model: 30, "Model::Pole", "LimbNode" {
		Version: 232
		Properties70:  {
			P: "RotationPivot", "Vector3D", "Vector", "",0,1,0
			P: "PreRotation", "Vector3D", "Vector", "",0,0,90
			P: "RotationActive", "bool", "", "",1
			P: "Lcl Translation", "Lcl Translation", "", "A",5,0,0
		}
	}
	NodeAttribute: 31, "NodeAttribute::", "LimbNode" { TypeFlags: "Skeleton" }
	Deformer: 40, "Deformer::", "Skin" { Version: 101 }
	Deformer: 41, "SubDeformer::", "Cluster" {
		Version: 100
		Indexes: *4 { a: 0,1,2,3 }
		Weights: *4 { a: 1,1,1,1 }
		Transform: *16 { a: 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1 }
		TransformLink: *16 { a: 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1 }
	}
	AnimationStack: 50, "AnimStack::", "" {
		Properties70:  {
			P: "LocalStop", "KTime", "Time", "",46186158000
			P: "ReferenceStop", "KTime", "Time", "",46186158000
		}
	}
	AnimationLayer: 51, "AnimLayer::Base", "" { }
	AnimationCurveNode: 52, "AnimCurveNode::T", "" { Properties70:  { P: "d|Y", "Number", "", "A",0 } }
	AnimationCurve: 54, "AnimCurve::", "" {
		KeyTime: *2 { a: 0,46186158000 }
		KeyValueFloat: *2 { a: 5,5 }
	}
	AnimationCurve: 53, "AnimCurve::", "" {
		KeyTime: *2 { a: 0,46186158000 }
		KeyValueFloat: *2 { a: 0,3 }
	}
}
Connections:  {
	C: "OO",20,0
	C: "OO",30,0
	C: "OO",10,20
	C: "OO",31,30
	C: "OO",40,10
	C: "OO",41,40
	C: "OO",30,41
	C: "OO",51,50
	C: "OO",52,51
	C: "OP",52,30, "Lcl Translation"
	C: "OP",53,52, "d|Y"
	C: "OP",54,52, "d|X"
}
)";

TEST_F(Model, FbxFilesSayWhichAxisPointsUp) {
  const auto up_of = [&](const std::string& settings) {
    std::string text = kFbxFile;
    text.insert(text.find("\t\tP: \"UnitScaleFactor\""), settings);
    return read_model(write("flag.fbx", text), {}).up;
  };
  const std::string axis = "P: \"UpAxis\", \"int\", \"Integer\", \"\",",
                    sign = "P: \"UpAxisSign\", \"int\", \"Integer\", \"\",";
  EXPECT_EQ(up_of(""), "");
  EXPECT_EQ(up_of(axis + "2\n"), "z");
  EXPECT_EQ(up_of(axis + "1\n" + sign + "1\n"), "y");
  EXPECT_EQ(up_of(axis + "0\n" + sign + "-1\n"), "-x");
  EXPECT_EQ(up_of(axis + "7\n"), "");
}

TEST_F(Model, HelperNodesOfFbxMoveBonesAndAreNone) {
  const Character flag = read_model(write("flag.fbx", kFbxFile), {});
  std::size_t helpers = 0;
  for (const Node& node : flag.nodes) helpers += node.name.find("(helper)") != std::string::npos;
  EXPECT_GE(helpers, 1u);
  EXPECT_NEAR(flag.centimetres_per_unit, 2.54, 1e-6);
  ASSERT_EQ(flag.animations.size(), 1u);
  EXPECT_EQ(flag.animations[0].name, "");
  EXPECT_NEAR(flag.animations[0].seconds, 1, 1e-6);

  std::vector<Vec3> at_start, at_end;
  const Animation& clip = flag.animations[0];
  skin(flag, pose_at(flag, clip, clip.start), at_start);
  skin(flag, pose_at(flag, clip, clip.start + clip.seconds), at_end);
  ASSERT_EQ(at_end.size(), 4u);
  for (std::size_t v = 0; v < at_end.size(); ++v) {
    // A quarter turn about the pivot (0, 1, 0), then the move, in the file's own units.
    const Vec3& x = flag.parts[0].positions[v];
    EXPECT_LT((at_start[v] - Vec3(5 - (x.y() - 1), 1 + x.x(), 0)).norm(), 1e-5);
    EXPECT_LT((at_end[v] - at_start[v] - Vec3(0, 3, 0)).norm(), 1e-5);
  }
  const Pose bound = bind_pose(flag);
  const Skeleton skeleton = make_skeleton(flag, bound, at_start, std::vector<bool>(at_start.size(), true));
  ASSERT_EQ(skeleton.node.size(), 1u);
  EXPECT_EQ(flag.nodes[static_cast<std::size_t>(skeleton.node[0])].name, "Pole");
}

TEST_F(Model, NamesThatTwoNodesHaveAreRefused) {
  const std::string frame = " Frame Upper { }\n Mesh Flag {";
  EXPECT_TRUE(says(refusal(write("twin.x", replaced(kXFile, " Mesh Flag {", frame))),
                   "'Upper': two nodes have this name"));
  // A joint is named by its scoped id, which may occur again in another branch.
  const std::string twin = R"(<node id="other" sid="j2" name="other"/><node id="mesh")";
  std::string dae = replaced(kColladaFile, "low high", "low j2");
  dae = replaced(dae, R"(sid="high" name="high")", R"(sid="j2" name="second")");
  EXPECT_EQ(refusal(write("scoped.dae", dae)), "");
  EXPECT_TRUE(says(refusal(write("twin.dae", replaced(dae, R"(<node id="mesh")", twin))),
                   "bone 'j2': several nodes"));
}

TEST_F(Model, NumbersOfXFilesAreNumbersOrRefused) {
  for (const std::string word :
       {"1.#IND00", "-1.#IND00", "1.#QNAN0", "1.#INF", "nan", "-inf", "2.0f", "0x10"})
    for (const std::string place : {"1.0;2.0;0.0;", "1.0, 2.0, 0.0;;;", "0.0, 2.0, 0.0;;, 4800"}) {
      std::string with = place;
      with.replace(with.find("2.0"), 3, word);
      EXPECT_TRUE(
          says(refusal(write("bad.x", replaced(kXFile, place, with))), word + "' stands where a number"))
          << place;
    }
  const std::string named =
      replaced(kXFile, "AnimationSet Wave", "// 1.#IND is a comment\n# nan\nAnimationSet 01_Wave");
  EXPECT_EQ(refusal(write("named.x", "\xEF\xBB\xBF" + named)), "");
  EXPECT_TRUE(says(refusal(write("wide.x", std::string("\xFF\xFEx\0", 4))), "is text in UTF-16"));
}

// A polygon with a notch. assimp mirrors X files, and so turns their faces round.
TEST_F(Model, PolygonsOfXFilesAreCutInside) {
  const std::string dart = replaced(replaced(kXFile, "2;\n  3;0,1,2;,\n  3;0,2,3;;", "1;\n  4;0,1,2,3;;"),
                                    "1.0;0.0;0.0;, 1.0;2.0;0.0;", "1.0;0.5;0.0;, 2.0;0.0;0.0;");
  const Character flag = read_model(write("dart.x", dart), {});
  using Corners = std::vector<std::array<std::int32_t, 3>>;
  EXPECT_EQ(flag.parts[0].triangles, (Corners{{3, 2, 1}, {3, 1, 0}}));
}

// assimp leaves out corners of vertices that do not exist, and vertices of no face.
TEST_F(Model, FacesOfXFilesNameVerticesThatExist) {
  const std::string text = kXFile;
  const auto with = [&](const std::string& corners) {
    std::string other = text;
    return write("flag.x", other.replace(other.find("3;0,2,3;;"), 9, corners));
  };
  for (const std::string vertex : {"4", "99", "-1", "1.5"})
    EXPECT_TRUE(says(refusal(with("4;0,2,3," + vertex + ";;")),
                     "mesh 'Flag', face 1 (counted from 0): names vertex " + vertex + " of 4"));
  EXPECT_EQ(read_model(with("3;0,2,3;;"), {}).notes, std::vector<std::string>{});
  EXPECT_EQ(read_model(with("3;0,1,2;;"), {}).notes,
            std::vector<std::string>{"1 vertex is of no face and is left out: no answer is about it"});
  // The template of a mesh is none, nor is what has its name.
  std::string named = text;
  const std::string material = "Material Mesh { 1; 1; 1; 1;; 1; 3; 9; 9;; 0; 0; 0;; }\n ";
  EXPECT_EQ(refusal(write("named.x", named.insert(named.find("Mesh Flag"), material))), "");
  const std::string made = "template Mesh {\n <3d82ab44-62da-11cf-ab39-0020af71e433>\n DWORD nVertices;\n}\n";
  std::string other = text;
  EXPECT_EQ(refusal(write("made.x", other.insert(other.find("Frame"), made))), "");
}

TEST_F(Model, RefusesOtherKindsAndDamage) {
  EXPECT_TRUE(says(refusal(write("a.obj", "v 0 0 0\n")), "'.obj' are not read"));
  EXPECT_TRUE(says(refusal(write("a", "xof")), "has no extension, by which"));
  EXPECT_TRUE(says(refusal(write("cut.x", std::string(kXFile).substr(0, 300))), "refuses it"));
  // glTF 1 has the same extension, and assimp has an importer for it, which must not be used.
  EXPECT_TRUE(says(refusal(write("old.gltf", R"({"asset":{"version":"1.0"},"meshes":{}})")), "glTF 2"));
}

}  // namespace
}  // namespace cscd::scenes
