#include "core/detect/feature_owners.h"

#include <algorithm>
#include <bit>
#include <iterator>

namespace cscd {
namespace {

// Gives features to triangles: to a triangle all three of its kind that are free, as long as there are such
// triangles, and what is left to a triangle that owns most already.
template <class FeaturesOf, class TrianglesAt>
void give(std::size_t triangles, std::size_t features, const FeaturesOf& of, const TrianglesAt& at,
          unsigned shift, std::vector<std::uint8_t>& owned) {
  std::vector<bool> given(features);
  for (std::size_t t = 0; t < triangles; ++t) {
    const auto& three = of(TriangleId{static_cast<std::int32_t>(t)});
    if (std::ranges::any_of(three, [&](auto f) { return given[+f]; })) continue;
    for (const auto f : three) given[+f] = true;
    owned[t] = static_cast<std::uint8_t>(owned[t] | 7U << shift);
  }
  using Feature = std::remove_cvref_t<decltype(of(TriangleId{0})[0])>;
  for (std::size_t f = 0; f < features; ++f) {
    if (given[f]) continue;
    const Feature feature{static_cast<std::int32_t>(f)};
    const auto around = at(feature);
    if (around.empty()) continue;
    const auto owner = std::ranges::max_element(around, {}, [&](TriangleId t) {
      return 8 * std::popcount(owned[+t] >> shift & 7U) + std::popcount(unsigned{owned[+t]});
    });
    const auto& three = of(*owner);
    const auto place = std::ranges::find(three, feature) - std::begin(three);
    owned[+*owner] = static_cast<std::uint8_t>(owned[+*owner] | 1U << (shift + static_cast<unsigned>(place)));
  }
}

}  // namespace

FeatureOwners::FeatureOwners(const TriangleMesh& mesh) : owned_(mesh.triangle_count()) {
  give(
      mesh.triangle_count(), mesh.edge_count(), [&](TriangleId t) -> const auto& { return mesh.edges_of(t); },
      [&](EdgeId e) { return mesh.triangles_at(e); }, 3, owned_);
  give(
      mesh.triangle_count(),
      mesh.vertex_count(), [&](TriangleId t) -> const auto& { return mesh.corners(t); },
      [&](VertexId v) { return mesh.triangles_at(v); }, 0, owned_);
}

}  // namespace cscd
