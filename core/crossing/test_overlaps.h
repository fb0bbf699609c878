#pragma once

#include <cstdlib>
#include <gtest/gtest.h>
#include <set>
#include <vector>

#include "core/crossing/curves.h"
#include "core/elementary/exact/static_contact.h"
#include "core/mesh/adjacency.h"

// What tests of overlaps share.
namespace cscd::test {

// How many surfaces of each kind; more by CSCD_RANDOM_SURFACES=10000.
inline int count() {
  const char* asked = std::getenv("CSCD_RANDOM_SURFACES");
  return asked != nullptr ? std::atoi(asked) : 1000;
}

inline TriangleId triangle(std::size_t t) {
  return TriangleId{static_cast<std::int32_t>(t)};
}

inline std::vector<CrossingPair> all_pairs(const TriangleMesh& mesh, std::span<const Vec3> x) {
  std::vector<CrossingPair> out;
  for (std::size_t a = 0; a < mesh.triangle_count(); ++a)
    for (std::size_t b = a + 1; b < mesh.triangle_count(); ++b)
      if (triangles_meet(mesh, x, triangle(a), triangle(b))) out.emplace_back(triangle(a), triangle(b));
  return out;
}

// Each pair that crosses is in one curve once; neighbouring segments have neighbouring triangles; curves end
// at shared vertices alone, as the surface is closed.
inline void expect_curves_right(const TriangleMesh& mesh, const CrossingCurves& found,
                                std::span<const CrossingPair> pairs) {
  std::set<CrossingPair> seen;
  std::size_t known = 0;
  for (const CrossingCurve& curve : found.curves) {
    EXPECT_TRUE(curve.closed() ||
                (curve.first == CrossingCurve::End::vertex && curve.last == CrossingCurve::End::vertex));
    ASSERT_EQ(curve.nodes.size(), curve.segments.size() + !curve.closed());
    for (std::size_t i = 0; i < curve.segments.size(); ++i) {
      const auto [a, b] = curve.segments[i];
      EXPECT_TRUE(seen.insert(std::minmax(a, b)).second);
      known += std::ranges::binary_search(pairs, CrossingPair(std::minmax(a, b)));
      if (!curve.closed() && i + 1 == curve.segments.size()) continue;
      const CrossingCurve::Node& node = curve.nodes[(i + 1) % curve.nodes.size()];
      const Piercing& p = found.piercings[static_cast<std::size_t>(node.piercing)];
      const auto& next = curve.segments[(i + 1) % curve.segments.size()];
      // A curve may come back with its sheets exchanged.
      const bool exchanged = i + 1 == curve.segments.size() && next[1U - node.edge_sheet] != p.face;
      EXPECT_EQ(p.face, curve.segments[i][1U - node.edge_sheet]);
      EXPECT_EQ(p.face, next[exchanged ? node.edge_sheet : 1U - node.edge_sheet]);
      const auto at_edge = mesh.triangles_at(p.edge);
      const std::set<TriangleId> both{curve.segments[i][node.edge_sheet],
                                      next[exchanged ? 1U - node.edge_sheet : node.edge_sheet]};
      EXPECT_EQ(both, std::set<TriangleId>(at_edge.begin(), at_edge.end()));
    }
  }
  EXPECT_EQ(known + found.touching, pairs.size());
  if (found.degenerate == 0) {
    EXPECT_EQ(known, seen.size());
  }
}

}  // namespace cscd::test
