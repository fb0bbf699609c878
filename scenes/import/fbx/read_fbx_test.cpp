#include "scenes/import/fbx/read_fbx.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <zlib.h>

#include "scenes/import/fbx/test_fbx.h"

namespace cscd::scenes {
namespace {

// Two bones and the mesh share one name. Vertex 0 follows one bone, vertex 1 both bones, and vertex 2 none.
struct Skinned {
  FbxText file;
  const Transform link[2] = {moved({0, 0, 2}), product({moved({1, 1, 0}), turned(0, 40)})};
  const Transform mesh = product({moved({0, 3, 0}), turned(1, 25)});
  const Transform geometry = product({moved({0, 0, 1}), turned(2, 90), scaled_by({1, 2, 1})});

  explicit Skinned(double scale_of_weights = 1, const std::string& mode = {}) {
    file.model(20, "same", 0,
               property("Lcl Translation", {0, 3, 0}) + property("Lcl Rotation", {0, 25, 0}) +
                   property("GeometricTranslation", {0, 0, 1}) + property("GeometricRotation", {0, 0, 90}) +
                   property("GeometricScaling", {1, 2, 1}),
               "Mesh");
    file.model(30, "same", 0, property("Lcl Translation", {0, 0, 2}));
    file.model(31, "same", 30, property("Lcl Translation", {5, 0, 0}));
    file.triangle(10, 20);
    file.skin(40, 10);
    const double w = scale_of_weights;
    const auto bound = [&](int k) { return composed(inverse(link[k]), mesh); };
    file.cluster(41, 40, 30, {0, 1}, {w, w / 4}, matrix(bound(0)), matrix(link[0]), mode);
    file.cluster(42, 40, 31, {1}, {3 * w / 4}, matrix(bound(1)), matrix(link[1]), mode);
  }
  Vec3 posed(int k, const Vec3& x) const {
    const Transform now = k == 0 ? moved({0, 0, 2}) : moved({5, 0, 2});
    return product({now, inverse(link[k]), mesh, geometry})(x);
  }
};

TEST(FbxSkin, FollowsTheSdksRecipeByIdentity) {
  const Skinned skinned(3);  // weights are made to sum to 1
  const std::vector<Vec3> was = vertices_at(read(skinned.file), 0);
  ASSERT_EQ(was.size(), 3u);
  expect_at(was[0], skinned.posed(0, kPoints[0]));
  expect_at(was[1], 0.25 * skinned.posed(0, kPoints[1]) + 0.75 * skinned.posed(1, kPoints[1]));
  expect_at(was[2], product({skinned.mesh, skinned.geometry})(kPoints[2]));
}

TEST(FbxSkin, InTheModeTotalOneTheMeshsNodeTakesWhatMissesOfOne) {
  const Skinned skinned(0.5, "Mode: \"Total1\"\n");
  const Vec3 own = product({skinned.mesh, skinned.geometry})(kPoints[0]);
  expect_at(vertices_at(read(skinned.file), 0)[0], 0.5 * skinned.posed(0, kPoints[0]) + 0.5 * own);
  EXPECT_TRUE(says(refusal_of(Skinned(2, "Mode: \"Total1\"\n").file), "sum to more than 1"));
  EXPECT_TRUE(says(refusal_of(Skinned(1, "Mode: \"Additive\"\n").file), "link mode is additive"));
}

TEST(FbxSkin, RefusesSeveralSkinsAndVerticesThatAreNone) {
  Skinned twice;
  twice.file.skin(45, 10);
  twice.file.cluster(46, 45, 30, {0}, {1}, matrix({}), matrix({}));
  EXPECT_TRUE(says(refusal_of(twice.file), "several skins"));
  Skinned outside;
  outside.file.cluster(47, 40, 30, {7}, {1}, matrix({}), matrix({}));
  EXPECT_TRUE(says(refusal_of(outside.file), "weighs vertex 7 of 3"));
}

// The skin of a mesh at the origin whose vertex 1 follows two bones that are turned by 0 and 90 degrees about
// z. `body` is put into the skin.
FbxText twisted(const std::string& body) {
  FbxText file;
  file.model(20, "mesh", 0, "", "Mesh");
  file.model(30, "still", 0, "");
  file.model(31, "turned", 0, property("Lcl Rotation", {0, 0, 90}));
  file.triangle(10, 20);
  file.skin(40, 10);
  file.objects.insert(file.objects.find("\"Skin\" {") + 8, "\n" + body);
  file.cluster(41, 40, 30, {0, 1, 2}, {0.5, 0.5, 0.5}, matrix({}), matrix({}));
  file.cluster(42, 40, 31, {0, 1, 2}, {0.5, 0.5, 0.5}, matrix({}), matrix({}));
  return file;
}

TEST(FbxSkin, DualQuaternionsMoveAllOrSomeVertices) {
  const double half = std::sqrt(0.5);
  // Vertex 1 is (0, 1, 0): linear skinning takes the mean of (0, 1, 0) and (-1, 0, 0).
  const Vec3 linear(-0.5, 0.5, 0), dual(-half, half, 0);
  const auto second = [](const std::string& body) { return vertices_at(read(twisted(body)), 0)[1]; };
  const auto blend = [](const std::vector<double>& vertices, const std::vector<double>& shares) {
    return "SkinningType: \"Blend\"\n" + array("Indexes", vertices) + array("BlendWeights", shares);
  };
  expect_at(second(""), linear);
  expect_at(second("SkinningType: \"Linear\"\n"), linear);
  expect_at(second("SkinningType: \"DualQuaternion\"\n"), dual);
  expect_at(second(blend({0, 1}, {0, 0.25})), 0.75 * linear + 0.25 * dual);
  expect_at(second(blend({1}, {7})), dual);
  expect_at(second(blend({1}, {-7})), linear);
  expect_at(second(blend({0, 2}, {1, 1})), linear);
  EXPECT_TRUE(says(refusal_of(twisted(blend({1, 2}, {0.5}))), "2 vertices and 1 blend weights"));
  EXPECT_TRUE(says(refusal_of(twisted(blend({3}, {0.5}))), "blends vertex 3 of 3"));
  EXPECT_TRUE(says(refusal_of(twisted(blend({1}, {std::nan("")}))), "vertex 1: its blend weight"));
}

TEST(FbxMesh, InstancesStandWhereTheirNodesDo) {
  FbxText file;
  file.model(20, "one", 0, property("Lcl Translation", {1, 0, 0}), "Mesh");
  file.model(21, "two", 0, property("Lcl Translation", {0, 2, 0}), "Mesh");
  file.mesh(9, {21}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, -3});
  file.mesh(10, {20, 21}, {1, 0, 0, 0, 1, 0, 0.5, 0.25, 1}, {0, 1, -3});
  const Character character = read(file);
  ASSERT_EQ(character.parts.size(), 3u);
  EXPECT_EQ(character.parts[0].mesh, 1);
  EXPECT_EQ(character.parts[1].mesh, 0);
  EXPECT_EQ(character.parts[2].mesh, 1);
  const std::vector<Vec3> was = vertices_at(character, 0);
  expect_at(was[0], kPoints[0] + Vec3(1, 0, 0));
  expect_at(was[6], kPoints[0] + Vec3(0, 2, 0));
}

// Returns two sums over the triangles: of their areas, signed by the direction of z, and of
// the sizes of their areas.
std::pair<double, double> areas(const std::vector<double>& points, const std::vector<double>& polygons) {
  FbxText file;
  file.model(20, "node", 0, "", "Mesh");
  file.mesh(10, {20}, points, polygons);
  const Character character = read(file);
  const Part& part = character.parts[0];
  double sum = 0, size = 0;
  for (const auto& t : part.triangles) {
    const auto at = [&](std::size_t k) { return part.positions[static_cast<std::size_t>(t[k])]; };
    const double area = (at(1) - at(0)).cross(at(2) - at(0)).z() / 2;
    sum += area;
    size += std::abs(area);
  }
  return {sum, size};
}

TEST(FbxText, LinesMayEndInAnyWayBehindAByteOrderMark) {
  const std::string text = triangle_file(property("Lcl Translation", {9, 8, 7})).text();
  std::string returns = text, both;
  std::replace(returns.begin(), returns.end(), '\n', '\r');
  for (const char c : text) both += c == '\n' ? std::string("\r\n") : std::string(1, c);
  for (const std::string& file : {text, returns, both, "\xEF\xBB\xBF" + text})
    expect_at(vertices_at(read_fbx(file, {}), 0)[0], kPoints[0] + Vec3(9, 8, 7));
  EXPECT_TRUE(
      says(test::refusal([] { read_fbx(std::string_view("\xFF\xFE;\0", 4), {}); }), "is text in UTF-16"));
  const std::string cut = returns.substr(0, returns.find("PolygonVertexIndex"));
  const auto lines = std::count(cut.begin(), cut.end(), '\r') + 1;
  EXPECT_TRUE(says(test::refusal([&] { read_fbx(cut, {}); }), "line " + std::to_string(lines) + ": a brace"));
}

TEST(FbxText, PropertiesAreNumbersOrRefused) {
  const auto moved = [](const std::string& numbers) {
    std::string text = triangle_file(property("Lcl Translation", {9, 8, 7})).text();
    return test::refusal([&] { read_fbx(text.replace(text.find("9,8,7"), 5, numbers), {}); });
  };
  EXPECT_EQ(moved("+9,8.,7e0"), "");
  EXPECT_TRUE(says(moved("9,8,x7"), "property Lcl Translation: 'x7' is no number"));
  EXPECT_TRUE(says(moved("9.5f,8,7"), "property Lcl Translation: '9.5f' is no number"));
  EXPECT_TRUE(says(moved("9,5,8,7"), "Lcl Translation has more than three numbers"));
  EXPECT_TRUE(says(moved("9,1.#IND,7"), "not finite"));
}

TEST(FbxMesh, PolygonsAreCutInsideAndFaceTheirWay) {
  // The polygons are a dart whose first diagonal lies outside, the dart with the second diagonal outside,
  // an L, and a comb of nine corners.
  EXPECT_EQ(areas({0, 0, 0, 4, 0, 0, 1, 1, 0, 0, 4, 0}, {0, 1, 2, -4}), std::make_pair(4.0, 4.0));
  EXPECT_EQ(areas({0, 4, 0, 0, 0, 0, 4, 0, 0, 1, 1, 0}, {0, 1, 2, -4}), std::make_pair(4.0, 4.0));
  EXPECT_EQ(areas({0, 0, 0, 2, 0, 0, 2, 1, 0, 1, 1, 0, 1, 2, 0, 0, 2, 0}, {0, 1, 2, 3, 4, -6}),
            std::make_pair(3.0, 3.0));
  const auto comb = areas({0, 0, 0, 6, 0, 0, 6, 3, 0, 5, 3, 0, 4, 1, 0, 3, 3, 0, 2, 1, 0, 1, 3, 0, 0, 3, 0},
                          {0, 1, 2, 3, 4, 5, 6, 7, -9});
  EXPECT_NEAR(comb.first, comb.second, 1e-12);
  EXPECT_NEAR(comb.first, 14, 1e-12);
}

TEST(FbxMesh, ConvexQuadrilateralsTakeTheShorterDiagonal) {
  FbxText file;
  file.model(20, "node", 0, "", "Mesh");
  file.mesh(10, {20}, {0, 0, 0, 3, 1, 0, 4, 4, 0, 1, 3, 0}, {0, 1, 2, -4});
  const Character character = read(file);
  ASSERT_EQ(character.parts[0].triangles.size(), 2u);
  for (const auto& t : character.parts[0].triangles) {
    EXPECT_TRUE(std::count(t.begin(), t.end(), 1) == 1 && std::count(t.begin(), t.end(), 3) == 1);
  }
}

TEST(FbxMesh, PolygonsThatRunTwiceThroughAPlaceKeepTheirArea) {
  // The first polygon is a square with a square hole, joined by an edge that the polygon runs along both
  // ways. The second has equal corners.
  const std::vector<double> points = {0, 0, 0, 4, 0, 0, 4, 4, 0, 0, 4, 0, 1, 1, 0, 1, 3, 0, 3, 3, 0, 3, 1, 0};
  const auto frame = areas(points, {0, 1, 2, 3, 0, 4, 5, 6, 7, -5});
  EXPECT_NEAR(frame.first, 12, 1e-9);
  EXPECT_NEAR(frame.second, 12, 1e-9);
  EXPECT_EQ(areas({0, 0, 0, 0, 0, 0, 4, 0, 0, 4, 4, 0, 0, 4, 0, 0, 0, 0}, {0, 1, 2, 3, 4, -6}),
            std::make_pair(16.0, 16.0));
}

// A channel with this percentage, and a shape for each of `moves`, which moves vertex 1 so far.
FbxText shaped(const std::string& full_weights, double percent = 50,
               const std::vector<std::vector<double>>& moves = {{0, 0, 8}}) {
  FbxText file = triangle_file();
  file.add("Deformer", 40, "shapes", "BlendShape", "");
  file.connect(40, 10);
  file.add("Deformer", 41, "smile", "BlendShapeChannel", property("DeformPercent", {percent}), full_weights);
  file.connect(41, 40);
  int id = 42;
  for (const std::vector<double>& by : moves) {
    file.add("Geometry", id, "shape", "Shape", "", array("Indexes", {1}) + array("Vertices", by));
    file.connect(id++, 41);
  }
  return file;
}

TEST(FbxShapes, PercentagesBlendAtRestAndInClips) {
  expect_at(vertices_at(read(shaped(array("FullWeights", {100}))), 0)[1], kPoints[1] + Vec3(0, 0, 4));
  expect_at(vertices_at(read(shaped(array("FullWeights", {50}))), 0)[1], kPoints[1] + Vec3(0, 0, 8));
  FbxText file = shaped("");
  file.clip(0, 1);
  file.curve_node(60, 51, 41, "DeformPercent", property("d|DeformPercent", {0}));
  file.curve(61, 60, "d|DeformPercent", {0, 1}, {0, 100}, {4, 4});
  const Character character = read(file);
  expect_at(vertices_at(character, 0.25)[1], kPoints[1] + Vec3(0, 0, 2));
  expect_at(vertices_at(character, 0.25)[0], kPoints[0]);
}

// Three shapes that move vertex 1 to x = 1, y = 1 and z = 1; `full_weights` are theirs.
FbxText in_between(const std::vector<double>& full_weights, double percent) {
  return shaped(array("FullWeights", full_weights), percent, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
}

TEST(FbxShapes, ShapesInBetweenAreBlendedFromOneFullWeightToTheNext) {
  // In the order of full weights, z is shown at 25, x at 50 and y at 100 per cent.
  const auto moved_by = [](double percent) -> Vec3 {
    return vertices_at(read(in_between({50, 100, 25}, percent)), 0)[1] - kPoints[1];
  };
  expect_at(moved_by(0), {0, 0, 0});
  expect_at(moved_by(12.5), {0, 0, 0.5});
  expect_at(moved_by(25), {0, 0, 1});
  expect_at(moved_by(30), {0.2, 0, 0.8});
  expect_at(moved_by(75), {0.5, 0.5, 0});
  expect_at(moved_by(125), {-0.5, 1.5, 0});  // the last line goes on
  expect_at(moved_by(-25), {0, 0, -1});      // and so does the first one
  // Full weights below 0 lie on the other side of the mesh without shapes.
  const auto both_ways = [](double percent) -> Vec3 {
    return vertices_at(read(in_between({-100, 100, -50}, percent)), 0)[1] - kPoints[1];
  };
  expect_at(both_ways(-25), {0, 0, 0.5});
  expect_at(both_ways(-75), {0.5, 0, 0.5});
  expect_at(both_ways(200), {0, 2, 0});
}

TEST(FbxShapes, AClipDrivesAllShapesOfAChannel) {
  FbxText file = in_between({50, 100, 25}, 0);
  file.clip(0, 1);
  file.curve_node(60, 51, 41, "DeformPercent", property("d|DeformPercent", {0}));
  file.curve(61, 60, "d|DeformPercent", {0, 1}, {0, 100}, {4, 4});
  file.layer(52, property("Weight", {50}));
  file.curve_node(70, 52, 41, "DeformPercent", property("d|DeformPercent", {40}));
  const Character character = read(file);
  expect_at(vertices_at(character, 0.1)[1], kPoints[1] + Vec3(0.2, 0, 0.8));
  CharacterLimits few;
  few.keys = 5;
  EXPECT_TRUE(says(refusal_of(file, few), "more than 5 animation keys of blend shapes"));
}

TEST(FbxShapes, FullWeightsHaveToDiffer) {
  EXPECT_TRUE(says(refusal_of(in_between({50, 100, 50}, 0)), "'smile': two shapes have one full weight"));
  EXPECT_EQ(refusal_of(in_between({50, 80}, 0)), "") << "a full weight that is not written is 100";
  EXPECT_TRUE(says(refusal_of(in_between({50}, 0)), "two shapes have one full weight"));
  EXPECT_TRUE(says(refusal_of(in_between({50, 100, 0}, 0)), "a shape has the full weight 0"));
  EXPECT_TRUE(says(refusal_of(in_between({50, 100, std::nan("")}, 0)), "a full weight is not finite"));
}

// Blender writes in the place of full weights how strongly a vertex group lets the shape act on each vertex.
TEST(FbxShapes, BlendersVertexGroupsWeakenDisplacements) {
  const auto text = [](const FbxText& file) {
    return "Creator: \"Blender (stable FBX IO)\"\n" + file.text();
  };
  const Character character = read_fbx(text(shaped(array("FullWeights", {50}))), {});
  expect_at(vertices_at(character, 0)[1], kPoints[1] + Vec3(0, 0, 2));
  EXPECT_TRUE(says(refusal_of(text(shaped(array("FullWeights", {50, 60})))), "2 weights of a vertex group"));
}

TEST(Fbx, RefusesWhatIsDamagedOrCannotBe) {
  const FbxText good = triangle_file();
  EXPECT_EQ(refusal_of(good), "");
  FbxText old = good;
  old.version = "6100";
  // Old files have elements without a colon, which are no damage.
  for (const std::string& text : {old.text(), old.text() + "Takes {\n}\n"})
    EXPECT_TRUE(says(refusal_of(text), "is FBX 6.1 text, which is too old"));
  for (const char* other : {"", "glTF\2\n}", "{\"asset\": {}}", "xof 0303txt"})
    EXPECT_TRUE(says(refusal_of(other), "is no FBX file, whatever its name says")) << other;
  EXPECT_TRUE(
      says(refusal_of(good.text().substr(0, good.text().find("PolygonVertexIndex"))), "brace is not closed"));
  std::string deep = good.text();
  for (int i = 0; i < 100000; ++i) deep += "a: {";
  EXPECT_TRUE(says(refusal_of(deep), "nested too deeply"));

  const auto with_mesh = [](const std::vector<double>& points, const std::vector<double>& polygons) {
    FbxText file;
    file.model(20, "node", 0, "", "Mesh");
    file.mesh(10, {20}, points, polygons);
    return refusal_of(file);
  };
  EXPECT_TRUE(says(with_mesh({0, 0, 0, 1, 0}, {0, 1, -3}), "not three a vertex"));
  EXPECT_TRUE(says(with_mesh({0, 0, 0}, {0, 1, -3}), "names vertex 1 of 1"));
  EXPECT_TRUE(says(with_mesh({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}), "cut short"));
  EXPECT_TRUE(says(with_mesh({0, 0, 0, 1, 0, 0, 0, 1, std::nan("")}, {0, 1, -3}),
                   "vertex 2: position is not finite"));

  FbxText twin = good;
  twin.add("Model", 20, "twin", "Null", "");
  EXPECT_TRUE(says(refusal_of(twin), "has the same number"));
  FbxText circle = good;
  circle.model(21, "a", 22, "");
  circle.model(22, "b", 21, "");
  EXPECT_TRUE(says(refusal_of(circle), "in a circle"));
  FbxText parents = good;
  parents.model(21, "a", 0, "");
  parents.connect(21, 20);
  EXPECT_TRUE(says(refusal_of(parents), "'a': hangs on two nodes"));
}

// A binary file of one mesh whose vertices are deflated.
class BinaryFile {
 public:
  std::string bytes = std::string("Kaydara FBX Binary  \0\x1a\0", 23);
  bool wide;

  explicit BinaryFile(std::uint32_t version) : wide(version >= 7500) { put(version); }

  template <class Number>
  void put(Number number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  void size(std::size_t number) {
    if (wide)
      put(static_cast<std::uint64_t>(number));
    else
      put(static_cast<std::uint32_t>(number));
  }
  template <class Children>
  void element(const std::string& name, std::size_t values, const std::string& value_bytes,
               const Children& children) {
    const std::size_t start = bytes.size();
    size(0);
    size(values);
    size(value_bytes.size());
    bytes += static_cast<char>(name.size());
    bytes += name + value_bytes;
    const std::size_t before = bytes.size();
    children();
    if (bytes.size() > before) bytes.append(wide ? 25 : 13, '\0');
    const std::uint64_t end = bytes.size();
    std::memcpy(bytes.data() + start, &end, wide ? 8 : 4);
  }
  void leaf(const std::string& name, std::size_t values, const std::string& value_bytes) {
    element(name, values, value_bytes, [] {});
  }
};

template <class Number>
std::string raw(Number number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}
std::string number(std::int64_t id) {
  return "L" + raw(id);
}
std::string text(const std::string& words) {
  return "S" + raw(static_cast<std::uint32_t>(words.size())) + words;
}

std::string deflated(const std::vector<double>& numbers, std::uint32_t claimed) {
  const auto bytes = static_cast<uLong>(numbers.size() * sizeof(double));
  std::string packed(compressBound(bytes), '\0');
  auto length = static_cast<uLongf>(packed.size());
  compress(reinterpret_cast<Bytef*>(packed.data()), &length, reinterpret_cast<const Bytef*>(numbers.data()),
           bytes);
  return "d" + raw(claimed) + raw(std::uint32_t{1}) + raw(static_cast<std::uint32_t>(length)) +
         packed.substr(0, length);
}

std::string binary_file(std::uint32_t version, std::uint32_t claimed) {
  BinaryFile file(version);
  const std::string separator("\0\x01", 2);
  file.element("Objects", 0, "", [&] {
    file.element("Geometry", 3, number(10) + text("mesh" + separator + "Geometry") + text("Mesh"), [&] {
      file.leaf("Vertices", 1, deflated({1, 0, 0, 0, 1, 0, 0.5, 0.25, 1}, claimed));
      file.leaf("PolygonVertexIndex", 1,
                "i" + raw(std::uint32_t{3}) + raw(std::uint32_t{0}) + raw(std::uint32_t{12}) + raw(0) +
                    raw(1) + raw(-3));
    });
    file.leaf("Model", 3, number(20) + text("body" + separator + "Model") + text("Mesh"));
  });
  file.element("Connections", 0, "", [&] {
    file.leaf("C", 3, text("OO") + number(20) + number(0));
    file.leaf("C", 3, text("OO") + number(10) + number(20));
  });
  file.bytes.append(file.wide ? 25 : 13, '\0');
  return file.bytes;
}

TEST(Fbx, ReadsBinaryFilesWithDeflatedArrays) {
  for (const std::uint32_t version : {7400u, 7500u}) {
    const std::string bytes = binary_file(version, 9);
    const Character character = read_fbx(bytes, {});
    ASSERT_EQ(character.parts.size(), 1u);
    EXPECT_EQ(character.parts[0].name, "mesh");
    EXPECT_EQ(character.parts[0].triangles.size(), 1u);
    const std::vector<Vec3> was = vertices_at(character, 0);
    ASSERT_EQ(was.size(), 3u);
    for (std::size_t v = 0; v < 3; ++v) EXPECT_EQ(was[v], kPoints[v]);
    // A file that is cut anywhere before the end of the list is refused.
    for (std::size_t length = 0; length + (version >= 7500 ? 25 : 13) < bytes.size(); ++length)
      EXPECT_NE(refusal_of(bytes.substr(0, length)), "") << length;
  }
  for (const std::uint32_t claimed : {8u, 10u, 3'000'000u, 4'000'000'000u})
    EXPECT_NE(refusal_of(binary_file(7400, claimed)), "") << claimed;
}

}  // namespace
}  // namespace cscd::scenes
