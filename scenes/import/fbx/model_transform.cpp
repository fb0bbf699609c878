#include "scenes/import/fbx/model_transform.h"

#include <optional>

#include "core/base/error.h"

namespace cscd::scenes::fbx {
namespace {

constexpr std::array<int, 3> kXyz{0, 1, 2};
// Deeper nests of uneven scalings are refused, so that lists of them stay short.
constexpr std::size_t kMostScalings = 32;

Quaternion conjugate(const Quaternion& q) {
  return {q.w, -q.x, -q.y, -q.z};
}

bool is_identity(const Quaternion& q) {
  return q.x == 0 && q.y == 0 && q.z == 0;
}

Transform rotation_map(const Quaternion& q) {
  return from_trs(Vec3::Zero(), q, Vec3::Ones());
}

// Refuses vectors that are not finite: a rotation that is not finite would silently become the identity.
Vec3 finite_vector(const Object& model, std::string_view name, const Vec3& otherwise) {
  const Vec3 value = vector(model, name, otherwise);
  if (!value.allFinite())
    throw InputError(told("node", model) + ": its " + std::string(name) + " is not finite; repair it");
  return value;
}

std::array<int, 3> order_of(const Object& model) {
  switch (integer(model, "RotationOrder", 0)) {
    case 0:
      return kXyz;
    case 1:
      return {0, 2, 1};
    case 2:
      return {1, 2, 0};
    case 3:
      return {1, 0, 2};
    case 4:
      return {2, 0, 1};
    case 5:
      return {2, 1, 0};
    default:
      throw InputError(told("node", model) +
                       ": its rotation order is spheric or unknown; bake the rotation to XYZ on export");
  }
}

Inherit inherit_of(const Object& model) {
  switch (integer(model, "InheritType", 0)) {
    case 0:
      return Inherit::RrSs;
    case 1:
      return Inherit::RSrs;
    case 2:
      return Inherit::Rrs;
    default:
      throw InputError(told("node", model) + ": its inherit type is unknown; bake the transforms on export");
  }
}

// Puts a model's maps one after the other into nodes, each of which scales, then turns, then moves.
class ChainBuilder {
 public:
  ChainBuilder(Character& character, int parent) : character_(character), parent_(parent) {}

  // Each of these three returns the node that holds the map. An identity that is not animated needs no
  // node; it returns -1.
  int move(const Vec3& by, bool animated) {
    if (by == Vec3::Zero() && !animated) return -1;
    make_room(0);
    written().move = by;
    return current();
  }
  int turn(const Quaternion& by, bool animated) {
    if (is_identity(by) && !animated) return -1;
    make_room(1);
    written().rotation = by;
    return current();
  }
  int scale(const Vec3& by, bool animated) {
    if (by == Vec3::Ones() && !animated) return -1;
    make_room(2);
    written().scale = by;
    return current();
  }
  // Append the inverse of a scaling further up, and the scaling itself, as they are at every time.
  void undo(const Scaling& above) { follow(above, true); }
  void redo(const Scaling& above) { follow(above, false); }

  int finish(const std::string& name) {
    if (first_ < 0) start_node();
    for (std::size_t n = static_cast<std::size_t>(first_); n < character_.nodes.size(); ++n) {
      Node& node = character_.nodes[n];
      node.name = n + 1 == character_.nodes.size() ? name : name + " (helper)";
      if (node.written)
        node.local = from_trs(node.written->move, node.written->rotation, node.written->scale);
    }
    return current();
  }

 private:
  int current() const { return static_cast<int>(character_.nodes.size()) - 1; }
  ScaleTurnMove& written() { return *character_.nodes.back().written; }

  void start_node() {
    const int parent = first_ < 0 ? parent_ : current();
    character_.nodes.push_back({"", parent, {}, ScaleTurnMove{}});
    if (first_ < 0) first_ = current();
    filled_ = -1;
  }
  void make_room(int slot) {
    if (first_ < 0 || slot <= filled_) start_node();
    filled_ = slot;
  }
  void follow(const Scaling& above, bool inverse) {
    start_node();
    filled_ = 2;
    written().scale = inverse ? Vec3(above.scale.cwiseInverse()) : above.scale;
    if (above.animated) character_.nodes.back().follows = FollowedScale{above.node, inverse};
  }

  Character& character_;
  int parent_, first_ = -1;
  int filled_ = -1;  // last slot taken in the current node: 0 move, 1 turn, 2 scale
};

// The scalings to undo before a node turns, and those to apply again after the turn.
struct Detour {
  std::vector<Scaling> undo, redo;
};

[[noreturn]] void refuse_inherit(const std::string& name, Inherit inherit, const char* why) {
  throw InputError("node '" + name + "': inherit type " + (inherit == Inherit::RrSs ? "RrSs" : "Rrs") + " " +
                   why + "; bake the transforms on export");
}

std::vector<Scaling> uneven(const Chain& chain, bool with_own) {
  std::vector<Scaling> list = chain.above;
  if (with_own && !chain.own.uniform) list.push_back(chain.own);
  return list;
}

Detour detour_of(const std::string& name, const ModelTransform& transform, bool turns, const Chain& parent) {
  Detour detour;
  const Inherit inherit = transform.inherit;
  if (inherit == Inherit::RSrs) return detour;
  const std::vector<Scaling> above = uneven(parent, inherit == Inherit::RrSs);
  const bool drops_own = inherit == Inherit::Rrs && !parent.own.unit;
  if (parent.sheared && (turns || drops_own))
    refuse_inherit(name, inherit, "below nodes whose scaling is uneven and turned");
  // A node that does not turn leaves the axes as they are, so uneven scalings act correctly without a detour.
  if (!turns && !drops_own) return detour;
  detour.undo = above;
  if (drops_own) detour.undo.push_back(parent.own);
  detour.redo = above;
  if (detour.undo.empty()) return detour;
  if (transform.between != Vec3::Zero() || transform.end != Vec3::Zero())
    refuse_inherit(name, inherit, "with pivots below nodes whose scaling is uneven or not taken over");
  for (const Scaling& scaling : detour.undo)
    if ((scaling.scale.array() == 0).any()) refuse_inherit(name, inherit, "below a node of no extent");
  return detour;
}

}  // namespace

ModelTransform read_transform(const Object& model) {
  const Vec3 zero = Vec3::Zero();
  ModelTransform t;
  t.move = finite_vector(model, "Lcl Translation", zero);
  t.turn = finite_vector(model, "Lcl Rotation", zero);
  t.scale = finite_vector(model, "Lcl Scaling", Vec3::Ones());
  const Vec3 turn_pivot = finite_vector(model, "RotationPivot", zero),
             scale_pivot = finite_vector(model, "ScalingPivot", zero);
  t.before = finite_vector(model, "RotationOffset", zero) + turn_pivot;
  t.between = finite_vector(model, "ScalingOffset", zero) + scale_pivot - turn_pivot;
  t.end = zero - scale_pivot;
  t.inherit = inherit_of(model);
  // Where a node's space of rotation is not active, or serves limits only, the SDK ignores the order and
  // the rotations before and after.
  if (integer(model, "RotationActive", 0) != 0 && integer(model, "RotationSpaceForLimitOnly", 0) == 0) {
    t.order = order_of(model);
    t.pre = from_euler(finite_vector(model, "PreRotation", zero), kXyz);
    t.post = conjugate(from_euler(finite_vector(model, "PostRotation", zero), kXyz));
  }
  return t;
}

Transform geometric_transform(const Object& model) {
  return from_trs(finite_vector(model, "GeometricTranslation", Vec3::Zero()),
                  from_euler(finite_vector(model, "GeometricRotation", Vec3::Zero()), kXyz),
                  finite_vector(model, "GeometricScaling", Vec3::Ones()));
}

Chain add_model(Character& character, const std::string& name, const ModelTransform& t,
                const Animated& animated, const Chain& parent) {
  const Quaternion turn = from_euler(t.turn, t.order);
  const bool turns = animated.turn || !is_identity(t.pre) || !is_identity(turn) || !is_identity(t.post);
  const Detour detour = detour_of(name, t, turns, parent);
  Chain chain;
  chain.above = uneven(parent, t.inherit != Inherit::Rrs);
  chain.sheared = parent.sheared || (t.inherit == Inherit::RSrs && turns && !chain.above.empty());
  if (chain.above.size() > kMostScalings)
    throw InputError("node '" + name + "': stands below more than " + std::to_string(kMostScalings) +
                     " uneven scalings; bake the transforms on export");
  const bool even = t.scale.x() == t.scale.y() && t.scale.y() == t.scale.z();
  chain.own.scale = t.scale;
  chain.own.animated = animated.scale;
  chain.own.uniform = even && (!animated.scale || animated.uniform_scale);
  chain.own.unit = t.scale == Vec3::Ones() && !animated.scale;

  if (!animated.move && !animated.turn && !animated.scale && detour.undo.empty()) {
    Transform whole = rotation_map(t.pre);
    whole.origin = t.move + t.before;
    whole = composed(composed(whole, rotation_map(turn)), rotation_map(t.post));
    whole = composed(whole, from_trs(t.between, {}, t.scale));
    whole = composed(whole, from_trs(t.end, {}, Vec3::Ones()));
    character.nodes.push_back({name, parent.last, whole});
    chain.last = static_cast<int>(character.nodes.size()) - 1;
    return chain;
  }
  ChainBuilder builder(character, parent.last);
  const int moves = builder.move(t.move + t.before, animated.move);
  for (std::size_t i = detour.undo.size(); i-- > 0;) builder.undo(detour.undo[i]);
  builder.turn(t.pre, false);
  const int turns_at = builder.turn(turn, animated.turn);
  builder.turn(t.post, false);
  for (const Scaling& scaling : detour.redo) builder.redo(scaling);
  builder.move(t.between, false);
  const int scales = builder.scale(t.scale, animated.scale);
  builder.move(t.end, false);
  chain.last = builder.finish(name);
  if (animated.move) chain.moves = moves;
  if (animated.turn) chain.turns = turns_at;
  if (animated.scale) chain.scales = chain.own.node = scales;
  return chain;
}

}  // namespace cscd::scenes::fbx
