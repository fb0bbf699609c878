#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/base/memory.h"
#include "core/detect/contact.h"
#include "core/detect/thickness.h"
#include "core/mesh/motion.h"

namespace cscd {

// How far each vertex of a pose may move, in any direction and along any path, so that no feature pair comes
// closer than its thickness, however all other vertices move within their bounds.
//
// Each pair of features A and B has a fixed unit vector n along which A lies above B. Let h(v) = n·v be the
// height of a vertex in the pose, b(v) its bound, and r the thickness of the pair. If
//
//   min over A of (h(v) - b(v))  -  max over B of (h(v) + b(v))  >  r,
//
// the pair stays farther than r apart: no vertex falls or rises by more than its bound, and the points of a
// feature are means of its vertices. This holds for every n; that of the nearest points leaves the most room.
// The plane half-way between A and B gives each side half of the room, and a vertex that is farther from the
// plane gets its own distance from it. Then one vertex after another, in the order of their indices, gets
// what room its neighbours have not used. In the end no bound can grow by itself, except that a pair is held
// against its one n.
class VertexBounds {
 public:
  // `caps` holds the largest bound of each vertex. Vertices behind them move as the caller says, and have no
  // bounds.
  explicit VertexBounds(std::vector<double> caps) : movable_(caps.size()), caps_(std::move(caps)) {}

  // Takes pairs of features of one mesh, in the pose in which `motion` starts. At the end of the motion are
  // vertices from `movable` on, which move no farther than that in any direction; the ends of others are not
  // looked at. Pairs that stay apart even if all their vertices move as far as their caps are not kept.
  void add(const TriangleMesh& mesh, const Motion& motion, std::span<const FeaturePair> pairs,
           const Thickness& thickness);
  // Returns the bounds, [movable], for pairs that were added. Pairs that were not must be farther apart than
  // their thickness and the largest cap of either feature; a feature that has no bounds counts with what it
  // moves. A pair that is not certainly farther apart than its thickness in the pose
  // gives its vertices the bound 0.
  std::vector<double> find() const;
  // Returns for each vertex, [movable], a number that its bound would not exceed if caps were larger, but for
  // `cap`, which it is where no pair says less.
  std::vector<double> find_most(double cap) const;

 private:
  struct Pair {
    std::array<std::size_t, 4> vertex;
    std::array<double, 4> height;  // of A's vertices, then of B's, in the negative for these
    std::array<double, 4> moved;   // by vertices that have no bounds; 0 for others
    std::size_t split;             // the number of A's vertices
    double least;                  // thickness and rounding
    bool apart;                    // certainly farther than the thickness
  };
  bool has_bounds(const Pair& pair, std::size_t i) const { return pair.vertex[i] < movable_; }
  // The lowest that the vertices of one side come.
  double lowest(const Pair& pair, bool first, std::span<const double> bounds) const;
  std::vector<double> halves() const;

  std::size_t movable_;
  std::vector<double> caps_;  // [movable]
  std::vector<Pair> pairs_;
  MemoryWatch memory_;
};

}  // namespace cscd
