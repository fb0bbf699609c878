#pragma once

#include "scenes/character/character.h"
#include "scenes/import/fbx/objects.h"

namespace cscd::scenes::fbx {

// How a layer of an animation acts on what the layers below it made of a value.
enum class BlendMode { replace, mix, ignore, refused };

struct Blending {
  BlendMode mode = BlendMode::replace;
  double weight = 1, keep = 1;  // mixed: keep * what is there + weight * the layer's value
  bool by_channel = false;      // rotations are added angle by angle
  bool scales_add = false;      // scalings are added, not multiplied
  std::string refusal;          // why the layer cannot be taken, where it cannot
};

// `weight` is in per cent, or nothing where it changes. Of the base layer nothing matters but its values.
Blending read_blending(const Object& layer, std::optional<double> weight, bool base);

enum class Combined { move, turn, scale, shape };

// Lets a layer's values act on what is there; `base` without keys stands still at its `rest`. Throws
// InputError for what no curves can express.
void combine(Components& base, const Components& layer, Combined kind, const Blending& blending);

}  // namespace cscd::scenes::fbx
