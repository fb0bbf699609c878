#pragma once

#include <algorithm>
#include <vector>

#include "bench/strategies/catalogue.h"
#include "bench/testing/saboteurs.h"
#include "core/detect/start/embedding.h"
#include "core/mesh/test_shapes.h"

// What the tests of the soundness rules share: one interval of a mesh with one bone, asked of any
// strategy with the exact oracle. One test for each way in which the contract is broken silently, on whole
// strategies; more of the same stand beside the units. "Mutation" says which change to the house made the
// test fail when it was tried. Rule error-bound is in core/radial/orientation_test.cpp, rule one-field in
// core/radial/cluster_hierarchy_test.cpp.
namespace cscd::bench::rules {

using radial::ObserverKind;
using test::Flaw;
using test::Shape;

inline const ElementaryTest& exact() {
  return elementary_test_named("exact");
}

// Returns the strategies that promise something.
inline std::vector<const Strategy*> with_guarantee() {
  std::vector<const Strategy*> rows;
  for (const Strategy& strategy : strategies())
    if (strategy.guarantee != Guarantee::heuristic) rows.push_back(&strategy);
  return rows;
}

// One interval of a mesh with bones.
struct Case {
  TriangleMesh mesh;
  std::vector<Vec3> start, end;
  Rig rig;
  std::vector<Bone> bones_end;

  Case(const Shape& shape, std::vector<Vec3> end_in, const Bone& bone)
      : mesh(shape.mesh()),
        start(shape.positions),
        end(std::move(end_in)),
        rig{{BoneId{-1}}, {bone}},
        bones_end{bone} {}

  StrategyInput setup() const { return {mesh, start, &rig, exact()}; }
  ContactSet ask(Detector& detector) const {
    const Rig::Interval bones{rig.reference, bones_end};
    ContactSet found;
    detector.detect({Motion(start, end), &bones}, found);
    found.sort();
    return found;
  }
  ContactSet ask(const Strategy& strategy) const { return ask(*strategy.make(setup()).detector); }
  // All triangles in one cluster, whatever their component, viewed from the one bone.
  template <Flaw flaw>
  ContactSet in_one_cluster(ObserverKind kind) const {
    const std::vector<BoneId> bone_of(mesh.triangle_count(), BoneId{0});
    return ask(*test::make_radial<flaw>(setup(), test::clusters_across_components(mesh, bone_of), {kind}));
  }
  bool embedded() const { return EmbeddingTest(mesh, start).embedded(start); }
};

inline bool holds(const ContactSet& set, const FeaturePair& pair) {
  return std::any_of(set.contacts.begin(), set.contacts.end(),
                     [&](const Contact& contact) { return contact.pair == pair; });
}

// The end of a motion in which vertices from `first` to before `last` are shifted.
inline std::vector<Vec3> shifted(std::vector<Vec3> positions, std::size_t first, std::size_t last,
                                 const Vec3& by) {
  for (std::size_t i = first; i < last; ++i) positions[i] += by;
  return positions;
}

inline const Bone kFarBelow{{-0.1, 0, -20}, {0.1, 0, -20}};

}  // namespace cscd::bench::rules
