// Debian builds FCL for any x86-64 processor. If the compiler may use wider vectors, Eigen would lay out
// FCL's classes differently here than in the library, and each would write past the other's objects.
#define EIGEN_MAX_ALIGN_BYTES 16
#include "baselines/fcl/fcl.h"

#include <cassert>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/kDOP.h>
#include <fcl/math/bv/utility.h>
#include <fcl/narrowphase/detail/traversal/collision/mesh_continuous_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "baselines/fcl/fcl_elementary.h"
#include "core/base/error.h"
#include "core/base/stage_clock.h"
#include "core/detect/carried_pairs.h"
#include "core/detect/feature_pair_set.h"
#include "core/mesh/adjacency.h"

// Idea: the general collision library that a user is likely to have, as a second opinion and as a competitor.
//
// The parts that work: continuousCollide takes rigid motions of two objects and nothing else (fcl#412). The
// deforming case exists as parts that are undocumented and are used here as they are. A BVHModel that is
// updated keeps the vertices of the frame before and fits its volumes to both frames.
// MeshContinuousCollisionTraversalNode tests two triangles over the interval. selfCollide descends one model
// against itself. The answer is a list of triangle pairs with the earliest time of each.
//
// Fidelity: FCL 0.7 of Debian. Its hierarchy (split at the mean of the longest axis), 16-DOPs in double,
// traversal and elementary tests are its own. Nothing is shared with the other strategies, and the elementary
// test of the setup is not asked. Two things are added. First, the leaves are kept and tested after the
// traversal, by FCL's own function, so that there are two stages to time. Second, each triangle pair that FCL
// reports is asked about once more feature by feature, outside the clock, with the functions that FCL itself
// called, because contacts here are feature pairs. A reported triangle pair drops out if it touches only in
// features with a common vertex.
//
// Tuning: none of FCL's own choices is changed. The start of an interval is written to the model directly,
// which saves a refit; the refit is bottom-up; there is no early stop.
//
// A dropped pair is not proven apart (guarantee heuristic). FCL's cubics are tested without error bounds and
// are dropped if all coefficients are zero, and its feature tests have absolute tolerances. Times are the
// middle of an interval of its root finder.
// interval of its root finder.
namespace cscd {
namespace {

using Volume = fcl::KDOP<double, 16>;
using Model = fcl::BVHModel<Volume>;
using FclTraversal = fcl::detail::MeshContinuousCollisionTraversalNode<Volume>;

// FCL's traversal, but it keeps the pairs of leaves instead of testing them.
class Traversal : public FclTraversal {
 public:
  struct Leaves {
    int a, b;
  };
  void leafTesting(int a, int b) const override { met.push_back({a, b}); }
  mutable std::vector<Leaves> met;
};

class FclDetector : public Detector {
 public:
  explicit FclDetector(const StrategyInput& setup)
      : mesh_(setup.mesh), positions_(setup.reference.begin(), setup.reference.end()) {
    std::vector<fcl::Triangle> triangles;
    for (const Triangle& corner : mesh_.triangles())
      triangles.emplace_back(+corner[0], +corner[1], +corner[2]);
    model_.beginModel(static_cast<int>(triangles.size()), static_cast<int>(positions_.size()));
    model_.addSubModel(positions_, triangles);
    model_.endModel();
    traversal_.enableStatistics(true);
    request_.num_max_contacts = std::numeric_limits<std::size_t>::max();
  }

  Report detect(const Step& step, ContactSet& out) override {
    assert(step.crossings == nullptr);
    const Motion& motion = step.motion;
    out.clear();
    for (const std::span<const Vec3> end : {motion.start(), motion.end()})
      for (const Vec3& p : end)
        if (p.cwiseAbs().maxCoeff() > kFclFarthest)
          throw InputError("strategy fcl: a coordinate beyond 1e100; choose a larger unit of length");
    clock_.reset();
    clock_.enter(Stage::refit);
    std::copy(motion.start().begin(), motion.start().end(), model_.vertices);
    positions_.assign(motion.end().begin(), motion.end().end());
    model_.beginUpdateModel();
    model_.updateSubModel(positions_);
    model_.endUpdateModel(true, true);

    clock_.enter(Stage::traversal);
    traversal_.met.clear();
    traversal_.pairs.clear();
    traversal_.num_bv_tests = 0;
    const fcl::Transform3d in_place = fcl::Transform3d::Identity();
    fcl::detail::initialize(traversal_, model_, in_place, model_, in_place, request_);
    fcl::detail::selfCollide(&traversal_);

    clock_.enter(Stage::elementary);
    for (const auto& [a, b] : traversal_.met) traversal_.FclTraversal::leafTesting(a, b);
    clock_.stop();

    Report report;
    report.cull.bvot = static_cast<std::uint64_t>(traversal_.num_bv_tests);
    report.cull.pctp = traversal_.met.size();
    for (const auto& [a, b] : traversal_.met)
      report.pairs.adjacent_pctp += adjacent(triangle_at(a), triangle_at(b));
    report.pairs.feature_pairs = report.pairs.elementary_tests = 15 * traversal_.met.size();
    report.ms.refit = clock_.milliseconds(Stage::refit);
    report.ms.traversal = clock_.milliseconds(Stage::traversal);
    report.ms.elementary = clock_.milliseconds(Stage::elementary);
    name_features(motion, out);
    return report;
  }

 private:
  TriangleId triangle_at(int leaf) const { return TriangleId{model_.getBV(leaf).primitiveId()}; }
  bool adjacent(TriangleId a, TriangleId b) const { return share_vertex(mesh_.corners(a), mesh_.corners(b)); }

  // Finds the features of the reported triangles that touch, by FCL's own functions.
  void name_features(const Motion& motion, ContactSet& out) {
    met_.start_interval();
    for (const auto& reported : traversal_.pairs) {
      const TrianglePair pair{TriangleId{reported.id1}, TriangleId{reported.id2}};
      for_each_carried(mesh_, pair, [&](const FeaturePair& features) {
        if (!met_.insert(features)) return;
        const Answer answer = ask(test_, mesh_, motion, features);
        if (answer.verdict == Verdict::contact)
          out.contacts.push_back({features, answer.verdict, answer.time});
      });
    }
  }
  const TriangleMesh& mesh_;
  StageClock clock_;
  std::vector<Vec3> positions_;  // [vertices]; the form in which FCL takes positions
  Model model_;
  Traversal traversal_;
  fcl::CollisionRequest<double> request_;
  FeaturePairSet met_;
  const ElementaryTest test_ = fcl_elementary_test();
};

}  // namespace

Prepared make_fcl(const StrategyInput& setup) {
  if (setup.exclusions != nullptr)
    throw InputError(
        "strategy fcl: brings its own elementary test and cannot leave pairs out; choose another strategy");
  if (setup.first_only)
    throw InputError(
        "strategy fcl: tests pairs by itself and finds all contacts; do not ask it for the first alone");
  return {std::make_unique<FclDetector>(setup), {}};
}

}  // namespace cscd
