#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/detect/culler.h"
#include "core/detect/exclusions.h"
#include "core/detect/feature_pair_set.h"
#include "core/detect/strategy.h"
#include "core/hierarchy/bounds.h"
#include "core/hierarchy/tree.h"

namespace cscd {

// Collects the feature pairs that some triangle pairs carry and whose features may come within a radius of
// each other. The boxes of both features' paths are then at most the radius apart along each axis.
class CandidateSet {
 public:
  // `exclusions` may be null. Everything must outlive the set.
  CandidateSet(const TriangleMesh& mesh, const Exclusions* exclusions)
      : mesh_(mesh), exclusions_(exclusions) {}

  // Forgets the triangle pairs of the last step.
  void start_step() { met_.start_interval(); }
  // Appends the pair's feature pairs that are near enough, are not excluded, and are new in this step.
  void take(const Motion& motion, double radius, const TrianglePair& pair, std::vector<FeaturePair>& out);

 private:
  const TriangleMesh& mesh_;
  const Exclusions* exclusions_;
  FeaturePairSet met_;
};

// Hands the triangle pairs that a culler passes on to a set.
class CandidateSink : public TrianglePairSink {
 public:
  CandidateSink(CandidateSet& set, const Motion& motion, double radius, std::vector<FeaturePair>& out)
      : set_(set), motion_(motion), radius_(radius), out_(out) {}

 private:
  void take(const std::vector<TrianglePair>& block) override {
    for (const TrianglePair& pair : block) set_.take(motion_, radius_, pair, out_);
  }
  CandidateSet& set_;
  const Motion motion_;
  const double radius_;
  std::vector<FeaturePair>& out_;
};

// Finds the feature pairs of one surface whose features may come within a radius of each other.
class CandidateSearch {
 public:
  // What `setup` refers to must outlive the search. `first_only` is not looked at.
  explicit CandidateSearch(const StrategyInput& setup) : setup_(setup), set_(setup.mesh, setup.exclusions) {}

  // Replaces the content of `out` by feature pairs that hold every one that comes within `radius` at some t
  // and is not excluded. With a radius above 0 these are all pairs that CandidateSet takes. With radius 0
  // they are those among them that a complete culler does not prove apart. The radius is at least 0 and
  // finite. The index for radius 0 and the one for larger radii are built when they are first used.
  void find(const Motion& motion, double radius, std::vector<FeaturePair>& out);

 private:
  void find_touching(const Motion& motion, std::vector<FeaturePair>& out);
  void find_near(const Motion& motion, double radius, std::vector<FeaturePair>& out);

  StrategyInput setup_;
  CandidateSet set_;
  std::unique_ptr<Culler> culler_;  // for radius 0
  std::optional<Tree> tree_;        // for others
  std::optional<SweptBoxes> bounds_;
};

}  // namespace cscd
