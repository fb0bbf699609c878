#pragma once

#include <array>
#include <span>

#include "core/detect/contact.h"
#include "core/detect/culler.h"
#include "core/detect/detector.h"
#include "core/geometry/lanes16.h"

// For callers who want the earliest contact and no others, such as a response that cuts the step there.
namespace cscd {

// From the next interval on, triangle pairs that cannot touch before the earliest contact found so far are
// neither filtered nor tested. Which contacts are reported beside those of the earliest time is then left to
// chance: `keep_first` drops them. What the strategy promises of the earliest time stays, provided that the
// elementary test is right in both its answers. (A strategy that assigns features to triangle pairs tests all
// that it assigns.) False for a detector that `compose` did not make: it goes on finding all.
bool look_for_first_only(Detector& detector);

// Leaves the contacts of the earliest time, and what is undecided. Takes a sorted set.
void keep_first(ContactSet& sorted);

// Of up to sixteen pairs of triangles, a time before which the two certainly do not touch: 0 where nothing is
// known, more than 1 where they never do. Along a direction, the gap between them is at least what lies on
// the straight line between the gaps at both ends. So it is the latest time at which one of these lines meets
// 0, of three axes, the normals of both triangles at both ends, and the way from one to the other.
std::array<float, kLanes16> no_contact_before(const TriangleMesh& mesh, const Motion& motion,
                                              std::span<const TrianglePair> pairs);

}  // namespace cscd
