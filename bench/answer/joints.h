#pragma once

#include <map>
#include <set>
#include <string>

#include "bench/answer/overlap_events.h"
#include "bench/inputs/input.h"
#include "bench/inputs/surface_names.h"

namespace cscd::bench {

// Knows what meets at the joints of a surface. Knees and elbows fold onto themselves in every clip, which is
// no fault of the clip.
class Joints {
 public:
  Joints() = default;  // no joints
  Joints(const Input& input, const SurfaceNames& names);

  // Whether two places meet at a joint: they are one bone, or two bones that a joint joins, as
  // --ignore-neighbours 1 takes them; of a surface without bones, two parts that share a vertex.
  bool join(const NamePair& both) const;
  // Whether the pieces of an event meet at a joint and lie in each other by less than kShare of the girth of
  // the thinner one. Where the depth is not known, its bound counts.
  bool fold(const OverlapEvent& event) const;

  static constexpr double kShare = 0.1;

 private:
  std::set<NamePair> joined_;            // in both orders
  std::map<std::string, double> girth_;  // at rest, of each place
};

}  // namespace cscd::bench
