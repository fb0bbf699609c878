#pragma once

#include <memory>
#include <vector>

#include "core/detect/culler.h"
#include "core/detect/exclusions.h"
#include "core/detect/feature_pair_set.h"
#include "core/detect/strategy.h"

namespace cscd {

// Collects the feature pairs that some triangle pairs carry and whose features may come within their
// thickness of each other. The boxes of both features' paths are then at most so far apart along each axis.
class CandidateSet {
 public:
  // `exclusions` may be null. Everything must outlive the set.
  CandidateSet(const TriangleMesh& mesh, const Exclusions* exclusions)
      : mesh_(mesh), exclusions_(exclusions) {}

  // Forgets the triangle pairs of the last step.
  void start_step() { met_.start_interval(); }
  // Appends the pair's feature pairs that are near enough, are not excluded, and are new in this step.
  void take(const Motion& motion, const Thickness& thickness, const TrianglePair& pair,
            std::vector<FeaturePair>& out);

 private:
  const TriangleMesh& mesh_;
  const Exclusions* exclusions_;
  FeaturePairSet met_;
};

// Hands the triangle pairs that a culler passes on to a set.
class CandidateSink : public TrianglePairSink {
 public:
  CandidateSink(CandidateSet& set, const Motion& motion, const Thickness& thickness,
                std::vector<FeaturePair>& out)
      : set_(set), motion_(motion), thickness_(thickness), out_(out) {}

 private:
  void take(const std::vector<TrianglePair>& block) override {
    for (const TrianglePair& pair : block) set_.take(motion_, thickness_, pair, out_);
  }
  CandidateSet& set_;
  const Motion motion_;
  const Thickness thickness_;
  std::vector<FeaturePair>& out_;
};

// Finds the feature pairs of one surface whose features may come within their thickness of each other.
class CandidateSearch {
 public:
  // What `setup` refers to must outlive the search. `first_only` is not looked at.
  explicit CandidateSearch(const StrategyInput& setup) : setup_(setup), set_(setup.mesh, setup.exclusions) {}

  // Replaces the content of `out` by feature pairs that hold every one that comes within its thickness at
  // some t and is not excluded. Pairs that a complete culler proves apart are not among them, nor are pairs
  // that CandidateSet does not take. The culler is prepared by the first call.
  void find(const Motion& motion, const Thickness& thickness, std::vector<FeaturePair>& out);

 private:
  StrategyInput setup_;
  CandidateSet set_;
  std::unique_ptr<Culler> culler_;
};

}  // namespace cscd
