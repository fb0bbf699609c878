#include "core/mesh/triangle_mesh.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "core/base/test_refusal.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

using test::corners;
using test::Shape;

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::size_t count_of(const TriangleMesh& mesh, Defect kind) {
  for (const TriangleMesh::DefectReport& defect : mesh.defects())
    if (defect.kind == kind) return defect.count;
  return 0;
}

std::string first_of(const TriangleMesh& mesh, Defect kind) {
  for (const TriangleMesh::DefectReport& defect : mesh.defects())
    if (defect.kind == kind) return defect.first;
  return "";
}

// Compares every table of the mesh with maps that are made in a slow way.
void expect_tables_match(const TriangleMesh& mesh) {
  std::map<Edge, std::vector<TriangleId>> at_edge;
  std::map<VertexId, std::vector<TriangleId>> at_vertex;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const TriangleId t{static_cast<std::int32_t>(i)};
    const Triangle& c = mesh.corners(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(c[k], c[(k + 1) % 3]);
      at_edge[{a, b}].push_back(t);
      at_vertex[c[k]].push_back(t);
      EXPECT_EQ(mesh.ends(mesh.edges_of(t)[k]), (Edge{a, b}));
    }
  }
  ASSERT_EQ(mesh.edge_count(), at_edge.size());
  std::size_t i = 0;
  for (const auto& [edge, triangles] : at_edge) {  // a map has the order that the mesh promises
    const EdgeId e{static_cast<std::int32_t>(i++)};
    EXPECT_EQ(mesh.ends(e), edge);
    EXPECT_TRUE(std::ranges::equal(mesh.triangles_at(e), triangles));
  }
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const VertexId vertex{static_cast<std::int32_t>(v)};
    EXPECT_TRUE(std::ranges::equal(mesh.triangles_at(vertex), at_vertex[vertex]));
  }
}

TEST(TriangleMesh, ClosedShapesHaveNoDefectAndTheirEulerNumber) {
  const std::pair<Shape, int> shapes[] = {{test::octahedron(), 2},
                                          {test::icosphere(2), 2},
                                          {test::capped_tube(7, 5, 0.5, 3), 2},
                                          {test::torus(), 0},
                                          {test::box(), 2},
                                          {test::together(test::octahedron(), test::torus()), 2}};
  for (const auto& [shape, euler] : shapes) {
    const TriangleMesh mesh = shape.mesh();
    EXPECT_TRUE(mesh.closed_and_oriented());
    EXPECT_NO_THROW(require_closed_and_oriented(mesh, "test"));
    EXPECT_EQ(
        static_cast<int>(mesh.vertex_count() + mesh.triangle_count()) - static_cast<int>(mesh.edge_count()),
        euler);
    EXPECT_GT(test::six_volumes(shape), 0);
    expect_tables_match(mesh);
  }
}

TEST(TriangleMesh, TablesMatchOnRandomTriangleSoup) {
  std::mt19937 random(7);
  for (int round = 0; round < 30; ++round) {
    const int vertices = 4 + static_cast<int>(random() % 12);
    std::vector<Triangle> triangles;
    while (triangles.size() < 25) {
      const int a = static_cast<int>(random() % vertices), b = static_cast<int>(random() % vertices),
                c = static_cast<int>(random() % vertices);
      if (a != b && b != c && c != a) triangles.push_back(corners(a, b, c));
    }
    const TriangleMesh mesh(triangles, static_cast<std::size_t>(vertices));
    expect_tables_match(mesh);

    std::set<std::set<VertexId>> distinct;
    for (const Triangle& c : triangles) distinct.insert({c.begin(), c.end()});
    EXPECT_EQ(count_of(mesh, Defect::duplicate_triangle), triangles.size() - distinct.size());
  }
}

TEST(TriangleMesh, OpenSurfaceNamesTheHole) {
  Shape shape = test::octahedron();
  shape.triangles.pop_back();  // (0, 3, 5)
  const TriangleMesh mesh = shape.mesh();
  ASSERT_EQ(mesh.defects().size(), 1u);
  EXPECT_EQ(count_of(mesh, Defect::boundary_edge), 3u);
  EXPECT_EQ(first_of(mesh, Defect::boundary_edge),
            "edge (0, 3) of triangle 3 has no second triangle; close the hole or weld coinciding vertices");
}

TEST(TriangleMesh, FlippedFaceNamesBothTriangles) {
  Shape shape = test::octahedron();
  std::swap(shape.triangles[2][0], shape.triangles[2][1]);
  const TriangleMesh mesh = shape.mesh();
  ASSERT_EQ(mesh.defects().size(), 1u);
  EXPECT_EQ(count_of(mesh, Defect::inconsistent_orientation), 3u);
  EXPECT_TRUE(mentions(first_of(mesh, Defect::inconsistent_orientation),
                       "triangles 2 and 6 run through edge (1, 3)"));
}

TEST(TriangleMesh, DuplicateFaceIsFoundWhateverTheCornerOrder) {
  for (const Triangle& again : {corners(0, 2, 4), corners(2, 4, 0), corners(4, 2, 0)}) {
    Shape shape = test::octahedron();
    shape.triangles.push_back(again);
    const TriangleMesh mesh = shape.mesh();
    EXPECT_EQ(count_of(mesh, Defect::duplicate_triangle), 1u);
    EXPECT_EQ(count_of(mesh, Defect::non_manifold_edge), 3u);
    EXPECT_EQ(mesh.defects().front().kind, Defect::duplicate_triangle);
    EXPECT_TRUE(mentions(mesh.defects().front().first, "triangles 0 (0, 2, 4) and 8 ("));
  }
}

TEST(TriangleMesh, TwoSidedTriangleIsADuplicate) {
  const TriangleMesh mesh({corners(0, 1, 2), corners(0, 2, 1)}, 3);
  ASSERT_EQ(mesh.defects().size(), 1u);
  EXPECT_EQ(count_of(mesh, Defect::duplicate_triangle), 1u);
}

TEST(TriangleMesh, BowTieVertexIsFound) {
  // Two octahedra touch in a vertex that they share.
  Shape shape = test::together(test::octahedron(), test::moved(test::octahedron(), {2, 0, 0}));
  for (Triangle& c : shape.triangles)
    for (VertexId& v : c)
      if (v == VertexId{7}) v = VertexId{0};
  const TriangleMesh mesh = shape.mesh();  // vertex 7 has no triangles left, which is allowed
  ASSERT_EQ(mesh.defects().size(), 1u);
  EXPECT_EQ(count_of(mesh, Defect::non_manifold_vertex), 1u);
  EXPECT_TRUE(mentions(first_of(mesh, Defect::non_manifold_vertex), "vertex 0 joins triangles 0 and 9 "));
  EXPECT_EQ(mesh.component_count(), 1);
  EXPECT_TRUE(mesh.triangles_at(VertexId{7}).empty());
}

TEST(TriangleMesh, NonManifoldEdgeNamesItsTriangles) {
  const TriangleMesh mesh({corners(0, 1, 2), corners(1, 0, 3), corners(0, 1, 4)}, 5);
  EXPECT_EQ(count_of(mesh, Defect::non_manifold_edge), 1u);
  EXPECT_TRUE(mentions(first_of(mesh, Defect::non_manifold_edge),
                       "edge (0, 1) belongs to 3 triangles (triangles 0, 1 and 2)"));
  EXPECT_EQ(count_of(mesh, Defect::boundary_edge), 6u);
  EXPECT_EQ(count_of(mesh, Defect::non_manifold_vertex), 0u);
}

TEST(TriangleMesh, ComponentsAreNumberedByTheirFirstTriangle) {
  Shape shape = test::together(test::octahedron(), test::moved(test::octahedron(), {0.1, 0, 0}, 0.1));
  std::swap(shape.triangles[1], shape.triangles[8]);
  const TriangleMesh mesh = shape.mesh();
  EXPECT_TRUE(mesh.closed_and_oriented());
  EXPECT_EQ(mesh.component_count(), 2);
  for (int t = 0; t < 16; ++t) EXPECT_EQ(mesh.component(TriangleId{t}), t == 1 || t > 8 ? 1 : 0) << t;
}

TEST(TriangleMesh, RefusesWhatIsNotATriangleList) {
  const auto make = [](std::vector<Triangle> triangles, std::size_t vertices) {
    return test::refusal([&] { TriangleMesh(std::move(triangles), vertices, "hand.obj"); });
  };
  EXPECT_EQ(make({corners(0, 1, 2), corners(0, 1, 3)}, 3),
            "hand.obj: triangle 1 names vertex 3, outside [0, 3); indices count from 0");
  EXPECT_EQ(make({corners(0, -1, 2)}, 3),
            "hand.obj: triangle 0 names vertex -1, outside [0, 3); indices count from 0");
  EXPECT_EQ(make({corners(0, 2, 2)}, 3), "hand.obj: triangle 0 (0, 2, 2) repeats a corner; remove it");
  EXPECT_EQ(make({corners(2, 0, 2)}, 3), "hand.obj: triangle 0 (2, 0, 2) repeats a corner; remove it");
  EXPECT_EQ(make({}, 3), "hand.obj: has no triangles; give at least one");
  EXPECT_TRUE(mentions(make({corners(0, 1, 2)}, (std::size_t{1} << 28) + 1), "at most 2^28"));
}

TEST(TriangleMesh, RequireClosedTellsWhoWhatAndHowToMend) {
  Shape shape = test::octahedron();
  shape.triangles.pop_back();
  std::swap(shape.triangles[1][0], shape.triangles[1][1]);
  const TriangleMesh mesh = shape.mesh();
  const std::string text = test::refusal([&] { require_closed_and_oriented(mesh, "strategy drvbc"); });
  EXPECT_TRUE(
      mentions(text, "strategy drvbc needs a closed, manifold, consistently oriented surface: edge (0, 3)"));
  EXPECT_TRUE(mentions(text, "boundary edges: 3, inconsistently oriented edges: 3"));
  EXPECT_TRUE(mentions(text, "or use a strategy with guarantee complete"));
}

TEST(TriangleMesh, RequireFiniteNamesTheFirstBadVertex) {
  std::vector<Vec3> positions(4, Vec3::Zero());
  EXPECT_NO_THROW(require_finite(positions, "frame 3"));
  positions[2].y() = std::numeric_limits<double>::infinity();
  positions[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(test::refusal([&] { require_finite(positions, "frame 3"); }),
            "frame 3: vertex 2 is at (0, inf, 0); every coordinate must be finite");
}

}  // namespace
}  // namespace cscd
