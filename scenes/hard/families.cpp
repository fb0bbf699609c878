#include <array>

#include "core/elementary/exact/exact.h"
#include "scenes/hard/rows.h"

namespace cscd::scenes::hard {

std::span<const Family> families() {
  static const std::array all = {kCoplanarSliding,  kParallel,  kThroughBorder, kGrazing,
                                 kIntervalEnds,     kNeedles,   kCollapsed,     kAtRest,
                                 kCommonMotion,     kFarAway,   kExtremeScale,  kCancelling,
                                 kFoldedNeighbours, kSymmetric, kSmallIntegers};
  return all;
}

bool in_contact(const Query& query, Kind kind) {
  return kind == Kind::vertex_face ? exact::first_contact(as_vertex_face(query)).has_value()
                                   : exact::first_contact(as_edge_edge(query)).has_value();
}

}  // namespace cscd::scenes::hard
