#pragma once

#include <optional>
#include <vector>

#include "scenes/character/character.h"
#include "scenes/motion/ball.h"

// The values of an animation over a span of time, as sample.h gives them at one moment. A span lies between
// two neighbouring keys of what is asked for, or is one moment: `from` <= `to`.
namespace cscd::scenes {

struct Span {
  double from, to;  // seconds
};

// The rotation as a matrix of three columns. The signs of quaternions may change from key to key.
using JetRotation = std::array<JetVector, 3>;
// A quaternion as w, x, y, z.
using JetQuaternion = std::array<Jet, 4>;

JetVector jets_of(const std::vector<Key<Vec3>>& keys, const Span& span);
JetRotation jets_of(const std::vector<Key<Quaternion>>& keys, const Span& span);
// The rotation where that turns at a constant speed or stays, which is cheaper and tighter than boxes of its
// numbers; nothing where it does neither.
std::optional<MovingMatrix> turning_of(const std::vector<Key<Quaternion>>& keys, const Span& span);
Jet jets_of(const Curve& curve, const Span& span);
JetVector jets_of(const Layered<3>& layered, const Span& span);
Jet jets_of(const Layered<1>& layered, const Span& span);
JetRotation jets_of(const EulerAngles& angles, const Span& span);

JetRotation columns_of(const JetQuaternion& unit);
JetQuaternion unit_of(const JetQuaternion& q);

// The times at which a value may jump or turn a corner: those of its keys, in any order.
struct Breaks {
  std::vector<double> corners;  // the value is continuous there
  std::vector<double> jumps;    // the value may be another from that time on
};
void add_breaks(const std::vector<Key<Vec3>>& keys, Breaks& out);
void add_breaks(const std::vector<Key<Quaternion>>& keys, Breaks& out);
void add_breaks(const Curve& curve, Breaks& out);

// What of an animation has no bounds here, such as curves that repeat beyond their keys within the clip;
// empty where nothing has none.
const char* without_bounds(const Curve& curve, const Span& clip);
template <std::size_t Width>
const char* without_bounds(const Layered<Width>& layered, const Span& clip) {
  for (const Layer<Width>& layer : layered.above) {
    if (layer.weight >= 0) return "layers of animation with a weight";
    if (layer.as_maps) return "layers of animation that are combined as maps";
    for (const Curve& curve : layer.values.axis)
      if (const char* why = without_bounds(curve, clip)) return why;
  }
  for (const Curve& curve : layered.base.axis)
    if (const char* why = without_bounds(curve, clip)) return why;
  return nullptr;
}

}  // namespace cscd::scenes
