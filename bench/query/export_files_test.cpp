#include <algorithm>
#include <cctype>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/testing/test_queries.h"
#include "scenes/clip/point_cache.h"

// The files that cscd export writes for other programs: read back by cscd, and opened by the readers of VTK
// and meshio where Debian's packages are installed.
namespace cscd::bench {
namespace {

using nlohmann::json;

class ExportFiles : public QueryProgram {
 protected:
  // Runs a script of Python; skips the test without the module.
  std::string python(const std::string& module, const std::string& script) const {
    if (run("/usr/bin/python3 -c 'import " + module + "'").status != 0) return "skip";
    const Ran ran = run("/usr/bin/python3 - <<'SCRIPT'\n" + script + "\nSCRIPT");
    EXPECT_EQ(ran.status, 0) << ran.errors;
    return ran.out;
  }
  // Writes late.glb, the figure with clips that begin so many seconds after frame 0.
  static constexpr double kLate = 0.2;
  void put_late_figure() const {
    scenes::Character figure = scenes::walking_figure();
    for (scenes::Animation& clip : figure.animations) {
      clip.start += kLate;
      for (scenes::Channel& channel : clip.channels) {
        for (auto& key : channel.moves) key.time += kLate;
        for (auto& key : channel.rotations) key.time += kLate;
        for (auto& key : channel.scales) key.time += kLate;
      }
    }
    put("late.glb", scenes::to_glb(figure));
  }
};

// Verdict and time of each interval.
std::vector<std::pair<std::string, double>> verdicts(const json& answer) {
  std::vector<std::pair<std::string, double>> out;
  for (const json& interval : answer["intervals"])
    out.emplace_back(interval["verdict"], interval["time"].is_null() ? -1 : interval["time"].get<double>());
  return out;
}

TEST_F(ExportFiles, ExactFormatsAreAnsweredAlikeAndSinglePrecisionNearly) {
  // The eyes cross the head at rest, which a moving surface alone cannot say.
  const auto expected = verdicts(answer("figure.glb --clip hug --component largest"));
  ASSERT_GT(
      std::count_if(expected.begin(), expected.end(), [](const auto& v) { return v.first == "touches"; }), 0);
  for (const char* output : {"exact.obj", "exact.ply", "near.pc2", "near.mdd --force", "baked.glb --bake"}) {
    const Ran ran = run(std::string("cscd export figure.glb --clip hug --component largest ") + output);
    ASSERT_EQ(ran.status, 0) << output << ran.errors;
  }
  EXPECT_EQ(verdicts(answer("exact.0000.obj")), expected);
  EXPECT_EQ(verdicts(answer("exact.0007.ply")), expected);
  // A folder stands for the one sequence in it.
  const Ran two = run("cscd query . -- 2>&1");
  EXPECT_EQ(two.status, 2);
  EXPECT_NE(two.out.find("is a folder with 4 sequences, such as those of "), std::string::npos) << two.out;
  ASSERT_EQ(run("mkdir frames && cp exact.*.ply frames").status, 0);
  EXPECT_EQ(verdicts(answer("frames")), expected);
  const Ran fps = run("cscd query exact.0000.obj --fps 60 --frames 0:1 -- 2>&1");
  EXPECT_NE(fps.out.find("60 frames a second, as asked"), std::string::npos) << fps.out;
  EXPECT_NE(fps.out.find("files, exact.0000.obj to exact.00"), std::string::npos) << fps.out;
  // A cache says its rate, and the names of a sequence say the numbers of its frames.
  ASSERT_EQ(run("cscd export figure.glb --clip hug --component largest --fps 24 film.mdd && "
                "for f in exact.*.ply; do n=${f#exact.}; n=${n%.ply}; mv $f late.$((1000 + 10#$n)).ply; done")
                .status,
            0);
  EXPECT_NE(run("cscd query film.mdd").out.find("24 frames a second, as the file says"), std::string::npos);
  // All times of the frames are 0.
  ASSERT_EQ(run("cp film.obj still.obj && cp film.mdd still.mdd && dd if=/dev/zero of=still.mdd bs=4 seek=2 "
                "conv=notrunc count=" +
                std::to_string(expected.size() + 1) + " 2>/dev/null")
                .status,
            0);
  const std::string still = run("cscd query still.mdd").out;
  EXPECT_NE(still.find("30 frames a second"), std::string::npos) << still;
  EXPECT_NE(still.find("note: its frames are not evenly spaced in time"), std::string::npos) << still;
  const json late = answer("late.1003.ply");
  EXPECT_EQ(verdicts(late), expected);
  EXPECT_EQ(late["intervals"][0]["frame"], 1000);
  for (const char* input : {"near.pc2", "near.mdd", "baked.glb"}) {
    const auto found = verdicts(answer(input));
    ASSERT_EQ(found.size(), expected.size()) << input;
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].first, expected[i].first) << input << " " << i;
      EXPECT_NEAR(found[i].second, expected[i].second, 1e-2) << input << " " << i;
    }
  }
}

// Mutation: a format counts its frames from 0.
TEST_F(ExportFiles, FramesKeepTheNumbersOfTheirClip) {
  put_late_figure();
  const json first = answer("late.glb --clip hug --component largest")["summary"]["first"];
  ASSERT_GT(first["frame"], 6);
  for (const char* output : {"f.obj", "f.ply", "f.pc2 --force", "f.mdd --force", "f.glb --bake", "f.usda"}) {
    const Ran ran = run(std::string("cscd export late.glb --clip hug --component largest ") + output);
    ASSERT_EQ(ran.status, 0) << output << ran.errors;
    EXPECT_EQ(ran.out.find("count from 0"), std::string::npos) << output << ran.out;
  }
  for (const char* input : {"f.0006.obj", "f.0006.ply", "f.pc2", "f.mdd", "f.glb"})
    EXPECT_NEAR(answer(input)["summary"]["first"]["frame"].get<double>(), first["frame"].get<double>(), 0.01)
        << input;
  EXPECT_NE(text("f.usda").find("startTimeCode = 6\n    endTimeCode = 36\n"), std::string::npos);
  EXPECT_NE(text("f.usda").find("points.timeSamples = {\n            6: ["), std::string::npos);
  // Names of files hold whole numbers alone, and a point cache none.
  EXPECT_NE(
      run("cscd export late.glb --clip hug f.h5").out.find("has the number 6, and the files count from 0"),
      std::string::npos);
  EXPECT_NE(run("cscd export late.glb --clip hug --fps 24 g.obj").out.find("has the number 4.8, and"),
            std::string::npos);
  EXPECT_TRUE(fs::exists(folder / "g.0000.obj"));
}

// Mutation: frames before frame 0 are counted from 0.
TEST_F(ExportFiles, FramesBeforeZeroKeepTheirNumbers) {
  for (const char* name : {"c.-2.obj", "c.-1.obj", "c.0.obj"})
    put(name, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 " + std::string(name[2] == '-' ? "1" : "2") +
                  "\nv 1 0 1\nv 0 1 1\nf 1 2 3\nf 4 5 6\n");
  for (const char* output : {"f.obj", "f.ply", "f.pvd"}) {
    const Ran ran = run(std::string("cscd export c.0.obj ") + output);
    ASSERT_EQ(ran.status, 0) << output << ran.errors;
    EXPECT_EQ(ran.out.find("count from 0"), std::string::npos) << output << ran.out;
  }
  for (const char* file : {"f.-0002.obj", "f.-0001.ply", "f.0000.ply", "f.-0002.vtp"})
    EXPECT_TRUE(fs::exists(folder / file)) << file;
  const Ran read = run("cscd query f.0000.obj --frames -2:-1");
  EXPECT_EQ(read.status, 0) << read.errors;
  EXPECT_NE(read.out.find("3 frames, from frame -2 to 0"), std::string::npos) << read.out;
  EXPECT_EQ(answer("f.-0001.ply")["intervals"][0]["frame"], -2);
}

TEST_F(ExportFiles, NothingIsWrittenWhereOneFileStandsInTheWay) {
  put("walk.0003.obj", "mine");
  expect_refused(run("cscd export small walk.obj"), "walk.0003.obj");
  put("cache.obj", "mine");
  expect_refused(run("cscd export small cache.pc2"), "cache.obj");
  EXPECT_EQ(files(), "cache.obj figure.glb walk.0003.obj");
  EXPECT_EQ(run("cscd export small walk.obj --force").status, 0);
  expect_refused(run("cscd export small walk.pc2 --bake"), "--bake");
  expect_refused(run("cscd export small walk.stl"), ".usda");
}

TEST_F(ExportFiles, RefusesSequencesThatAreNone) {
  ASSERT_EQ(
      run("cscd export small a.obj && cscd export small c.pc2 && cscd export small c.mdd --force").status, 0);
  const struct {
    const char *change, *query, *line;
  } kCases[] = {
      {"mv a.0002.obj kept", "a.0000.obj", "frame 2 of its sequence is missing before a.0003.obj"},
      {"mv kept a.0002.obj; head -n -1 a.0002.obj > b; mv b a.0002.obj", "a.0000.obj",
       "other faces than the first"},
      {"grep -v '^v ' a.0001.obj > b; mv b a.0001.obj", "a.0000.obj", "a.0001.obj: has no vertices"},
      {"printf 'v 0 0\\n' > a.0001.obj", "a.0000.obj", "a.0001.obj: line 1: has 2 coordinates of 3"},
      {"printf 'v 0 0 0\\nf 1 2 9\\n' > a.0000.obj", "a.0000.obj",
       "a.0000.obj: line 2: a face names vertex 9"},
      {"head -c 500 c.pc2 > d.pc2; cp c.obj d.obj", "d.pc2", "which is not what its 500 bytes hold"},
      {"cp c.mdd e.mdd", "e.mdd", "has no faces; put the OBJ file"},
      {"cp c.obj n.obj; cp c.pc2 n.pc2; printf '\\0\\0\\300\\177' | dd of=n.pc2 bs=1 seek=44 conv=notrunc "
       "2>/dev/null",
       "n.pc2", "n.pc2: frame 0, vertex 1: a coordinate is not finite"},
      {"printf 'ply\\nformat ascii 1.0\\nend_header\\n' | tee f.1.ply > f.2.ply", "f.1.ply",
       "has no vertices"},
      {"true", "c.pc2 --clip x", "leave out all options"},
  };
  for (const auto& one : kCases) {
    ASSERT_EQ(run(one.change).status, 0) << one.change;
    expect_refused(run(std::string("cscd query ") + one.query), one.line);
  }
}

// Mutation: the seconds count from the start of the clip.
TEST_F(ExportFiles, VtkReadsSurfaceContactsAndCurves) {
  put_late_figure();
  const json query = answer("late.glb --clip hug");
  ASSERT_EQ(run("cscd export late.glb --clip hug p.pvd").status, 0);
  const std::string out = python("vtkmodules.vtkIOXML", R"(
import json
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
import xml.etree.ElementTree as tree
rows = []
for item in tree.parse("p.pvd").getroot().iter("DataSet"):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(item.get("file"))
    reader.Update()
    data = reader.GetOutput()
    arrays = data.GetPointData() if item.get("part") == "1" else data.GetCellData()
    names = [arrays.GetArrayName(i) for i in range(arrays.GetNumberOfArrays())]
    total = {n: sum(arrays.GetArray(n).GetValue(i) for i in range(arrays.GetArray(n).GetNumberOfTuples())) for n in names if n != "normal"}
    if item.get("part") == "0":
        total["deepest"] = data.GetPointData().GetArray("depth").GetRange()[1]
    if item.get("part") == "2" and data.GetNumberOfLines() != data.GetNumberOfCells():
        raise ValueError("curves are no lines")
    rows.append([item.get("part"), float(item.get("timestep")), data.GetNumberOfPoints(), data.GetNumberOfCells(), total])
print(json.dumps(rows)))");
  if (out == "skip") GTEST_SKIP() << "Debian's python3-vtk9 is not installed";
  const json rows = json::parse(out);
  const json& intervals = query["intervals"];
  ASSERT_EQ(rows.size(), 3 * (intervals.size() + 1));
  double touched = 0;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    EXPECT_EQ(rows[3 * i + 1][2], intervals[i]["contacts"].size()) << i;
    EXPECT_EQ(rows[3 * i][3], query["import"]["chosen_triangles"]);
    EXPECT_NEAR(rows[3 * i][1].get<double>(), intervals[i]["seconds"].get<double>() + kLate, 1e-6);
    touched += rows[3 * i][4]["touches"].get<double>();
    for (const char* array : {"cluster", "positive", "second_cover", "third_cover", "patch"})
      EXPECT_TRUE(rows[3 * i][4].contains(array)) << array;
  }
  EXPECT_GT(touched, 0);
  ASSERT_FALSE(query["summary"]["events"].empty());
  for (const json& event : query["summary"]["events"]) {
    const std::size_t at = event["deepest"]["interval"];
    EXPECT_GE(rows[3 * at + 2][3], event["curves"]) << "curves of the deepest start";
    EXPECT_GT(rows[3 * at + 2][2], rows[3 * at + 2][3]);
    EXPECT_GE(rows[3 * at][4]["deepest"].get<double>(), event["depth"]["at_least"].get<double>() - 1e-6);
  }
}

TEST_F(ExportFiles, MeshioReadsObjAndPly) {
  ASSERT_EQ(run("cscd export small s.obj && cscd export small s.ply").status, 0);
  const std::string out = python("meshio", R"(
import meshio, numpy
obj, ply = meshio.read("s.0003.obj"), meshio.read("s.0003.ply")
assert numpy.array_equal(obj.points, ply.points), "positions differ"
print(len(obj.points), len(ply.cells_dict["triangle"]), len(obj.cells_dict["triangle"])))");
  if (out == "skip") GTEST_SKIP() << "Debian's python3-meshio is not installed";
  EXPECT_EQ(out, "82 160 160\n");
}

TEST_F(ExportFiles, PlyHoldsDepthsAndObjHoldsCurves) {
  const json query = answer("figure.glb --clip hug");
  ASSERT_EQ(run("cscd export figure.glb --clip hug e.ply --events").status, 0);
  ASSERT_EQ(run("cscd export figure.glb --clip hug plain.ply").status, 0);
  EXPECT_EQ(verdicts(answer("e.0000.ply")), verdicts(answer("plain.0000.ply"))) << "other positions";
  const std::string out = python("struct", R"(
import glob, json, struct
rows = []
for ply, obj in zip(sorted(glob.glob("e.????.ply")), sorted(glob.glob("e.curves.????.obj"))):
    data = open(ply, "rb").read()
    head, body = data.split(b"end_header\n", 1)
    assert b"property float quality\nproperty uchar red" in head, head
    count = int(head.split(b"element vertex ")[1].split()[0])
    vertices = [struct.unpack_from("<3df3B", body, 31 * i) for i in range(count)]
    for v in vertices:
        assert (v[3] > 0) == (v[4:] != (255, 255, 255)), v
    points, lines, events = [], [], set()
    for line in open(obj):
        kind, *words = line.split()
        if kind == "v": points.append(tuple(map(float, words)))
        if kind == "o": events.add(words[0])
        if kind == "l": lines.append([int(w) for w in words])
    used = sorted(i for line in lines for i in set(line))
    assert used == list(range(1, len(points) + 1)), "a point of no line, or of two"
    rows.append([max(v[3] for v in vertices), len(lines), len(events)])
print(json.dumps(rows)))");
  ASSERT_NE(out, "skip");
  const json rows = json::parse(out);
  ASSERT_EQ(rows.size(), query["intervals"].size() + 1);
  ASSERT_FALSE(query["summary"]["events"].empty());
  for (const json& event : query["summary"]["events"]) {
    const json& row = rows[event["deepest"]["interval"].get<std::size_t>()];
    EXPECT_GE(row[0].get<double>(), event["depth"]["at_least"].get<double>() - 1e-6);
    EXPECT_GE(row[1], event["curves"]);
    EXPECT_GE(row[2], 1);
  }
  expect_refused(run("cscd export figure.glb x.obj --events"), "--events: is for .ply files");
}

TEST_F(ExportFiles, BlenderReadsDepthsAndCurves) {
  if (run("command -v blender").status != 0) GTEST_SKIP() << "Debian's blender is not installed";
  const json query = answer("figure.glb --clip hug");
  ASSERT_FALSE(query["summary"]["events"].empty());
  ASSERT_EQ(run("cscd export figure.glb --clip hug e.ply --events").status, 0);
  const std::size_t deepest = query["summary"]["events"][0]["deepest"]["interval"];
  put("read.py", R"(
import bpy, json, sys
frame = int(sys.argv[-1])
bpy.ops.import_mesh.ply(filepath="e.%04d.ply" % frame)
mesh = bpy.context.object.data
bpy.ops.wm.obj_import(filepath="e.curves.%04d.obj" % frame)
edges = sum(len(o.data.edges) for o in bpy.data.objects if o.name.startswith("event_"))
print(json.dumps({"colours": len(mesh.color_attributes), "edges": edges}))
)");
  const Ran ran =
      run("blender --background --python read.py -- " + std::to_string(deepest) + " 2>&1 | grep '^{'");
  ASSERT_EQ(ran.status, 0) << ran.out;
  const json made = json::parse(ran.out);
  EXPECT_EQ(made["colours"], 1);
  EXPECT_GT(made["edges"], 0);
}

// Mutation: the add-on counts the frames of an answer from 1.
TEST_F(ExportFiles, BlenderHasTheEventsOfQuery) {
  if (run("command -v blender").status != 0) GTEST_SKIP() << "Debian's blender is not installed";
  const std::string environment =
      "export PYTHONPATH=\"${PATH%%:*}/python\" PYTHONDONTWRITEBYTECODE=1 BLENDER_USER_CONFIG=\"$PWD\" "
      "BLENDER_USER_SCRIPTS=\"$PWD\"; ";
  if (run(environment + "/usr/bin/python3 -c 'import cscd'").status != 0)
    GTEST_SKIP() << "the Python module is not built";
  // The urchin with spikes that sway so wide that they go through each other.
  put("wild.json", R"({"schema": "cscd.scene/1", "base": "urchin", "story": "For a test.", "frames": 61,
      "patch": [{"op": "add", "path": "/effects/1/weight", "value": 1.5},
                {"op": "add", "path": "/effects/2/weight", "value": 1.5}]})");
  ASSERT_EQ(run("CSCD_SCENES='" + scenes::scenes_folder().string() +
                "' && cscd scene accept wild.json && cscd export wild.json character.glb && "
                "cscd export character.glb walk.pc2")
                .status,
            0);
  put("character.json", answer("character.glb").dump());
  put("walk.json", answer("walk.pc2").dump());
  const std::string scripts = (scenes::scenes_folder().parent_path() / "scripts/blender").string();
  const Ran ran = run(
      environment + "here=$PWD; (cd '" + scripts +
      "' && /usr/bin/python3 -m zipfile -c \"$here/add-on.zip\" cscd_self_collision) && blender --background "
      "--factory-startup --python-exit-code 1 --python '" +
      scripts + "/tests/in_blender.py' -- add-on.zip character.glb character.json walk.json 2>&1");
  EXPECT_EQ(ran.status, 0) << ran.out;
  EXPECT_NE(ran.out.find("The add-on and cscd query agree."), std::string::npos) << ran.out;
}

TEST_F(ExportFiles, UsdHoldsEveryFrame) {
  ASSERT_EQ(run("cscd export figure.glb --clip hug f.usda").status, 0);
  const std::string usd = text("f.usda");
  const json query = answer("figure.glb --clip hug");
  EXPECT_EQ(usd.substr(0, 10), "#usda 1.0\n");
  EXPECT_NE(usd.find("endTimeCode = " + std::to_string(query["intervals"].size())), std::string::npos);
  EXPECT_EQ(std::count(usd.begin(), usd.end(), '{'), std::count(usd.begin(), usd.end(), '}'));
  EXPECT_EQ(std::count(usd.begin(), usd.end(), '['), std::count(usd.begin(), usd.end(), ']'));
  EXPECT_NE(usd.find("(0.899999976, 0.620000005, 0)"), std::string::npos) << "no triangle touches";
  const auto samples = [&](const std::string& name) {
    const std::size_t from = usd.find(name + ".timeSamples");
    return usd.substr(from, usd.find('}', from) - from);
  };
  EXPECT_NE(samples("primvars:depth").find(", 0."), std::string::npos) << "nothing is deep";
  const std::string counts = samples("curveVertexCounts");
  const auto begins_a_list = [](char a, char b) { return a == '[' && std::isdigit(b) != 0; };
  EXPECT_NE(std::adjacent_find(counts.begin(), counts.end(), begins_a_list), counts.end())
      << "nothing crosses";
}

// Mutation: the writers are not told which axis of the input points up.
TEST_F(ExportFiles, UsdAndBakedGlbKeepTheUpAxis) {
  ASSERT_EQ(run("cscd export small y.h5").status, 0);
  {
    scenes::PointCacheReader source(folder / "y.h5");
    scenes::ClipHeader header = source.header();
    header.up = "z";
    scenes::PointCacheWriter writer(folder / "z.h5", std::move(header), false);
    scenes::copy_frames(source, writer);
    writer.finish();
  }
  ASSERT_EQ(run("cscd export z.h5 z.usda && cscd export z.h5 z.glb --bake").status, 0);
  EXPECT_NE(text("z.usda").find("metersPerUnit = 1\n    upAxis = \"Z\""), std::string::npos);
  EXPECT_NE(text("z.glb").find("\"rotation\":[-0.707"), std::string::npos);
}

}  // namespace
}  // namespace cscd::bench
