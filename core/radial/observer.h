#pragma once

#include <span>
#include <vector>

#include "core/mesh/rig.h"
#include "core/radial/atomic_clusters.h"
#include "core/radial/orientation.h"

namespace cscd::radial {

// A cluster's triangles are viewed from the centre of the cluster's bone, or from the bone as a segment.
enum class ObserverKind { bone_centre, bone_segment };

// Returns the observer of one bone, from the bone's positions at the start and at the end of an interval.
Observer observer(ObserverKind kind, const Bone& start, const Bone& end);

// Returns for each cluster the kind with more positive triangles in the reference pose, [clusters]. On a tie
// the kind is the centre, which costs less. This is our reading of the 2013 method, whose text on the choice
// was not available to us.
std::vector<ObserverKind> choose_in_reference_pose(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                                   const Rig& rig, const AtomicClusters& clusters);

// Returns for each cluster the kind with more positive triangles on average over four trials, [clusters]
// (section 4.2 of the 2014 paper). The trials are the cluster at rest, and the cluster rotated by `theta`
// radians about x, y and z at the bone's head. In a trial the triangles move from the reference pose to the
// rotated pose, and the centre moves with them. Both ends of the segment move with the velocity of the centre
// (the paper's "zero relative velocity"). On a tie the kind is the segment.
std::vector<ObserverKind> choose_by_rotation_trial(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                                   const Rig& rig, const AtomicClusters& clusters,
                                                   double theta);

}  // namespace cscd::radial
