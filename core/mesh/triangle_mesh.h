#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "core/base/vec3.h"

namespace cscd {

using Triangle = std::array<VertexId, 3>;  // corners, counter-clockwise seen from outside
using Edge = std::array<VertexId, 2>;      // ends, smaller index first

// The defects that a list of triangles can have as a surface.
enum class Defect {
  duplicate_triangle,
  non_manifold_edge,
  boundary_edge,
  inconsistent_orientation,
  non_manifold_vertex
};

// The connectivity of a triangle surface, which never changes. The constructor refuses what is not a triangle
// list at all. Surfaces that are open, non-manifold or inconsistently oriented are accepted and listed in
// defects(), because strategies with the guarantee `complete` can use them.
class TriangleMesh {
 public:
  // Takes triangles as [triangles] of vertex indices in [0, vertex_count). Throws InputError for an index
  // outside that range, a triangle that repeats a corner, an empty list, or more than 2^28 vertices or
  // triangles. `name` (a file, a scene) begins the error texts.
  TriangleMesh(std::vector<Triangle> triangles, std::size_t vertex_count, const std::string& name = "mesh");

  std::size_t vertex_count() const { return vertex_count_; }
  std::size_t edge_count() const { return edges_.size(); }
  std::size_t triangle_count() const { return triangles_.size(); }

  std::span<const Triangle> triangles() const { return triangles_; }
  std::span<const Edge> edges() const { return edges_; }
  const Triangle& corners(TriangleId triangle) const { return triangles_[+triangle]; }
  const Edge& ends(EdgeId edge) const { return edges_[+edge]; }

  // Edge k of a triangle joins corners k and (k + 1) mod 3.
  const std::array<EdgeId, 3>& edges_of(TriangleId triangle) const { return triangle_edges_[+triangle]; }
  std::span<const TriangleId> triangles_at(VertexId vertex) const { return slice(at_vertex_, +vertex); }
  std::span<const TriangleId> triangles_at(EdgeId edge) const { return slice(at_edge_, +edge); }

  // Connected components, joined through shared vertices, are numbered from 0 in the
  // order of their first triangle.
  std::int32_t component_count() const { return component_count_; }
  std::int32_t component(TriangleId triangle) const { return component_[+triangle]; }

  // The first defect of one kind, and the number of defects of that kind.
  struct DefectReport {
    Defect kind;
    std::size_t count;
    std::string first;  // names the element: "edge (3, 7) of triangle 12 has no second triangle"
  };
  // Returns one report for each kind of defect that occurs; none for a closed, manifold, oriented surface.
  const std::vector<DefectReport>& defects() const { return defects_; }
  bool closed_and_oriented() const { return defects_.empty(); }

 private:
  struct Incidence {  // compressed rows: the triangles at element i are items[offset[i] .. offset[i + 1])
    std::vector<std::int32_t> offset;
    std::vector<TriangleId> items;
  };
  static std::span<const TriangleId> slice(const Incidence& incidence, std::size_t i) {
    const auto first = static_cast<std::size_t>(incidence.offset[i]);
    return std::span(incidence.items)
        .subspan(first, static_cast<std::size_t>(incidence.offset[i + 1]) - first);
  }
  void build_edges();
  void build_components();
  void find_defects();

  std::size_t vertex_count_;
  std::vector<Triangle> triangles_;
  std::vector<Edge> edges_;
  std::vector<std::array<EdgeId, 3>> triangle_edges_;
  Incidence at_vertex_, at_edge_;
  std::vector<std::int32_t> component_;
  std::int32_t component_count_ = 0;
  std::vector<DefectReport> defects_;
};

// Throws InputError, naming the first defect and the counts, unless the surface is closed, manifold and
// consistently oriented (rule closed-mesh, core/soundness.md). `who` names the user of the surface in the
// error text ("strategy drvbc").
void require_closed_and_oriented(const TriangleMesh& mesh, const std::string& who);

// Throws InputError naming the first position that is NaN or infinite. `where`
// begins the error text ("frame 3").
void require_finite(std::span<const Vec3> positions, const std::string& where);

}  // namespace cscd
