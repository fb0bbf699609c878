#pragma once

#include "core/detect/contact.h"
#include "core/detect/detector.h"

// For callers who want the earliest contact and no others, such as a response that cuts the step there.
namespace cscd {

// From the next interval on, pairs that cannot touch before the earliest contact found so far are not tested.
// Which contacts are reported beside those of the earliest time is then left to chance: `keep_first` drops
// them. What the strategy promises of the earliest time stays, provided that the elementary test is right in
// both its answers. False for a detector that `compose` did not make: it goes on finding all.
bool look_for_first_only(Detector& detector);

// Leaves the contacts of the earliest time, and what is undecided. Takes a sorted set.
void keep_first(ContactSet& sorted);

// A time before which the features of a pair certainly do not touch, from the coplanarity cubic: its graph on
// [0, 1] lies in the hull of its Bernstein coefficients, so no root comes before the hull meets the axis. 0
// where nothing is known, more than 1 where they never touch.
double no_contact_before(const TriangleMesh& mesh, const Motion& motion, const FeaturePair& pair);

}  // namespace cscd
