#pragma once

#include <vector>

#include "core/detect/exclusions.h"
#include "core/detect/feature_pair_set.h"
#include "core/hierarchy/bounds.h"
#include "core/hierarchy/tree.h"

namespace cscd {

// Finds the feature pairs whose features may come within a radius of each other.
class CandidateSearch {
 public:
  // `reference`, [vertices], shapes the tree. `exclusions` may be null. Everything must outlive the search.
  CandidateSearch(const TriangleMesh& mesh, std::span<const Vec3> reference, const Exclusions* exclusions)
      : mesh_(mesh), exclusions_(exclusions), tree_(build_tree(mesh, reference)), bounds_(mesh, tree_) {}

  // Replaces the content of `out` by all feature pairs that are not excluded and for which the boxes of both
  // features' paths are at most `radius` apart along each axis. That holds every feature pair that comes
  // within the radius at some t. The radius is at least 0 and finite.
  void find(const Motion& motion, double radius, std::vector<FeaturePair>& out);

 private:
  const TriangleMesh& mesh_;
  const Exclusions* exclusions_;
  Tree tree_;
  SweptBoxes bounds_;
  FeaturePairSet met_;
};

}  // namespace cscd
