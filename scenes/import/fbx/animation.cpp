#include "scenes/import/fbx/animation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "scenes/import/fbx/curve.h"
#include "scenes/import/fbx/curve_sum.h"
#include "scenes/import/fbx/layers.h"

namespace cscd::scenes::fbx {
namespace {

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
    curves_.clear();
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
    check_extrapolation();
    return std::move(clip_);
  }

 private:
  void read_layer(const Object& layer, bool base) {
    const Blending blending = read_blending(layer, weight_of(layer), base);
    for (const Object* node : objects_.sources(layer, "AnimationCurveNode"))
      for (const Connection& connection : objects_.out_of(*node)) {
        if (connection.destination == nullptr || connection.property.empty()) continue;
        read_property(*node, *connection.destination, connection.property, blending);
      }
  }

  // Returns the layer's weight in per cent, or nullopt where it changes.
  std::optional<double> weight_of(const Object& layer) const {
    double weight = number(layer, "Weight", 100);
    for (const Connection& connection : objects_.into(layer)) {
      if (connection.property != "Weight" || connection.source->type != "AnimationCurveNode") continue;
      weight = number(*connection.source, "d|Weight", weight);
      for (const Connection& inner : objects_.into(*connection.source)) {
        if (inner.source->type != "AnimationCurve") continue;
        const Curve keys = read_curve(*inner.source, ticks_per_second_, limits_.keys).keys;
        if (!is_level(keys)) return std::nullopt;
        if (!keys.empty()) weight = keys.front().value;
      }
    }
    return weight;
  }

  void read_property(const Object& node, const Object& target, std::string_view property,
                     const Blending& blending) {
    if (weighs_shape(target, property)) {
      const std::string name = "d|" + std::string(property);
      const double rest = number(target, property, 0);
      const Components values = read_components(node, {name, "", ""}, Vec3(rest, 0, 0));
      Curve& curve = clip_.shapes[{&target, std::string(property)}];
      Components base;
      base.axis[0] = curve;
      base.rest[0] = rest;
      combine(base, values, Combined::shape, blending);
      curve = base.axis[0];
      return;
    }
    if (target.type != "Model") return;
    if (std::find(kStill.begin(), kStill.end(), property) != kStill.end()) {
      if (moves(node))
        throw InputError(told("node", target) + ": clip '" + clip_.name + "' animates its " +
                         std::string(property) + "; bake the transforms on export");
      return;
    }
    if (property == "Lcl Translation")
      read_motion(node, target, property, Vec3::Zero(), &Motion::moves, Combined::move, blending);
    if (property == "Lcl Rotation")
      read_motion(node, target, property, Vec3::Zero(), &Motion::turns, Combined::turn, blending);
    if (property == "Lcl Scaling")
      read_motion(node, target, property, Vec3::Ones(), &Motion::scales, Combined::scale, blending);
  }

  static bool weighs_shape(const Object& target, std::string_view property) {
    if (target.type == "Deformer") return property == "DeformPercent";
    if (target.type != "Geometry") return false;
    for (const Element& child : target.element->children)
      if (child.name == "Shape" && child.text(0) == property) return true;
    return false;
  }

  void read_motion(const Object& node, const Object& model, std::string_view property, const Vec3& otherwise,
                   Components Motion::*part, Combined kind, const Blending& blending) {
    const Vec3 rest = vector(model, property, otherwise);
    const Components values = read_components(node, {"d|X", "d|Y", "d|Z"}, rest);
    Components& base = clip_.models[&model].*part;
    if (base.empty()) base.rest = {rest.x(), rest.y(), rest.z()};
    if (kind == Combined::turn && integer(model, "QuaternionInterpolate", 0) != 0)
      require_dense(values, model);
    try {
      combine(base, values, kind, blending);
    } catch (const InputError& error) {
      throw InputError(told("node", model) + ", clip '" + clip_.name + "': " + error.what());
    }
  }

  // Reads the curves of a curve node. A component without a curve has the value that the curve node itself
  // gives, or else the value of the property.
  Components read_components(const Object& node, const std::array<std::string_view, 3>& names,
                             const Vec3& otherwise) {
    Components components;
    for (std::size_t k = 0; k < 3; ++k)
      components.rest[k] = number(node, names[k], otherwise[static_cast<int>(k)]);
    for (const Connection& connection : objects_.into(node)) {
      if (connection.source->type != "AnimationCurve") continue;
      for (std::size_t k = 0; k < 3; ++k)
        if (connection.property == names[k]) components.axis[k] = read_keys(*connection.source);
    }
    // A curve node without curves holds its values all the time.
    if (components.empty()) components.axis[0].push_back({0, components.rest[0]});
    return components;
  }

  Curve read_keys(const Object& curve) {
    ReadCurve read = read_curve(curve, ticks_per_second_, limits_.keys);
    keys_ += read.keys.size();
    if (keys_ > limits_.keys)
      throw InputError("has more than " + std::to_string(limits_.keys) + " animation keys; resample it");
    left_out_.keys += read.dropped;
    // A single key holds at all times, so it does not bear on the length.
    if (read.keys.size() > 1) {
      first_ = std::min(first_, read.keys.front().time);
      last_ = std::max(last_, read.keys.back().time);
    }
    if (!read.keys.empty() && (read.goes_on_before || read.goes_on_after))
      curves_.push_back({curve.id, read.goes_on_before ? read.keys.front().time : -1e300,
                         read.goes_on_after ? read.keys.back().time : 1e300});
    return read.keys;
  }

  bool moves(const Object& node) const {
    for (const Connection& connection : objects_.into(node)) {
      if (connection.source->type != "AnimationCurve") continue;
      const Curve keys = read_curve(*connection.source, ticks_per_second_, limits_.keys).keys;
      for (const Key<double>& key : keys)
        if (key.value != keys.front().value) return true;
    }
    return false;
  }

  // Joining angles one by one and joining quaternions differ visibly between rotations that are far apart,
  // so this refuses keys that are.
  void require_dense(const Components& values, const Object& model) const {
    constexpr double kWidest = 1.0 / 20;
    for (const Curve& curve : values.axis)
      for (std::size_t i = 0; i + 1 < curve.size(); ++i)
        if (curve[i + 1].time - curve[i].time > kWidest && curve[i + 1].value != curve[i].value)
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

  void check_extrapolation() const {
    for (const GoesOn& curve : curves_)
      if (clip_.start < curve.first || clip_.start + clip_.seconds > curve.last)
        throw InputError("clip '" + clip_.name + "', animation curve " + std::to_string(curve.id) +
                         ": goes on beyond its keys by repeating or rising; bake the animation on export");
  }

  // A curve whose value goes on changing before its first key or after its last key.
  struct GoesOn {
    std::int64_t id;
    double first, last;
  };

  const Objects& objects_;
  const CharacterLimits& limits_;
  LeftOut& left_out_;
  double ticks_per_second_;
  Clip clip_;
  double first_ = 0, last_ = 0;  // over all keys of the clip
  std::vector<GoesOn> curves_;
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
