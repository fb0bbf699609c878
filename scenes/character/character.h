#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenes/character/transform.h"

// A character as model files hold it: a tree of nodes, triangle surfaces that hang on them or follow several
// of them, and animations of the nodes. Plain values; nothing here knows a file format.
namespace cscd::scenes {

// A map as files write it: scale, then rotate, then move. A mirrored or flat scale is kept as it is written,
// which no matrix could give back.
struct ScaleTurnMove {
  Vec3 move = Vec3::Zero();
  Quaternion rotation;
  Vec3 scale = Vec3::Ones();
};

// A node that scales as another one above it does at the same time, or undoes what that one does.
struct FollowedScale {
  int node;  // above
  bool inverse;
};

struct Node {
  std::string name;
  int parent;                              // smaller than the node's own index; -1 for the root
  Transform local;                         // to the parent, at rest
  std::optional<ScaleTurnMove> written{};  // the same, where the file gives it in parts
  std::optional<FollowedScale> follows{};  // where animations move it with another node's scale
};

// A node that moves vertices of a part, and the map from the part's coordinates to the node's when both were
// bound.
struct Joint {
  int node;
  Transform offset;
};

struct Influence {
  int joint;  // of the part
  double weight;
};

// One shape that a part can be blended towards (morph target, blend shape): what is added to its positions.
struct MorphTarget {
  std::string name;
  std::vector<Vec3> displacements;  // [vertices]
  double weight = 0;                // at rest
};

// One surface, in coordinates of its own.
struct Part {
  std::string name;  // of the mesh
  int node;          // where it hangs; vertices without influences follow it
  std::vector<Vec3> positions;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<Joint> joints;
  std::vector<std::size_t>
      first;  // [vertices + 1]: those of vertex v are influences[first[v] .. first[v + 1])
  std::vector<Influence> influences;  // weights positive; of one vertex they sum to 1
  std::vector<MorphTarget> targets{};
  // Numbers of the mesh and of the primitive in it that the part was made of, as the file counts them; two
  // parts may be instances of one mesh. Vertex v of the part is vertex v of that primitive.
  int mesh = -1, primitive = -1;
};

// How a value goes on from one key to the next.
enum class Between {
  constant,  // stays until the next key
  line,      // in a straight line; rotations along the shorter way
  cubic      // along the cubic through both keys with their tangents (Hermite); rotations are normalised
};

// A tangent that does not rise.
template <class Value>
inline const Value kFlat{};
template <>
inline const Vec3 kFlat<Vec3> = Vec3::Zero();
template <>
inline const Quaternion kFlat<Quaternion>{0, 0, 0, 0};

template <class Value>
struct Key {
  double time;  // seconds, growing
  Value value;
  Between next = Between::line;
  // Tangents for cubics, a second; of rotations the slopes of the four numbers.
  Value arriving = kFlat<Value>, leaving = kFlat<Value>;
};

// One number over time.
using Curve = std::vector<Key<double>>;

// A vector or a rotation whose components have keys at times of their own (FBX). A component without keys
// stays at `rest`.
struct Components {
  std::array<Curve, 3> axis;
  std::array<double, 3> rest{};
  bool empty() const { return axis[0].empty() && axis[1].empty() && axis[2].empty(); }
};

// A rotation as three angles in degrees about x, y and z; `order` lists the axes in the order in which they
// are turned about.
struct EulerAngles {
  Components degrees;
  std::array<int, 3> order{0, 1, 2};
};

// What moves one node. A list without keys leaves that part of the node at rest. Of whole values and
// components a channel has one at most.
struct Channel {
  int node;
  std::vector<Key<Vec3>> moves;
  std::vector<Key<Quaternion>> rotations;
  std::vector<Key<Vec3>> scales;
  Components move_components{}, scale_components{};
  EulerAngles angles{};
};

// What blends one part towards its targets.
struct MorphChannel {
  int part;
  std::vector<Curve> weights;  // [targets]
};

struct Animation {
  std::string name;               // may be empty
  double start = 0, seconds = 0;  // the clip's first moment, and from there to its last
  double ticks_per_second = 0;    // as the file says; 0 where it does not, 1 in formats of seconds
  std::vector<Channel> channels;
  std::vector<MorphChannel> morphs{};
};

struct Character {
  std::vector<Node> nodes;  // parents first
  std::vector<Part> parts;
  std::vector<Animation> animations;
  std::string format;
  double centimetres_per_unit = 0;  // 0 where the file does not say
  std::vector<std::string> notes;   // what of the file was left out
};

// Bounds on what a file may hold.
struct CharacterLimits {
  std::size_t file_bytes = std::size_t{256} << 20;
  std::size_t nodes = 100'000, parts = 10'000, joints = 4096;  // joints: of all parts together, as nodes
  std::size_t vertices = 10'000'000, triangles = 20'000'000, influences = 80'000'000;
  std::size_t animations = 10'000, keys = 20'000'000;
  std::size_t displacements = 40'000'000;  // of all morph targets together, one a vertex
  std::size_t frames = 1'000'000, cache_bytes = std::size_t{8} << 30;
};

// Throws InputError for counts above the limits, indices out of range, numbers that are not finite, weights
// that do not sum to 1, and times that do not grow. Everything below relies on it.
void validate(const Character& character, const CharacterLimits& limits);

// The nodes that move a part: joints with an influence, and those under vertices without. Sorted.
std::vector<int> moving_nodes(const Character& character);

}  // namespace cscd::scenes
