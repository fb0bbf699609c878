#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/ids.h"
#include "core/detect/thickness.h"
#include "core/mesh/motion.h"
#include "core/mesh/rig.h"

namespace cscd {

// Two different triangles of one mesh, the smaller index first.
using CrossingPair = std::pair<TriangleId, TriangleId>;

// The triangle pairs that cross in one pose. Two triangles *cross* if they meet outside the vertices and
// edges that they share.
struct Crossings {
  std::vector<CrossingPair> pairs;  // sorted; incomplete if more pairs cross than the caller wanted to keep
  std::size_t total = 0;            // number of all pairs that cross

  bool all_kept() const { return pairs.size() == total; }
  bool contains(const CrossingPair& pair) const { return std::ranges::binary_search(pairs, pair); }
};

// One interval as a detector is asked about it: the motion, what the caller knows of its start, and what the
// caller wants to know of its start.
struct Step {
  Motion motion;                         // all positions are finite
  const Rig::Interval* bones = nullptr;  // the skeleton at both ends; null for a mesh without a rig
  // Whether the caller knows that the start is embedded (rule embedded-start, core/soundness.md), and with a
  // thickness, that it is clear: embedded, and no pair close. A complete strategy may then take less time,
  // and finds the same contacts.
  bool starts_embedded = false;
  // Takes the triangle pairs that cross at the start, at most `most_crossings` of them; null where they are
  // not wanted. The detector tests the pairs that its culling passes on, exactly, in the pose of the start.
  // Only strategies that promise it (Strategy::sees_start) may be asked.
  Crossings* crossings = nullptr;
  std::size_t most_crossings = 0;
  // How near features may come before they count as contacts. Above 0, only cullers that know distances
  // (Culler::knows_distance) and an elementary test that does may be asked.
  Thickness thickness = {};
  // Whether the caller wants to know no more than whether anything touches. A detector may then stop at any
  // contact.
  bool any_contact = false;
  // Whether the caller wants to know no more than the earliest time, to a share of 2^-42. A detector of the
  // first contact may then leave out contacts that are not earlier than others by more, and may stop at a
  // contact at t = 0.
  bool time_alone = false;
};

}  // namespace cscd
