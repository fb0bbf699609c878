#include "scenes/import/fbx/layers.h"

#include "core/base/error.h"
#include "scenes/import/fbx/curve_sum.h"

namespace cscd::scenes::fbx {
namespace {

constexpr double kWhole = 0.99999;  // weights from here on count as 1
constexpr char kBake[] = "; bake the animation to one layer on export";

Curve curve_of(const Components& components, std::size_t axis) {
  if (!components.axis[axis].empty()) return components.axis[axis];
  return {{0, components.rest[axis]}};
}

// Rotations about a single axis commute, so their angles add up.
bool turn_about_one_axis(const Components& a, const Components& b) {
  int axes = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Curve p = curve_of(a, k), q = curve_of(b, k);
    axes += !(is_level(p) && p.front().value == 0 && is_level(q) && q.front().value == 0);
  }
  return axes <= 1;
}

bool is_still(const Components& components, double value) {
  for (std::size_t k = 0; k < 3; ++k)
    if (const Curve curve = curve_of(components, k); !is_level(curve) || curve.front().value != value)
      return false;
  return true;
}

void mix(Components& base, const Components& layer, const Blending& blending) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::optional<Curve> both =
        sum(scaled(curve_of(base, k), blending.keep, 0), scaled(curve_of(layer, k), blending.weight, 0));
    if (!both) throw InputError(std::string("a layer is added to keys that hold their values") + kBake);
    base.axis[k] = *both;
    base.rest[k] = blending.keep * base.rest[k] + blending.weight * layer.rest[k];
  }
}

void multiply(Components& base, const Components& layer) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Curve a = curve_of(base, k), b = curve_of(layer, k);
    if (!is_level(a) && !is_level(b))
      throw InputError(std::string("two layers multiply scalings that both change") + kBake);
    base.axis[k] = is_level(b) ? scaled(a, b.front().value, 0) : scaled(b, a.front().value, 0);
    base.rest[k] *= layer.rest[k];
  }
}

}  // namespace

Blending read_blending(const Object& layer, std::optional<double> percent, bool base) {
  Blending blending;
  if (base) return blending;
  constexpr std::int64_t kAdditive = 0, kOverride = 1, kPassThrough = 2;
  const std::int64_t mode = integer(layer, "BlendMode", kAdditive);
  const double weight = percent.value_or(100) / 100;
  blending.weight = weight >= kWhole ? 1 : weight;
  blending.keep = mode == kAdditive ? 1 : 1 - blending.weight;
  blending.by_channel = integer(layer, "RotationAccumulationMode", 0) != 0;
  blending.scales_add = integer(layer, "ScaleAccumulationMode", 0) != 0;
  const auto refuse = [&](const std::string& why) {
    blending.mode = BlendMode::refused;
    blending.refusal = "layer '" + layer.name + "' " + why + kBake;
    return blending;
  };
  if (!percent) return refuse("has a weight that changes");
  if (mode != kAdditive && mode != kOverride && mode != kPassThrough)
    return refuse("has an unknown blend mode");
  if (!(weight >= 0)) return refuse("has no weight between 0 and 100");
  if (mode != kAdditive && blending.weight == 1) return blending;  // mode stays `replace`
  if (mode == kOverride) return refuse("overrides with a weight below 100");
  blending.mode = blending.weight == 0 ? BlendMode::ignore : BlendMode::mix;
  return blending;
}

void combine(Components& base, const Components& layer, Combined kind, const Blending& blending) {
  if (blending.mode == BlendMode::refused) throw InputError(blending.refusal);
  if (blending.mode == BlendMode::ignore) return;
  if (blending.mode == BlendMode::replace) {
    base = layer;
    return;
  }
  const bool whole = blending.weight == 1 && blending.keep == 1;
  if (kind == Combined::scale && !blending.scales_add) {
    if (!whole) throw InputError(std::string("a layer multiplies scalings with a weight below 100") + kBake);
    return multiply(base, layer);
  }
  // In the accumulation mode "by layer", the SDK applies one rotation after the other. Their angles add up
  // only where one rotation is zero or both are about the same axis.
  if (kind == Combined::turn && !blending.by_channel) {
    const bool one = is_still(base, 0) || is_still(layer, 0) || turn_about_one_axis(base, layer);
    if (!one || !whole)
      throw InputError(
          std::string("two layers of rotations are combined by layer, about several axes or with "
                      "a weight below 100") +
          kBake);
  }
  mix(base, layer, blending);
}

}  // namespace cscd::scenes::fbx
