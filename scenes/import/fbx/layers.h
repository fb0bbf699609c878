#pragma once

#include <utility>

#include "core/base/error.h"
#include "scenes/character/character.h"
#include "scenes/import/fbx/objects.h"

namespace cscd::scenes::fbx {

// How a layer of an animation acts on the value that the layers below it have made.
struct LayerRule {
  bool ignored = false;   // the layer's weight is 0
  bool replaces = false;  // the layer hides those below it
  LayerBlend blend = LayerBlend::add;
  bool turns_as_maps = false, scales_as_maps = false;
  int weight = -1;      // as in Layer
  std::string refusal;  // the error of a layer that cannot be used; empty where it can
};

// Reads the rule of a layer whose weight in per cent is `percent`, a curve with keys. A weight between 0 and
// 100 is added to `weights` as a share. The base layer is taken as it is.
LayerRule read_rule(const Object& layer, const Curve& percent, bool base, std::vector<Curve>& weights);

// Lets a layer's values act on those below. Throws InputError where the rule or the order of the layers does
// not allow it.
template <std::size_t Width>
void put_layer(Layered<Width>& below, Components<Width> values, bool as_maps, const LayerRule& rule) {
  if (!rule.refusal.empty()) throw InputError(rule.refusal);
  if (rule.ignored) return;
  if (rule.replaces)
    below = {std::move(values), {}};
  else
    below.above.push_back({std::move(values), rule.blend, as_maps, rule.weight});
}

}  // namespace cscd::scenes::fbx
