#include "scenes/import/fbx/layers.h"

#include <algorithm>
#include <cmath>

#include "scenes/import/fbx/curve.h"

namespace cscd::scenes::fbx {
namespace {

constexpr double kWhole = 0.99999;  // weights from here on count as 1
// The bits of BlendModeBypass for the types of the properties that matter here: single numbers and vectors of
// three. MotionBuilder always sets the bits for switches and enumerations.
constexpr std::int64_t kNumbers = 1 << 11 | 1 << 12 | 1 << 14;

}  // namespace

LayerRule read_rule(const Object& layer, const Curve& percent, bool base, std::vector<Curve>& weights) {
  LayerRule rule;
  constexpr std::int64_t kAdditive = 0, kOverride = 1, kPassThrough = 2;
  const std::int64_t mode = integer(layer, "BlendMode", kAdditive);
  // The weight of a layer that overrides has no effect: that is what tells it from one that passes through.
  rule.replaces = base || mode == kOverride;
  if (base) return rule;
  rule.blend = mode == kAdditive ? LayerBlend::add : LayerBlend::mix;
  rule.turns_as_maps = integer(layer, "RotationAccumulationMode", 0) == 0;
  rule.scales_as_maps = integer(layer, "ScaleAccumulationMode", 0) == 0;
  const auto refuse = [&](const std::string& why) {
    rule.refusal = "layer '" + layer.name + "' " + why + "; bake the animation to one layer on export";
    return rule;
  };
  if (mode != kAdditive && mode != kOverride && mode != kPassThrough)
    return refuse("has an unknown blend mode");
  if ((integer(layer, "BlendModeBypass", 0) & kNumbers) != 0)
    return refuse("does not apply its blend mode to numbers");
  Curve share = scaled(percent, 0.01, 0);
  if (!std::all_of(share.keys.begin(), share.keys.end(),
                   [](const Key<double>& key) { return std::isfinite(key.value); }))
    return refuse("has a weight that is no number");
  if (rule.replaces) return rule;
  if (!is_level(share)) {
    rule.weight = static_cast<int>(weights.size());
    weights.push_back(std::move(share));
    return rule;
  }
  const double weight = share.keys.front().value;
  rule.ignored = weight <= 0;
  rule.replaces = weight >= kWhole && rule.blend == LayerBlend::mix;
  if (weight >= kWhole || rule.ignored) return rule;
  rule.weight = static_cast<int>(weights.size());
  weights.push_back({{share.keys.front()}});
  return rule;
}

}  // namespace cscd::scenes::fbx
