#pragma once

#include <string>
#include <vector>

#include "scenes/character/character.h"
#include "scenes/character/pose.h"
#include "scenes/motion/ball.h"
#include "scenes/motion/key_jets.h"

namespace cscd::scenes {

MovingTransform fixed(const Transform& map);

// Encloses the pose of a character (pose_at, weights_at) over spans of time of one of its animations, exactly
// as its formulas say, before any rounding. A derivative is that at the times at which there is one.
class PoseJets {
 public:
  // Both must outlive the object.
  PoseJets(const Character& character, const Animation& animation);

  // What of the animation has no bounds here, in words; empty where all of it has.
  std::string refused() const;
  // Sorted: when some value turns a corner, and when some value jumps.
  const std::vector<double>& corners() const { return corners_; }
  const std::vector<double>& jumps() const { return jumps_; }

  // [nodes]: from a node's coordinates to the world's, over a span and in its middle. Throws Unbounded. A
  // jump in the span, its start excepted, has to be cut out by the caller.
  struct Nodes {
    std::vector<MovingTransform> over, middle;
    double half;  // seconds from the middle to the farther end
  };
  Nodes nodes(const Span& span) const;

  // [parts][targets]. A weight whose response has a knot within its range has corners at unknown times.
  struct Weights {
    std::vector<std::vector<Jet>> of_part;
    bool corners_anywhere = false;
  };
  Weights weights(const Span& span) const;

 private:
  struct Driven {
    const Channel* channel;
    ScaleTurnMove rest;
    std::vector<double> breaks;  // sorted
  };
  struct ScaleAndMove {
    JetVector scale, move;
  };
  friend ScaleAndMove hull(const ScaleAndMove& a, const ScaleAndMove& b) {
    return {hull(a.scale, b.scale), hull(a.move, b.move)};
  }
  std::vector<MovingTransform> locals(const Span& span) const;
  static ScaleAndMove beside_rotation(const Driven& driven, const Span& span);
  static MovingMatrix rotation_of(const Driven& driven, const Span& span);

  const Character& character_;
  const Animation& animation_;
  std::vector<Driven> driven_;
  std::vector<double> corners_, jumps_;
};

}  // namespace cscd::scenes
