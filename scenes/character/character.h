#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenes/character/transform.h"

// A character as model files hold it: a tree of nodes, surfaces of triangles that hang on one node or follow
// several nodes, and animations of the nodes. These are plain values; nothing here knows a file format.
namespace cscd::scenes {

// A map as files write it: scale, then rotate, then move. A mirrored or flat scale is kept as the file
// writes it, because no decomposition of a matrix could give it back.
struct ScaleTurnMove {
  Vec3 move = Vec3::Zero();
  Quaternion rotation;
  Vec3 scale = Vec3::Ones();
};

// Marks a node whose scale follows the animated scale of a node above it: it either scales by the same
// factors at the same time or undoes them.
struct FollowedScale {
  int node;      // index of the node above
  bool inverse;  // true: the reciprocal scale
};

// A node of the tree. Nodes are listed parents first.
struct Node {
  std::string name;
  int parent;                              // smaller than the node's own index; -1 for the root
  Transform local;                         // from the node's coordinates to its parent's, at rest
  std::optional<ScaleTurnMove> written{};  // `local` in parts, where the file gives it so
  std::optional<FollowedScale> follows{};  // where animations move the node with another node's scale
};

// A node that moves vertices of a part. `offset` maps the part's coordinates to the node's coordinates at
// the moment when the vertices were bound to the node.
struct Joint {
  int node;
  Transform offset;
};

// How strongly one joint moves one vertex.
struct Influence {
  int joint;  // index into Part::joints
  double weight;
};

// One shape that a part can be blended towards (morph target, blend shape), as the displacements that it
// adds to the part's positions.
struct MorphTarget {
  std::string name;
  std::vector<Vec3> displacements;  // [vertices]
  double weight = 0;                // at rest
  // The weight as a function of the value that animations drive: straight lines from knot to knot, of which
  // the first and the last go on. Without knots, the driven value is the weight itself.
  struct Knot {
    double driven, weight;
  };
  std::vector<Knot> response{};  // at least two knots where there are any; `driven` ascends
};

// One surface of triangles, in coordinates of its own.
struct Part {
  std::string name;  // name of the mesh
  int node;          // the part hangs on it; vertices without influences follow it
  std::vector<Vec3> positions;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<Joint> joints;
  std::vector<std::size_t> first;     // [vertices + 1]; vertex v has influences[first[v] .. first[v + 1])
  std::vector<Influence> influences;  // weights are positive; those of one vertex sum to 1
  std::vector<MorphTarget> targets{};
  // [vertices], or empty where all are 0: the share by which a vertex follows its joints by dual quaternions
  // (see skin in pose.h); it follows them linearly by the rest.
  std::vector<double> dual_quaternion{};
  // The numbers, as the file counts them, of the mesh and of the primitive in the mesh that the part was
  // made from. Two parts may be instances of one mesh. Vertex v of the part is vertex v of that primitive.
  int mesh = -1, primitive = -1;
};

// How a value goes on from one key to the next.
enum class Between {
  constant,  // stays until the next key
  line,      // in a straight line; rotations turn the shorter way
  cubic      // along the cubic through both keys with their tangents (Hermite); rotations are normalised
};

// The tangent of a value that does not change: zero in every component.
template <class Value>
inline const Value kFlat{};
template <>
inline const Vec3 kFlat<Vec3> = Vec3::Zero();
template <>
inline const Quaternion kFlat<Quaternion>{0, 0, 0, 0};

// A value that an animation prescribes at one moment.
template <class Value>
struct Key {
  double time;  // seconds; strictly ascending in a list of keys
  Value value;
  Between next = Between::line;  // how the value goes on to the next key
  // Tangents for Between::cubic, in units of the value a second. For rotations they are the slopes of the
  // four numbers of the quaternion.
  Value arriving = kFlat<Value>, leaving = kFlat<Value>;
};

// How a curve goes on before its first key or after its last key.
enum class Beyond {
  hold,      // at the value of that key
  straight,  // along the slope that it has there
  repeat,    // through all its keys again
  rise,   // through all its keys again, where each repetition starts at the value that the last one reached
  mirror  // through all its keys again, backwards the first time, forwards the second time, and so on
};

// What a curve does before its first key and after its last key.
struct Extrapolation {
  Beyond before = Beyond::hold, after = Beyond::hold;
  // How often the keys are repeated. The value that the last repetition reaches holds from there on.
  double repeats_before = std::numeric_limits<double>::infinity(), repeats_after = repeats_before;
  double first = 0, last = 0;  // seconds: the span that is repeated
  // The file's unit of time in seconds. Two moments that are less than half of it apart count as the same, so
  // that the rounding of a time does not move it from the start of a repetition to the end of the one before.
  double tick = 0;
};

// One number over time.
struct Curve {
  std::vector<Key<double>> keys;
  Extrapolation beyond{};
  bool empty() const { return keys.empty(); }
};

// Numbers that each have keys at times of their own (as in FBX): the three parts of a vector, or one number
// by itself. A number without keys stays at `rest`.
template <std::size_t Width>
struct Components {
  std::array<Curve, Width> axis;
  std::array<double, Width> rest{};
  bool empty() const {
    return std::all_of(axis.begin(), axis.end(), [](const Curve& curve) { return curve.empty(); });
  }
};

// How a layer of an animation acts on the value that the layers below it have made, at the share w in [0, 1]
// of the layer's weight.
enum class LayerBlend {
  add,  // below + w * value
  mix   // (1 - w) * below + w * value
};

// One layer above others.
template <std::size_t Width>
struct Layer {
  Components<Width> values;
  LayerBlend blend = LayerBlend::add;
  // Rotations and scalings are combined as maps instead of number by number. A rotation is turned by the
  // share w of the layer's rotation (add) or towards it (mix), along the shorter way. A scaling is multiplied
  // by the layer's scaling to the power of w (add); both are multiplied to the powers of 1 - w and w (mix).
  bool as_maps = false;
  int weight = -1;  // index into Animation::layer_weights; -1 where w is 1 at all times
};

// Numbers that the layers of an animation make together, the lowest layer first. The lowest layer is taken as
// it is.
template <std::size_t Width>
struct Layered {
  Components<Width> base;
  std::vector<Layer<Width>> above{};
  bool empty() const { return base.empty() && above.empty(); }
};

// Calls visit(curve) for each curve of all layers.
template <std::size_t Width, class Visit>
void for_each_curve(const Layered<Width>& layered, const Visit& visit) {
  for (const Curve& curve : layered.base.axis) visit(curve);
  for (const Layer<Width>& layer : layered.above)
    for (const Curve& curve : layer.values.axis) visit(curve);
}

// Returns one number that keys drive, without layers.
inline Layered<1> driven(std::vector<Key<double>> keys) {
  return {{{Curve{std::move(keys)}}}};
}

// A rotation as three angles in degrees about x, y and z. `order` lists the axes in the order in which the
// rotations about them are applied. A layer that adds or mixes angles number by number must not lie above a
// layer that combines rotations as maps, because no three angles are distinguished there.
struct EulerAngles {
  Layered<3> degrees{};
  std::array<int, 3> order{0, 1, 2};
};

// The keys that move one node. A list without keys leaves that part of the node at rest. A channel gives a
// move, a rotation or a scale by keys of whole values or by keys of components, never by both.
struct Channel {
  int node;
  std::vector<Key<Vec3>> moves;
  std::vector<Key<Quaternion>> rotations;
  std::vector<Key<Vec3>> scales;
  Layered<3> move_components{}, scale_components{};
  EulerAngles angles{};
};

// The keys that blend one part towards its morph targets.
struct MorphChannel {
  int part;
  std::vector<Layered<1>>
      weights;  // [targets]: the driven value of each target; empty where it stays at rest
};

// One clip: what moves during it, and when.
struct Animation {
  std::string name;               // may be empty
  double start = 0, seconds = 0;  // seconds: the clip's first moment, and its length
  double ticks_per_second = 0;    // 0 where the file does not say; 1 in formats that count in seconds
  std::vector<Channel> channels;
  std::vector<MorphChannel> morphs{};
  std::vector<Curve> layer_weights{};  // shares; below 0 counts as 0, and above 1 as 1
};

// Everything that is read from one model file.
struct Character {
  std::vector<Node> nodes;  // parents first
  std::vector<Part> parts;
  std::vector<Animation> animations;
  std::string format;
  std::string up;                   // the axis that points up (scenes/clip/up_axis.h); empty if nothing says
  double centimetres_per_unit = 0;  // 0 where neither the file nor its format says
  std::optional<double> frames_per_second{};  // where the file states it as such; else see frame_rate.h
  std::vector<std::string> notes;             // messages about what was left out of the file
};

// Upper bounds on what a model file may hold.
struct CharacterLimits {
  std::size_t file_bytes = std::size_t{256} << 20;
  std::size_t nodes = 100'000, parts = 10'000, joints = 4096;  // joints: distinct nodes, over all parts
  std::size_t vertices = 10'000'000, triangles = 20'000'000, influences = 80'000'000;
  std::size_t animations = 10'000, keys = 20'000'000;
  std::size_t displacements = 40'000'000;  // of all morph targets together, one a vertex and target
  std::size_t frames = 1'000'000, cache_bytes = std::size_t{8} << 30;
};

// Checks a character against the limits and for consistency; all functions of this folder rely on it.
// Throws InputError for counts above the limits, indices out of range, numbers that are not finite,
// coordinates beyond 1e15, weights that do not sum to 1, and times of keys that do not ascend.
void validate(const Character& character, const CharacterLimits& limits);

// Returns the sorted indices of the nodes that move a vertex: the joints that have an influence, and the
// nodes of the parts that have vertices without influences.
std::vector<int> moving_nodes(const Character& character);

}  // namespace cscd::scenes
