#include "scenes/import/fbx/animation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "scenes/character/character.h"
#include "scenes/import/fbx/curve.h"
#include "scenes/import/fbx/objects.h"

namespace cscd::scenes::fbx {
namespace {

// How a layer of an animation acts on the value that the layers below it have made.
struct LayerRule {
  bool ignored = false;   // the layer's weight is 0
  bool replaces = false;  // the layer hides those below it
  LayerBlend blend = LayerBlend::add;
  bool turns_as_maps = false, scales_as_maps = false;
  int weight = -1;      // as in Layer
  std::string refusal;  // the error of a layer that cannot be used; empty where it can
};

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

constexpr double kWhole = 0.99999;  // weights from here on count as 1
// The bits of BlendModeBypass for the types of the properties that matter here: single numbers and vectors of
// three. MotionBuilder always sets the bits for switches and enumerations.
constexpr std::int64_t kNumbers = 1 << 11 | 1 << 12 | 1 << 14;

// Reads the rule of a layer whose weight in per cent is `percent`, a curve with keys. A weight between 0 and
// 100 is added to `weights` as a share. The base layer is taken as it is.
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

// The SDK writes times beyond this for "no limit".
constexpr double kMostTicks = 4e18;

// Properties that place a node and that this reader takes to stand still.
constexpr std::array<std::string_view, 13> kStill = {
    "RotationPivot", "ScalingPivot",      "RotationOffset",           "ScalingOffset",    "PreRotation",
    "PostRotation",  "GeometricRotation", "GeometricTranslation",     "GeometricScaling", "InheritType",
    "RotationOrder", "RotationActive",    "RotationSpaceForLimitOnly"};

class ClipReader {
 public:
  ClipReader(const Objects& objects, const CharacterLimits& limits, LeftOut& left_out)
      : objects_(objects),
        limits_(limits),
        left_out_(left_out),
        ticks_per_second_(objects.ticks_per_second()) {}

  Clip read(const Object& stack) {
    clip_ = {};
    clip_.name = stack.name;
    first_ = std::numeric_limits<double>::infinity();
    last_ = -first_;
    const std::vector<const Object*> layers = objects_.sources(stack, "AnimationLayer");
    const bool solo = std::any_of(layers.begin(), layers.end(),
                                  [](const Object* layer) { return integer(*layer, "Solo", 0) != 0; });
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const Object& layer = *layers[i];
      if (integer(layer, "Mute", 0) != 0 || (solo && integer(layer, "Solo", 0) == 0))
        ++left_out_.layers;
      else
        read_layer(layer, i == 0);
    }
    set_range(stack);
    return std::move(clip_);
  }

 private:
  void read_layer(const Object& layer, bool base) {
    const LayerRule rule = read_rule(layer, weight_of(layer), base, clip_.layer_weights);
    for (const Object* node : objects_.sources(layer, "AnimationCurveNode"))
      for (const Connection& connection : objects_.out_of(*node)) {
        if (connection.destination == nullptr || connection.property.empty()) continue;
        read_property(*node, *connection.destination, connection.property, rule);
      }
  }

  // Returns the layer's weight in per cent.
  Curve weight_of(const Object& layer) {
    double weight = number(layer, "Weight", 100);
    for (const Connection& connection : objects_.into(layer)) {
      if (connection.property != "Weight" || connection.source->type != "AnimationCurveNode") continue;
      weight = number(*connection.source, "d|Weight", weight);
      for (const Connection& inner : objects_.into(*connection.source)) {
        if (inner.source->type != "AnimationCurve") continue;
        Curve curve = read_keys(*inner.source, told("layer", layer) + ", its weight").curve;
        if (!curve.empty()) return curve;
      }
    }
    return {{{0, weight}}};
  }

  void read_property(const Object& node, const Object& target, std::string_view property,
                     const LayerRule& rule) {
    if (weighs_shape(target, property)) {
      const std::string name = "d|" + std::string(property);
      const double rest = number(target, property, 0);
      Layered<1>& driven = clip_.shapes[{&target, std::string(property)}];
      if (driven.empty()) driven.base.rest = {rest};
      const std::string of = told("blend shape", target) + ", " + std::string(property);
      put_layer(driven, read_components<1>(node, {name}, {rest}, of), false, rule);
      return;
    }
    if (target.type != "Model") return;
    if (std::find(kStill.begin(), kStill.end(), property) != kStill.end()) {
      if (moves(node, told("node", target) + ", " + std::string(property)))
        throw InputError(told("node", target) + ": clip '" + clip_.name + "' animates its " +
                         std::string(property) + "; bake the transforms on export");
      return;
    }
    if (property == "Lcl Translation")
      read_motion(node, target, property, Vec3::Zero(), &Motion::moves, false, rule);
    if (property == "Lcl Rotation")
      read_motion(node, target, property, Vec3::Zero(), &Motion::turns, rule.turns_as_maps, rule);
    if (property == "Lcl Scaling")
      read_motion(node, target, property, Vec3::Ones(), &Motion::scales, rule.scales_as_maps, rule);
  }

  static bool weighs_shape(const Object& target, std::string_view property) {
    if (target.type == "Deformer") return property == "DeformPercent";
    if (target.type != "Geometry") return false;
    for (const Element& child : target.element->children)
      if (child.name == "Shape" && child.text(0) == property) return true;
    return false;
  }

  void read_motion(const Object& node, const Object& model, std::string_view property, const Vec3& otherwise,
                   Layered<3> Motion::*part, bool as_maps, const LayerRule& rule) {
    const Vec3 rest = vector(model, property, otherwise);
    Components<3> values = read_components<3>(node, {"d|X", "d|Y", "d|Z"}, {rest.x(), rest.y(), rest.z()},
                                              told("node", model) + ", " + std::string(property));
    Layered<3>& below = clip_.models[&model].*part;
    if (below.empty()) below.base.rest = {rest.x(), rest.y(), rest.z()};
    const bool turns = part == &Motion::turns;
    if (turns && integer(model, "QuaternionInterpolate", 0) != 0) require_dense(values, model);
    try {
      put_layer(below, std::move(values), as_maps, rule);
      if (turns) require_order(below, integer(model, "RotationOrder", 0) == 0);
    } catch (const InputError& error) {
      throw InputError(told("node", model) + ", clip '" + clip_.name + "': " + error.what());
    }
  }

  // Refuses layers of rotations whose result is not determined. A rotation has many sets of angles, and
  // which of them a layer by channel finds above a layer that combines rotations as maps is not known. Where
  // such a layer overrides with a weight, in an order other than XYZ, Maya and ufbx do not agree on the
  // rotation; where it adds, they do.
  static void require_order(const Layered<3>& turns, bool xyz) {
    bool as_maps = false, mixes = false;
    for (const Layer<3>& layer : turns.above) {
      if (as_maps && !layer.as_maps)
        throw InputError(
            "a layer adds angles by channel above a layer whose rotations are combined by layer; bake the "
            "animation to one layer on export");
      as_maps |= layer.as_maps;
      mixes |= layer.as_maps && layer.blend == LayerBlend::mix;
    }
    if (mixes && !xyz && axes_of(turns) > 1)
      throw InputError(
          "a layer overrides rotations with a weight and by layer, in an order of axes other than XYZ; bake "
          "the animation to one layer on export");
  }

  // Returns the number of axes about which the layers turn. Rotations about a single axis commute.
  static int axes_of(const Layered<3>& turns) {
    int axes = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto turns_about = [k](const Components<3>& components) {
        const Curve& curve = components.axis[k];
        return curve.empty() ? components.rest[k] != 0 : !is_level(curve) || curve.keys.front().value != 0;
      };
      axes += turns_about(turns.base) ||
              std::any_of(turns.above.begin(), turns.above.end(),
                          [&](const Layer<3>& layer) { return turns_about(layer.values); });
    }
    return axes;
  }

  // Reads the curves of a curve node. A component without a curve has the value that the curve node itself
  // gives, or else the value of the property. `of` names the property in errors.
  template <std::size_t Width>
  Components<Width> read_components(const Object& node, const std::array<std::string_view, Width>& names,
                                    const std::array<double, Width>& otherwise, const std::string& of) {
    Components<Width> components;
    for (std::size_t k = 0; k < Width; ++k) components.rest[k] = number(node, names[k], otherwise[k]);
    for (const Connection& connection : objects_.into(node)) {
      if (connection.source->type != "AnimationCurve") continue;
      for (std::size_t k = 0; k < Width; ++k)
        if (connection.property == names[k]) {
          components.axis[k] =
              read_keys(*connection.source, of + " (" + std::string(names[k].substr(2)) + ")").curve;
          note_range(components.axis[k]);
        }
    }
    // A curve node without curves holds its values all the time.
    if (components.empty()) components.axis[0].keys.push_back({0, components.rest[0]});
    return components;
  }

  ReadCurve read_keys(const Object& curve, const std::string& of) {
    ReadCurve read = named_curve(curve, of);
    keys_ += read.curve.keys.size();
    if (keys_ > limits_.keys)
      throw InputError("has more than " + std::to_string(limits_.keys) + " animation keys; resample it");
    left_out_.keys += read.dropped;
    left_out_.ends += read.unknown_ends;
    return read;
  }

  ReadCurve named_curve(const Object& curve, const std::string& of) const {
    try {
      return read_curve(curve, ticks_per_second_, limits_.keys);
    } catch (const InputError& error) {
      throw InputError("clip '" + clip_.name + "', " + of + ": " + error.what());
    }
  }

  // A single key holds at all times, so it does not bear on the clip's length.
  void note_range(const Curve& curve) {
    if (curve.keys.size() < 2) return;
    first_ = std::min(first_, curve.keys.front().time);
    last_ = std::max(last_, curve.keys.back().time);
  }

  bool moves(const Object& node, const std::string& of) const {
    for (const Connection& connection : objects_.into(node)) {
      if (connection.source->type != "AnimationCurve") continue;
      const auto keys = named_curve(*connection.source, of).curve.keys;
      for (const Key<double>& key : keys)
        if (key.value != keys.front().value) return true;
    }
    return false;
  }

  // Joining angles one by one and joining quaternions differ visibly between rotations that are far apart,
  // so this refuses keys that are.
  void require_dense(const Components<3>& values, const Object& model) const {
    constexpr double kWidest = 1.0 / 20;
    for (const Curve& curve : values.axis)
      for (std::size_t i = 0; i + 1 < curve.keys.size(); ++i)
        if (curve.keys[i + 1].time - curve.keys[i].time > kWidest &&
            curve.keys[i + 1].value != curve.keys[i].value)
          throw InputError(told("node", model) + ", clip '" + clip_.name +
                           "': its rotation keys are joined as quaternions; bake the animation on export");
  }

  // Sets the clip's range: from LocalStart to LocalStop where the stack gives them, or else over all keys.
  void set_range(const Object& stack) {
    const double start = number(stack, "LocalStart", 0), stop = number(stack, "LocalStop", 0);
    if (stop > start && std::abs(start) < kMostTicks && std::abs(stop) < kMostTicks) {
      clip_.start = start / ticks_per_second_;
      clip_.seconds = (stop - start) / ticks_per_second_;
    } else if (first_ <= last_) {
      clip_.start = first_;
      clip_.seconds = last_ - first_;
    }
  }

  const Objects& objects_;
  const CharacterLimits& limits_;
  LeftOut& left_out_;
  double ticks_per_second_;
  Clip clip_;
  double first_ = 0, last_ = 0;  // over all keys of the clip
  std::size_t keys_ = 0;
};

}  // namespace

std::vector<Clip> read_clips(const Objects& objects, const CharacterLimits& limits, LeftOut& left_out) {
  ClipReader reader(objects, limits, left_out);
  std::vector<Clip> clips;
  for (const Object* stack : objects.all("AnimationStack")) {
    if (clips.size() >= limits.animations)
      throw InputError("has more than " + std::to_string(limits.animations) + " clips; export fewer");
    clips.push_back(reader.read(*stack));
  }
  return clips;
}

}  // namespace cscd::scenes::fbx
