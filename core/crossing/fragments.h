#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/base/numbers.h"
#include "core/base/vec3.h"
#include "core/crossing/curves.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// What is known of the vertices, edges and triangles of a mesh while the curves of a pose are looked at. It
// is kept from pose to pose, and each pose leaves it as it was, so that little is written anew.
struct CurveMarks {
  explicit CurveMarks(const TriangleMesh& mesh);
  // Makes room for marks. A mesh that never crosses itself needs none.
  void prepare(const TriangleMesh& mesh);
  std::span<const TriangleId> triangles_of(std::int32_t component) const {
    const std::size_t c = index(component);
    return std::span(by_component)
        .subspan(first_of_component[c], first_of_component[c + 1] - first_of_component[c]);
  }

  std::vector<bool> is_open;              // [components], whether it has an edge without two proper sides
  std::vector<std::int32_t> pierced;      // [edges], the first piercing, or kNone
  std::vector<std::uint8_t> is_on_curve;  // [vertices], whether a curve ends there
  std::vector<std::uint8_t> is_cut;       // [triangles], whether a curve runs through

  std::vector<TriangleId> by_component;         // [triangles]
  std::vector<std::size_t> first_of_component;  // [components + 1], into by_component

  // A forest that spans the mesh. Most of its edges are whole in every pose, so most vertices are in the
  // fragment of the vertex before them.
  struct Branch {
    VertexId vertex, from;  // `from` comes earlier; of a root it is -1
    EdgeId edge;            // between them
  };
  std::vector<Branch> forest;        // [vertices]
  std::vector<std::int32_t> branch;  // [vertices], pieces of the forest that pierced edges cut apart
};

// The fragments into which the curves of a pose cut the surface: vertices joined by edges that nothing
// pierces. What is decided exactly is decided for `exact`, the positions as they are given. Volumes are
// computed from `positions`, the same times a power of two.
class Fragments {
 public:
  // All must outlive the object, which takes its marks away when it goes.
  Fragments(const TriangleMesh& mesh, CurveMarks& marks, const CrossingCurves& crossing,
            std::span<const Vec3> exact, std::span<const Vec3> positions)
      : mesh_(mesh), marks_(marks), crossing_(crossing), exact_(exact), positions_(positions) {}
  ~Fragments();
  Fragments(const Fragments&) = delete;
  Fragments& operator=(const Fragments&) = delete;

  // Sets the marks and finds the fragments, before anything is asked.
  void find();

  const CurveMarks& marks() const { return marks_; }
  bool is_on_curve(VertexId v) const { return marks_.is_on_curve[+v] != 0; }
  // All piercings of an edge, in no order along it.
  std::span<const Piercing> piercings_of(EdgeId edge) const;

  // How faces of a component part the ends of an edge: not at all if as many have the one end behind them
  // as the other. Faces of an open component may look anywhere; there, an even number of faces does not part.
  struct Parting {
    int faces = 0;  // how many more have the end `behind` behind them than the end `before`
    VertexId behind{-1}, before{-1};
    bool parts() const { return faces != 0; }
  };
  Parting parting(EdgeId edge, std::int32_t other) const;

  // A component and another, or the same, whose faces its edges pierce.
  struct Group {
    std::int32_t own, other;
    auto operator<=>(const Group&) const = default;
  };
  const Group& group(std::size_t g) const { return groups_[g]; }
  std::size_t group_of(const Piercing& piercing) const;

  // The part of the component `own` of a group in which a vertex with a pierced edge lies: all fragments from
  // which the other component does not part it. Parts are named by any number.
  std::int32_t part_of(std::size_t group, VertexId v);
  std::int32_t vertex_count(std::size_t group, std::int32_t part) const {
    return -parts_[group].parent[static_cast<std::size_t>(part)];
  }
  // How often a closed component winds around what is just before its faces at a vertex with a pierced edge.
  // Nothing where this cannot be decided.
  std::optional<int> winding(std::int32_t own, VertexId v);
  // Whether the faces of a closed component look inward.
  bool is_inward(std::int32_t component);

 private:
  std::int32_t component(EdgeId edge) const { return mesh_.component(mesh_.triangles_at(edge).front()); }
  std::int32_t fragment(VertexId v) const { return fragment_[index(marks_.branch[+v])]; }
  // The fragments of one tree of the forest, joined to the parts of a group.
  struct Parts {
    std::int32_t first;                // fragment
    std::vector<std::int32_t> parent;  // [fragments of the tree]
  };

  void set_marks();
  void cut();
  void join();
  // The end of the fragments of a tree, from the first of them.
  std::int32_t end_of_tree(std::int32_t first) const;
  std::vector<std::optional<int>> windings_of(std::int32_t own, std::int32_t first) const;

  const TriangleMesh& mesh_;
  CurveMarks& marks_;
  const CrossingCurves& crossing_;
  std::span<const Vec3> exact_, positions_;
  std::vector<std::int32_t> fragment_;  // [branches], which branches are one
  // [fragments]: minus the number of vertices, and the first fragment of the same tree. Those of one tree
  // follow each other.
  std::vector<std::int32_t> size_, first_;
  std::vector<Group> groups_;            // sorted
  std::vector<Parts> parts_;             // [groups]
  std::map<std::int32_t, bool> inward_;  // of components
  std::map<std::int32_t, std::vector<std::optional<int>>>
      windings_;  // of components, [fragments of the tree]
};

}  // namespace cscd
