#pragma once

#include <span>
#include <vector>

#include "scenes/character/character.h"
#include "scenes/motion/ball.h"

namespace cscd::scenes {

// Linear skinning without morph targets. A vertex is a mean of the points that its joints make of it, so it
// leaves its line by no more than the same mean of what they do, and a few numbers for each joint bound what
// the joint does to all its points. That costs a few products for each vertex; enclosing the vertices one by
// one (SkinJets) costs twenty times as much.
class LinearSkin {
 public:
  explicit LinearSkin(const Part& part);

  // Where a joint takes its points at one moment.
  struct JointPlace {
    Eigen::Matrix3d linear;
    Vec3 origin;
    double error;  // of the place of any of its points
  };
  // [joints]. `pose` is that of one moment, [nodes]. Throws Unbounded.
  std::vector<JointPlace> joint_places(const std::vector<MovingTransform>& pose) const;
  // Returns how far the place may be from the true one.
  double place(std::size_t v, std::span<const JointPlace> joint_places, Vec3& at) const;

  // Bounds a number of each point of a joint: at the centre of all its points, and so much more for each unit
  // of distance from there.
  struct AffineBound {
    double at_centre = 0, per_distance = 0;
  };
  // How the joints move their points over a span of time without corners.
  struct JointMotions {
    struct Joint {
      BallVector rate;         // at the centre
      BallMatrix rate_around;  // what points have beside it, for each unit of distance
      AffineBound bend;
    };
    std::vector<Joint> joints;
    double bend = 0,
           uncertainty = 0;  // the largest bound on a bend of any point, and how much of one is uncertainty
  };
  // Throws Unbounded.
  JointMotions motions(const std::vector<MovingTransform>& pose) const;
  // Bounds how far rates of one span are from those of the next, [joints].
  std::vector<AffineBound> rate_changes(const JointMotions& before, const JointMotions& after) const;
  // How far the vertex leaves its line where the joints' points leave theirs as is told, [joints].
  double deviation(std::size_t v, std::span<const AffineBound> of_joints) const;
  // The same for any vertex.
  double largest_deviation(std::span<const AffineBound> of_joints) const;

 private:
  struct Influence {
    std::size_t joint;
    double weight;
    Vec3 point;       // in the joint's coordinates
    double distance;  // from the centre of the joint's points, rounded up
  };
  // The points of a joint; the joint after the last one is the part's own node, and takes what has no joint.
  struct Cloud {
    std::size_t node;
    bool used = false;
    Vec3 centre = Vec3::Zero();
    double radius = 0, length = 0;  // largest distances from the centre and from the joint's origin
    double error = 0;               // of any point
  };
  std::span<const Influence> of(std::size_t v) const {
    return std::span(influences_).subspan(first_[v], first_[v + 1] - first_[v]);
  }

  std::vector<std::size_t> first_;  // [vertices + 1]
  std::vector<Influence> influences_;
  std::vector<Cloud> clouds_;  // [joints + 1]
  std::size_t most_ = 1;       // influences of a vertex
};

}  // namespace cscd::scenes
