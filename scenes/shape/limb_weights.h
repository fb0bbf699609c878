#pragma once

#include <span>
#include <vector>

#include "scenes/shape/shape.h"

namespace cscd::scenes {

// Bones in a row, and at which coordinate along them weight passes from one to the next.
struct WeightChain {
  std::vector<BoneId> bones;
  struct Joint {
    double at, width;  // half the weight has passed at `at`, all within `width` about it
  };
  std::vector<Joint> joints;  // between bones i and i + 1
};

// Smooth from 0 to 1 across a joint.
double passed(const WeightChain::Joint& joint, double coordinate);

// A vertex before weights: where it is along the body, and along every limb that it can feel.
struct WeightPlace {
  double along_body;
  struct OnLimb {
    std::size_t limb;
    double beyond;  // the way along the surface from the limb's outline on the body; negative off the limb
    double arc;     // along the limb's centre line
  };
  std::vector<OnLimb> limbs;
};

// A limb's chain and the joint at which it takes weight from the body.
struct LimbChain {
  WeightChain chain;
  WeightChain::Joint root;  // along the way from the outline
};

// Body and limbs share the weight smoothly; of more than four bones the four strongest keep theirs, less what
// the fifth had, so that none appears suddenly.
JointWeights limb_weights(const WeightPlace& place, const WeightChain& body,
                          std::span<const LimbChain> limbs);

}  // namespace cscd::scenes
