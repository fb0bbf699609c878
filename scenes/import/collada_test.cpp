#include <filesystem>
#include <gtest/gtest.h>

#include "core/base/test_folder.h"
#include "core/base/test_refusal.h"
#include "scenes/base/test_says.h"
#include "scenes/character/pose.h"
#include "scenes/import/read_model.h"
#include "scenes/import/test_collada.h"

namespace cscd::scenes {
namespace {

class Collada : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    test::write(scratch.path / name, text);
    return (scratch.path / name).string();
  }
  std::string refusal(const std::string& file) {
    return test::refusal([&] { read_model(file, {}); });
  }
  std::string refusal_of(const std::string& text) { return refusal(write("flag.dae", text)); }
  // The positions of the vertices in the bind pose and at the end of the clip.
  std::pair<std::vector<Vec3>, std::vector<Vec3>> ends_of(const std::string& text) {
    const Character flag = read_model(write("flag.dae", text), {});
    std::pair<std::vector<Vec3>, std::vector<Vec3>> ends;
    skin(flag, bind_pose(flag), ends.first);
    skin(flag, pose_at(flag, flag.animations[0], flag.animations[0].start + 0.5), ends.second);
    return ends;
  }
  const test::Folder scratch;
};

TEST_F(Collada, SkinsAreRead) {
  const Character flag = read_model(write("flag.dae", kColladaFile), {});
  EXPECT_EQ(flag.format, "Collada");
  ASSERT_EQ(flag.parts.size(), 1u);
  ASSERT_EQ(flag.parts[0].joints.size(), 2u);
  ASSERT_EQ(flag.animations.size(), 1u);
  EXPECT_NEAR(flag.animations[0].seconds, 0.5, 1e-6);
  std::vector<Vec3> bound, risen;
  skin(flag, bind_pose(flag), bound);
  skin(flag, pose_at(flag, flag.animations[0], flag.animations[0].start + 0.5), risen);
  // assimp converts Collada's units to metres.
  for (std::size_t v = 0; v < bound.size(); ++v) {
    const Vec3& x = flag.parts[0].positions[v];
    EXPECT_LT((bound[v] - 0.01 * x).norm(), 1e-7);
    EXPECT_LT((risen[v] - 0.01 * x - Vec3(0, x.y() > 1 ? 0.01 : 0, 0)).norm(), 1e-7);
  }
}

TEST_F(Collada, KeysThatAreNotJoinedByLinesAreRefusedUnlessDense) {
  for (const std::string kind : {"STEP", "BEZIER", "HERMITE", "CARDINAL"}) {
    const std::string bent = replaced(kColladaFile, "LINEAR LINEAR", kind + " LINEAR");
    EXPECT_TRUE(
        says(refusal(write("bent.dae", bent)), "channel 'high/transform': its keys are joined by " + kind));
    const Character dense = read_model(write("dense.dae", replaced(bent, ">0 0.5<", ">0 0.016<")), {});
    ASSERT_EQ(dense.notes.size(), 1u);
    EXPECT_TRUE(says(dense.notes[0], "1 animation channels of keys joined by curves"));
  }
  // Steps are accepted after the last key, which is joined to none, and between equal keys, where every way
  // of joining gives a straight line.
  EXPECT_EQ(refusal(write("last.dae", replaced(kColladaFile, "LINEAR LINEAR", "LINEAR STEP"))), "");
  const std::string still =
      replaced(kColladaFile, "1 0 0 0 0 1 0 3 0 0 1 0 0 0 0 1", "1 0 0 0 0 1 0 2 0 0 1 0 0 0 0 1");
  EXPECT_EQ(refusal(write("still.dae", replaced(still, "LINEAR LINEAR", "STEP STEP"))), "");
}

// A corner may have further indices, as that of a normal, which name no vertices.
TEST_F(Collada, FurtherIndicesOfCornersAreNotVertices) {
  const std::string text = replaced(
      kColladaFile, R"(offset="0"/><p>0 1 2 0 2 3</p>)",
      R"(offset="0"/><input semantic="NORMAL" source="#p" offset="1"/><p>0 9 4 9 2 9 0 9 2 9 3 9</p>)");
  EXPECT_TRUE(says(refusal(write("far.dae", text)), "entry 2 (counted from 0) names vertex 4 of 4"));
}

constexpr char kShape[] = "<bind_shape_matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>";

TEST_F(Collada, SkinsWithoutBindShapeTakeTheIdentity) {
  EXPECT_EQ(ends_of(replaced(kColladaFile, kShape, "")), ends_of(kColladaFile));
  const std::string moved = "<bind_shape_matrix>1 0 0 7 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>";
  EXPECT_NEAR(ends_of(replaced(kColladaFile, kShape, moved)).first[0].x(), 0.07, 1e-7);
}

// Joint -1 is the bind shape: its vertices stay where the shape is bound, whatever the joints do.
TEST_F(Collada, JointMinusOneIsTheBindShape) {
  const auto plain = ends_of(kColladaFile);
  std::string text = replaced(kColladaFile, "<v>0 0 0 0 1 0 1 0</v>", "<v>-1 0 0 0 1 0 -1 0</v>");
  const auto [bound, risen] = ends_of(text);
  EXPECT_EQ(bound, plain.first);
  for (std::size_t v = 0; v < risen.size(); ++v) {
    const bool rises = v == 2 || v == 4;  // corners of both triangles at the third vertex
    EXPECT_EQ(risen[v], rises ? plain.second[v] : plain.first[v]) << v;
  }
  // Also beside other indices, in another order, and where a node has that name.
  text = replaced(
      text,
      R"(<input semantic="JOINT" source="#j" offset="0"/><input semantic="WEIGHT" source="#w" offset="1"/>)",
      R"(<input semantic="WEIGHT" source="#w" offset="0"/><input semantic="JOINT" source="#j" offset="2"/>)");
  text = replaced(text, "<v>-1 0 0 0 1 0 -1 0</v>", "<v>0 9 -1 0 9 0 0 9 1 0 9 -1</v>");
  text = replaced(text, R"(id="mesh" name="mesh")", R"(id="mesh" name="bind_shape")");
  EXPECT_EQ(ends_of(text).second, risen);
}

TEST_F(Collada, NumbersAreNumbersOrRefusedByTheirElement) {
  struct Place {
    const char *text, *word, *element;
  };
  const Place places[] = {
      {">0 0 0 1 0 0 1 2 0 0 2 0<", "1 2", "<float_array> 'pa'"},
      {"<bind_shape_matrix>1 0", "1", "<bind_shape_matrix> of <controller> 'skin'"},
      {"0 0 1 0 -2 0 0 1 0 0 0 0 1</float_array>", "-2", "<float_array> 'ba'"},
      {"count=\"1\">1<", ">1<", "<float_array> 'wa'"},
      {">0 0.5<", "0.5", "animation channel 'high/transform': <float_array> 'ta'"},
      {"0 1 0 3 0 0 1", "3", "animation channel 'high/transform': <float_array> 'ma'"},
      {"<matrix sid=\"transform\">1 0 0 0 0 1 0 2", "2", "<matrix> of <node> 'high'"},
      {"<v>0 0 0 0 1 0 1 0</v>", "1 0 1", "<v> of <controller> 'skin'"},
      {"<vcount>1 1", "1", "<vcount> of <controller> 'skin'"},
      {"<p>0 1 2", "1", "<p> of <geometry> 'flag'"},
      {"meter=\"0.01\"", "0.01", "<unit>"},
  };
  for (const Place& place : places)
    for (const std::string word : {"-1.#IND00", "1.#INF", "2,5", "nan", "INF", "1e400", "0x10", "1.5f"}) {
      std::string with = place.text, old = place.word;
      const bool bracketed = old.starts_with('>');
      const std::size_t size = bracketed ? 1 : old.find(' ') == old.npos ? old.size() : old.find(' ');
      with.replace(with.find(old) + bracketed, size, word);
      const std::string refused = refusal_of(replaced(kColladaFile, place.text, with));
      EXPECT_TRUE(says(refused, place.element)) << word;
      EXPECT_TRUE(says(refused, "'" + word + "'")) << place.element;
    }
  // Numbers in other forms, in pieces, and in what moves nothing.
  EXPECT_EQ(ends_of(replaced(kColladaFile, ">0 0 0 1 0 0 1 2 0",
                             ">0 +0.0 -0 1e0\n\t0 <!-- 5 -->0 1.<![CDATA[ 2]]> .0")),
            ends_of(kColladaFile));
}

TEST_F(Collada, IndicesThatDoNotExistAreRefused) {
  const auto weights = [&](const std::string& v) {
    return refusal_of(replaced(kColladaFile, "<v>0 0 0 0 1 0 1 0</v>", "<v>" + v + "</v>"));
  };
  EXPECT_TRUE(says(weights("0 0 2 0 1 0 1 0"), "entry 2 of <v> (counted from 0) names joint 2 of 2"));
  EXPECT_TRUE(says(weights("0 0 0 1 1 0 1 0"), "entry 3 of <v> (counted from 0) names weight 1 of 1"));
  EXPECT_TRUE(says(weights("0 0 -2 0 1 0 1 0"), "'-2', is no index"));
  EXPECT_TRUE(says(weights("0 0 0 -1 1 0 1 0"), "names weight -1 of 1"));
  EXPECT_TRUE(says(weights("0 0 0 0 1 0"), "do not fit one another"));
  EXPECT_TRUE(says(refusal_of(replaced(kColladaFile, "<p>0 1 2 0 2 3</p>", "<p>0 1 2 0 2 4</p>")),
                   "<p> of <geometry> 'flag': entry 5 (counted from 0) names vertex 4 of 4"));
  EXPECT_TRUE(
      says(refusal_of(replaced(kColladaFile, "<p>0 1 2 0 2 3</p>", "<p>0 1 2 0 2 -1</p>")), "is no index"));
  EXPECT_TRUE(says(refusal_of(replaced(kColladaFile, "count=\"12\"", "count=\"13\"")),
                   "says that it has 13 numbers, and has 12"));
  EXPECT_TRUE(
      says(refusal_of(replaced(kColladaFile, "source=\"#pa\" count=\"4\"", "source=\"#pa\" count=\"5\"")),
           "its accessor names numbers behind the last one"));
  EXPECT_TRUE(says(refusal_of(replaced(kColladaFile, ">0 0.5<", ">0.5 0.5<")), "the time of key 1"));
}

// assimp drops channels whose target it does not find without a word.
TEST_F(Collada, ChannelsMoveWhatExistsOrAreRefused) {
  const auto to = [](const std::string& target) {
    return replaced(kColladaFile, "target=\"high/transform\"", "target=\"" + target + "\"");
  };
  for (const std::string id : {"hihg", "High", " high", "."})
    EXPECT_TRUE(says(refusal_of(to(id + "/transform")),
                     "channel '" + id + "/transform': no element of the file has the id '" + id + "'"));
  for (const std::string sid : {"Transform", "matrix", ""})
    EXPECT_TRUE(says(refusal_of(to("high/" + sid)),
                     "channel 'high/" + sid + "': node 'high' has no transform with the sid '" + sid + "'"));
  EXPECT_TRUE(says(refusal_of(to("high")), "has no transform"));
  EXPECT_TRUE(says(refusal_of(to("pa(0)")), "channel 'pa(0)': moves a geometry itself"));
  EXPECT_TRUE(says(refusal_of(to("wa(0)")), "channel 'wa(0)': moves a controller itself"));
  EXPECT_TRUE(says(refusal_of(replaced(replaced(to("h.i.gh/transform"), "id=\"high\"", "id=\"h.i.gh\""),
                                       "low high", "low h.i.gh")),
                   "channel 'h.i.gh/transform': points and brackets in the id"));
  // What has no bearing on positions gets a note.
  const std::string second = R"(<channel source="#s" target="TARGET"/></animation>)";
  const std::string eye = "<library_cameras><camera id=\"eye\"/></library_cameras><library_visual_scenes>";
  std::string text = replaced(kColladaFile, "</animation>", replaced(second, "TARGET", "eye/xfov"));
  text = replaced(text, "</animation>", replaced(second, "TARGET", "low/visibility"));
  text = replaced(text, "<library_visual_scenes>", eye);
  text = replaced(text, "<node id=\"high\"",
                  "<extra><technique><visibility sid=\"visibility\">1</visibility></technique></extra>"
                  "<node id=\"high\"");
  EXPECT_EQ(ends_of(text), ends_of(kColladaFile));
  EXPECT_EQ(read_model(write("eye.dae", text), {}).notes,
            std::vector<std::string>{"2 animation channels move no node of the scene and are ignored"});
}

TEST_F(Collada, VerticesWithoutWeightsOrFacesAreCounted) {
  const auto notes_of = [&](const std::string& text) {
    return read_model(write("flag.dae", text), {}).notes;
  };
  const std::string one = "<v>0 0 0 0 1 0 1 0</v>", vcount = "<vcount>1 1 1 1</vcount>";
  const std::string follow =
      " vertices of skins have no weight above 0: they follow the node of their mesh, without its bind shape";
  EXPECT_EQ(notes_of(kColladaFile), std::vector<std::string>{});
  EXPECT_EQ(notes_of(replaced(replaced(kColladaFile, vcount, "<vcount>1 0 2 0</vcount>"), one,
                              "<v>0 0 1 0 0 0</v>")),
            std::vector<std::string>{"2" + follow});
  const auto weight = [&](const std::string& by) {
    return replaced(kColladaFile, R"(<float_array id="wa" count="1">1<)",
                    R"(<float_array id="wa" count="1">)" + by + "<");
  };
  EXPECT_EQ(notes_of(weight("0")), std::vector<std::string>{"4" + follow});
  EXPECT_TRUE(says(refusal_of(weight("-1")),
                   "<controller> 'skin': entry 1 of <v> (counted from 0) names weight 0, which is negative"));
  EXPECT_TRUE(says(refusal_of(replaced(kColladaFile, ">low high<", ">low hihg<")),
                   "bone 'hihg': has weights, and no node has this name"));
  // A joint without weights needs no node.
  EXPECT_EQ(
      refusal_of(replaced(replaced(kColladaFile, ">low high<", ">low hihg<"), one, "<v>0 0 0 0 0 0 0 0</v>")),
      "");
  EXPECT_EQ(notes_of(replaced(kColladaFile, "0 1 2 0 2 3", "0 1 2 0 2 1")),
            std::vector<std::string>{"1 vertex is of no face and is left out: no answer is about it"});
}

TEST_F(Collada, RefusesByNameWhatAssimpReadsWrongly) {
  const std::string morph =
      R"(<library_controllers><controller id="smile"><morph source="#flag"><targets/></morph></controller>)";
  EXPECT_TRUE(says(refusal_of(replaced(kColladaFile, "<library_controllers>", morph)),
                   "<controller> 'smile': is a morph, and morph targets of Collada files are not read"));
  EXPECT_TRUE(
      says(refusal_of(replaced(kColladaFile, R"(<node id="mesh")",
                               R"(<node id="bent"><skew>30 1 0 0 0 1 0</skew></node><node id="mesh")")),
           "<skew> of <node> 'bent': skewed nodes are not read"));
  EXPECT_TRUE(
      says(refusal_of(replaced(replaced(kColladaFile, "<triangles", "<trifans"), "</triangles", "</trifans")),
           "<trifans> of <geometry> 'flag': fans of triangles are not read"));
  for (const char* member : {"(3)", ".ANGLE", ".X", "(0)(4)"})
    EXPECT_TRUE(
        says(refusal_of(replaced(kColladaFile, "high/transform", std::string("high/transform") + member)),
             "moves a part of a transform that is not read"))
        << member;
  // Mutation: assimp takes one number of a key for several of the transform.
  EXPECT_TRUE(says(refusal_of(replaced(kColladaFile, "high/transform", "high/transform(0)(3)")),
                   "has 16 numbers a key, and what it moves has 1"));
  EXPECT_TRUE(says(refusal_of("<COLLADA><asset"), "is no XML at byte"));
  EXPECT_TRUE(says(refusal_of("<html/>"), "has no element <COLLADA>"));
}

TEST_F(Collada, PolygonsAreCutInside) {
  std::string dart =
      replaced(replaced(kColladaFile, "<triangles count=\"2\">", "<polylist count=\"1\">"),
               "<p>0 1 2 0 2 3</p></triangles>", "<vcount>4</vcount><p>0 1 2 3</p></polylist>");
  dart = replaced(dart, ">0 0 0 1 0 0 1 2 0 0 2 0<", ">0 0 0 1 0.5 0 2 0 0 1 2 0<");
  const Character flag = read_model(write("dart.dae", dart), {});
  using Corners = std::vector<std::array<std::int32_t, 3>>;
  EXPECT_EQ(flag.parts[0].triangles, (Corners{{0, 1, 3}, {1, 2, 3}}));
}

}  // namespace
}  // namespace cscd::scenes
