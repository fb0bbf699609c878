#include "scenes/shape/limb_weights.h"

#include <algorithm>

namespace cscd::scenes {
namespace {

using Shares = std::vector<double>;  // [bones]

void add_chain(const WeightChain& chain, double coordinate, double share, Shares& shares) {
  for (std::size_t i = 0; i < chain.bones.size(); ++i) {
    const double on = i + 1 < chain.bones.size() ? passed(chain.joints[i], coordinate) : 0;
    shares[+chain.bones[i]] += share * (1 - on);
    share *= on;
  }
}

}  // namespace

double passed(const WeightChain::Joint& joint, double coordinate) {
  const double t = std::clamp((coordinate - joint.at) / joint.width + 0.5, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

JointWeights limb_weights(const WeightPlace& place, const WeightChain& body,
                          std::span<const LimbChain> limbs) {
  std::size_t bones = body.bones.size();
  for (const LimbChain& limb : limbs) bones += limb.chain.bones.size();
  Shares shares(bones, 0.0);
  // If several limbs share a vertex, the share of a limb is the share that it would have alone, times a
  // factor for each other limb that tells how far this limb comes before the other. The sum of such
  // products is at most 1.
  double left = 1;
  for (const WeightPlace::OnLimb& on : place.limbs) {
    const LimbChain& limb = limbs[on.limb];
    double share = passed(limb.root, on.beyond);
    for (const WeightPlace::OnLimb& other : place.limbs)
      if (other.limb != on.limb)
        share *=
            passed({0, std::min(limb.root.width, limbs[other.limb].root.width)}, on.beyond - other.beyond);
    add_chain(limb.chain, on.arc, share, shares);
    left -= share;
  }
  add_chain(body, place.along_body, std::max(0.0, left), shares);

  std::vector<std::size_t> order;
  for (std::size_t bone = 0; bone < bones; ++bone)
    if (shares[bone] > 0) order.push_back(bone);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return shares[a] > shares[b]; });
  const double fifth = order.size() > JointWeights::most ? shares[order[JointWeights::most]] : 0;
  order.resize(std::min(order.size(), JointWeights::most));
  double kept = 0;
  for (const std::size_t bone : order) kept += shares[bone] - fifth;
  JointWeights weights;
  std::size_t used = 0;
  for (const std::size_t bone : order)
    if (shares[bone] > fifth) {
      weights.bone[used] = BoneId{static_cast<int>(bone)};
      weights.weight[used++] = (shares[bone] - fifth) / kept;
    }
  return weights;
}

}  // namespace cscd::scenes
