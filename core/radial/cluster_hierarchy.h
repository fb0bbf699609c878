#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/detect/counts.h"
#include "core/detect/culler.h"
#include "core/hierarchy/bounds.h"
#include "core/hierarchy/tree.h"
#include "core/mesh/near_triangles.h"
#include "core/radial/atomic_clusters.h"
#include "core/radial/orientation.h"

// Intra- and inter-cluster checks (sections 3.1 and 6 of the 2014 paper) over local trees, one a cluster,
// under one global tree.
//
// Inside a cluster, a pair is needed unless both triangles are positive towards the cluster's observer, or
// both are negative. Every node carries the mask of the classes below it, so the descent drops two nodes at
// once when both masks are one and the same sign. In the paper's letters, H- against H+ and Hu against all
// remain. Between clusters the bounds alone decide.
//
// Soundness. One field has to certify all triangles incident to a dropped feature pair (rule one-field,
// core/soundness.md). A feature pair is tested as soon as one triangle pair that carries it is passed on
// (rule any-carrier). So if a feature pair is dropped, each triangle pair that carries it is either apart in
// its bounds, which excludes a contact, or lies in one cluster with one sign. Clusters never span two
// connected components (rule component).
namespace cscd::radial {

// The trees over all clusters, the bounds of their nodes, and the classes of all triangles in one interval.
class ClusterHierarchy {
 public:
  // `reference`, [vertices], is the pose in which the trees are built. The mesh must outlive the hierarchy.
  ClusterHierarchy(const TriangleMesh& mesh, std::span<const Vec3> reference, const AtomicClusters& clusters,
                   Pipeline pipeline = Pipeline::vectorised);

  // Makes the bounds of one interval. With a thickness, they grow by half of it.
  void refit(const Motion& motion, double thickness = 0) {
    thickness_ = thickness;
    bounds_.refit(motion, thickness / 2);
  }

  // [atomic clusters]; the triangles of each, in the order of its classes.
  std::span<const std::vector<TriangleId>> groups() const { return groups_; }
  // Where the caller writes the orientation classes of one atomic cluster, in the order of its triangles.
  std::span<Orientation> classes(std::size_t cluster) {
    return std::span(class_of_leaf_).subspan(first_leaf_[cluster], groups_[cluster].size());
  }
  // With a thickness: calls triangles uncertain unless their plane is certainly farther than half of it from
  // their observer, which has to be a point ("Contacts at a distance", core/soundness.md). To be called
  // before finish_classes(). `observers` holds the observer of each label of `merged`, [clusters].
  void keep_distant(const Motion& motion, std::span<const std::int32_t> merged,
                    std::span<const Observer> observers);
  // To be called when all classes of the interval have been written.
  RadialCounts finish_classes();

  // Passes on the pairs of triangles that have to be tested when atomic clusters with the same label act as
  // one cluster. Returns the number of overlap tests. With a thickness, signs say nothing of pairs that are
  // near on the surface, and these are passed on by their bounds.
  CullCounts cull(std::span<const std::int32_t> merged, TrianglePairSink& sink) const;
  // How these clusters see the surface, triangle by triangle. `observers` holds the observer of each label.
  RadialView view(std::span<const std::int32_t> merged, std::span<const Observer> observers) const;

 private:
  std::uint64_t pass_on_near(TrianglePairSink& sink) const;

  const TriangleMesh& mesh_;
  Tree tree_;
  SweptBounds bounds_;
  std::vector<std::int32_t> cluster_at_;  // [nodes]: the cluster whose root the node is, or -1
  std::vector<std::vector<TriangleId>> groups_;
  std::vector<std::size_t> first_leaf_;  // [clusters]: in tree order
  std::vector<Orientation> class_of_leaf_;
  std::vector<std::uint8_t> mask_;  // [nodes]: which classes occur below
  double thickness_ = 0;
  // With a thickness alone: the leaf of each triangle, and what is near it on the surface.
  std::vector<NodeIndex> leaf_of_;
  std::optional<NearTriangles> near_;
};

}  // namespace cscd::radial
