#pragma once

#include "scenes/character/character.h"
#include "scenes/import/fbx/objects.h"

namespace cscd::scenes::fbx {

// How a layer of an animation acts on the value that the layers below it have made.
enum class BlendMode { replace, mix, ignore, refused };

// The way in which one layer is blended with those below it.
struct Blending {
  BlendMode mode = BlendMode::replace;
  double weight = 1, keep = 1;  // mix: keep * value below + weight * value of the layer
  bool by_channel = false;      // rotations are added angle by angle
  bool scales_add = false;      // scalings are added instead of multiplied
  std::string refusal;          // the error of a layer that cannot be used
};

// Reads how a layer is blended. `weight` is in per cent, or nullopt where it changes. The base
// layer is taken as it is.
Blending read_blending(const Object& layer, std::optional<double> weight, bool base);

// The kinds of values that layers combine.
enum class Combined { move, turn, scale, shape };

// Lets a layer's values act on `base`. A `base` without keys stands still at its `rest`. Throws InputError
// for combinations that no curves can express.
void combine(Components& base, const Components& layer, Combined kind, const Blending& blending);

}  // namespace cscd::scenes::fbx
