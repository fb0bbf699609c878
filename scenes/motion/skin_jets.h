#pragma once

#include <vector>

#include "scenes/character/character.h"
#include "scenes/motion/pose_jets.h"

namespace cscd::scenes {

// The vertices of a part in the coordinates of their joints, [influences]. Seen from its joint a vertex is
// near, so that what is uncertain of the joint's map matters little.
std::vector<BallVector> points_in_joints(const Part& part);

// Encloses where a part's vertices are over a span of time (skin in scenes/character/pose.h). LinearSkin is
// the faster way for vertices that neither morph nor follow dual quaternions.
class SkinJets {
 public:
  // `points` are those of points_in_joints, and `weights` are those of the part's targets. All arguments but
  // `weights` must outlive the object. Throws Unbounded.
  SkinJets(const Part& part, const std::vector<BallVector>& points, const PoseJets::Nodes& pose,
           std::vector<Jet> weights);

  // Throws Unbounded, also where dual quaternions of a vertex's bones turn away from each other by half a
  // turn, so that their blend may jump.
  MovingVector vertex(std::size_t v) const;

 private:
  // What a joint's map is made of: a scaling along the axes of the part, and a rotation.
  struct Rigid {
    MovingQuaternion turn;
    MovingMatrix axes;
    JetVector scale, shear;
  };
  MovingVector point(std::size_t v) const;
  MovingVector taken_by(int node, const MovingVector& at) const;
  MovingVector taken_by_influence(std::size_t influence, const MovingVector& at) const;
  MovingVector by_dual_quaternions(std::size_t v, const MovingVector& at) const;

  const Part& part_;
  const std::vector<BallVector>& points_;
  const std::vector<MovingTransform>& pose_;
  std::vector<Norms> norms_;  // [nodes], of those that move the part
  std::vector<Jet> weights_;
  std::vector<Rigid> rigid_;  // [joints], where some vertex follows dual quaternions
  bool morphs_ = false;       // some weight is not zero throughout
};

}  // namespace cscd::scenes
