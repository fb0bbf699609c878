#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/detect/carried_pairs.h"
#include "core/detect/culler.h"
#include "core/geometry/simd_floats.h"
#include "core/mesh/motion.h"

namespace cscd {

// Appends to `left`, in order, the pairs that the non-penetration filter and directions in a plane cannot
// prove apart. Eight pairs are treated at a time in vector code; never_coplanar() and
// test::never_meet_in_plane() are the scalar twins.
void filter(const TriangleMesh& mesh, const Motion& motion, std::span<const FeaturePair> pairs,
            std::vector<FeaturePair>& left);
// Does the same for everything that pairs of triangles carry, with all that two triangles carry at once. If
// so wished, single precision goes first, which is faster and drops more (not_filtered_when_coplanar()). It
// may then look at the interval from t = 0 to `last` alone, and drop feature pairs that touch later only.
void filter(const TriangleMesh& mesh, const Motion& motion, std::span<const CarriedPairs> pairs,
            bool single_precision_first, double last, std::vector<FeaturePair>& left);

// Returns the feature pairs of two triangles, among those at some places, that the filter
// (core/elementary/question/filter.h) cannot prove apart. The six vertices are loaded once; what fifteen
// pairs need are permutations of registers.
CarriedPlaces not_filtered(const Motion& motion, const Triangle& a, const Triangle& b, CarriedPlaces places);
// Drops more, in single precision: evaluates all fifteen feature pairs of two triangles side by side, with
// bounds on what single precision loses, and looks along directions in the plane only for the part of the
// interval in which a feature pair may be coplanar, because most pairs that come into one plane are far apart
// at that moment. What is left may depend on which triangles carry a feature pair. Asks not_filtered() where
// single precision leaves signs open.
//
// With `last` below 1, in (0, 1], looks at the interval from t = 0 to that time alone: drops a feature pair
// only if the pair certainly does not touch until then, and keeps what it cannot decide.
CarriedPlaces not_filtered_when_coplanar(const Motion& motion, const Triangle& a, const Triangle& b,
                                         CarriedPlaces places, double last);

// Returns the feature pairs of two triangles, among those at some places, that may come within a distance of
// each other, finite and above 0. Each pair is held against the directions between nearest points that its
// features may have half-way through the interval. Points move in straight lines, so where the gap along a
// fixed direction exceeds the distance at both ends, it does so at every t.
CarriedPlaces not_farther_than(double distance, const Motion& motion, const Triangle& a, const Triangle& b,
                               CarriedPlaces places);

// Returns, for each of up to sixteen pairs of triangles, a time before which the two certainly do not touch,
// or do not come within a distance of each other: 0 where nothing is known, more than 1 where they never do.
// Along a direction, the gap between two triangles is at least what lies on the straight line between the
// gaps at both ends, so they do not touch before that line meets 0, and are farther apart until it meets the
// distance. The result is the latest such time over several directions: three axes, the normals of both
// triangles at both ends, and the way from one triangle to the other.
std::array<float, kLanes16> no_contact_before(const TriangleMesh& mesh, const Motion& motion,
                                              std::span<const TrianglePair> pairs, double distance = 0);

// Drops feature pairs by the signs of rounded coefficients without their error bounds, as published (Tang
// et al. 2010), one pair at a time. This is the filter of the pipeline `published`. It may drop features that
// touch (rule certain-sign, core/soundness.md).
void drop_by_plain_sign(const TriangleMesh& mesh, const Motion& motion, std::vector<FeaturePair>& pairs);

}  // namespace cscd
