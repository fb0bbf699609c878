#pragma once

#include <span>
#include <vector>

#include "scenes/shape/shape.h"

namespace cscd::scenes {

// Bones in a row, and the coordinates along the row at which weight passes from one bone to the next.
struct WeightChain {
  std::vector<BoneId> bones;
  struct Joint {
    double at, width;  // half the weight has passed at `at`; all of it passes within `width` about `at`
  };
  std::vector<Joint> joints;  // joint i is between bones i and i + 1
};

// The share of the weight that has passed a joint at a coordinate. It rises smoothly from 0 to 1.
double passed(const WeightChain::Joint& joint, double coordinate);

// The place of a vertex, from which its weights are made: its place along the body, and along every limb
// whose bones can move the vertex.
struct WeightPlace {
  double along_body;
  struct OnLimb {
    std::size_t limb;
    double beyond;  // the way along the surface from the limb's outline on the body; negative off the limb
    double arc;     // the arc length along the limb's centre line
  };
  std::vector<OnLimb> limbs;
};

// A limb's chain and the joint at which it takes weight from the body.
struct LimbChain {
  WeightChain chain;
  WeightChain::Joint root;  // its coordinate is the way from the outline
};

// The weights of a vertex. The body and the limbs share them smoothly. If more than four bones have a
// share, the four strongest keep their shares, less the share of the fifth, so that no bone appears
// suddenly.
JointWeights limb_weights(const WeightPlace& place, const WeightChain& body,
                          std::span<const LimbChain> limbs);

}  // namespace cscd::scenes
