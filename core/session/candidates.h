#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/memory.h"
#include "core/detect/culler.h"
#include "core/detect/exclusions.h"
#include "core/detect/feature_owners.h"
#include "core/detect/feature_pair_set.h"
#include "core/detect/strategy.h"
#include "core/hierarchy/loose_vertices.h"

namespace cscd {

// Collects the feature pairs that some triangle pairs carry and that are not proven to stay farther apart
// than their thickness. The boxes of both features' paths are at most so far apart along each axis.
class CandidateSet {
 public:
  // `reference`, [vertices], is any pose, `exclusions` may be null, and `own_vertices` is about loose
  // vertices (hierarchy/loose_vertices.h). The mesh and the exclusions must outlive the set.
  CandidateSet(const TriangleMesh& mesh, std::span<const Vec3> reference, const Exclusions* exclusions,
               std::size_t own_vertices = 0);

  // Forgets the triangle pairs of the last step.
  void start_step() { met_.start_interval(), memory_.start(); }
  // Appends the feature pairs that are near enough, are not excluded, and are new in this step. All blocks of
  // a step together hold every triangle pair that carries some feature pair within its thickness.
  void take(const Motion& motion, const Thickness& thickness, std::span<const TrianglePair> block,
            std::vector<FeaturePair>& out);
  // Appends those of which a feature holds a certain vertex, whichever triangle pairs carry them. Takes the
  // time of a pass over the mesh for each of the features at the vertex.
  void take_all_of(const Motion& motion, const Thickness& thickness, VertexId vertex,
                   std::vector<FeaturePair>& out);
  // Appends those of loose vertices, which no triangle pair carries.
  void take_loose(const Motion& motion, const Thickness& thickness, std::vector<FeaturePair>& out);

 private:
  void add(const Motion& motion, const Thickness& thickness, const FeaturePair& features,
           std::vector<FeaturePair>& out);
  CarriedPlaces wanted(const TrianglePair& pair) const;

  const TriangleMesh& mesh_;
  const Exclusions* exclusions_;
  std::optional<FeatureOwners> owners_;
  LooseVertices loose_;
  FeaturePairSet met_;
  MemoryWatch memory_;
  std::vector<TrianglePair> block_;  // of which some feature pairs are wanted
};

// Hands the triangle pairs that a culler passes on to a set.
class CandidateSink : public TrianglePairSink {
 public:
  CandidateSink(CandidateSet& set, const Motion& motion, const Thickness& thickness,
                std::vector<FeaturePair>& out)
      : set_(set), motion_(motion), thickness_(thickness), out_(out) {}

 private:
  void take(const std::vector<TrianglePair>& block) override { set_.take(motion_, thickness_, block, out_); }
  CandidateSet& set_;
  const Motion motion_;
  const Thickness thickness_;
  std::vector<FeaturePair>& out_;
};

// Finds the feature pairs of one surface whose features may come within their thickness of each other.
class CandidateSearch {
 public:
  // What `setup` refers to must outlive the search. `first_only` is not looked at.
  explicit CandidateSearch(const StrategyInput& setup)
      : setup_(setup), set_(setup.mesh, setup.reference, setup.exclusions) {}

  // Replaces the content of `out` by feature pairs that hold every one that comes within its thickness at
  // some t and is not excluded. Pairs that a complete culler proves apart are not among them, nor are pairs
  // that CandidateSet does not take. The culler is prepared by the first call.
  void find(const Motion& motion, const Thickness& thickness, std::vector<FeaturePair>& out);
  // After find(): appends the pairs that hold some of these vertices and come within a thickness which is
  // larger than that of find(). Where it is large for few vertices alone, this is far quicker than find(),
  // because cullers go by the largest thickness of all pairs.
  void find_more(const Motion& motion, const Thickness& thickness, std::span<const VertexId> vertices,
                 std::vector<FeaturePair>& out);

 private:
  StrategyInput setup_;
  CandidateSet set_;
  std::unique_ptr<Culler> culler_;
};

}  // namespace cscd
