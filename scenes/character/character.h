#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/character/transform.h"

// A character as model files hold it: a tree of nodes, triangle surfaces that hang on them or follow several
// of them, and animations of the nodes. Plain values; nothing here knows a file format.
namespace cscd::scenes {

struct Node {
  std::string name;
  int parent;       // smaller than the node's own index; -1 for the root
  Transform local;  // to the parent, at rest
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

// One surface, in coordinates of its own.
struct Part {
  std::string name;
  int node;  // where it hangs; vertices without influences follow it
  std::vector<Vec3> positions;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<Joint> joints;
  std::vector<std::size_t>
      first;  // [vertices + 1]: those of vertex v are influences[first[v] .. first[v + 1])
  std::vector<Influence> influences;  // weights positive; of one vertex they sum to 1
};

template <class Value>
struct Key {
  double time;  // seconds, growing
  Value value;
};

// What moves one node. A list without keys leaves that part of the node at rest.
struct Channel {
  int node;
  std::vector<Key<Vec3>> moves;
  std::vector<Key<Quaternion>> rotations;
  std::vector<Key<Vec3>> scales;
};

struct Animation {
  std::string name;               // may be empty
  double start = 0, seconds = 0;  // the time of the first key, and from there to the last
  double ticks_per_second = 0;    // as the file says; 0 where it does not
  std::vector<Channel> channels;
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
  std::size_t frames = 1'000'000, cache_bytes = std::size_t{8} << 30;
};

// Throws InputError for counts above the limits, indices out of range, numbers that are not finite, weights
// that do not sum to 1, and times that do not grow. Everything below relies on it.
void validate(const Character& character, const CharacterLimits& limits);

// The nodes that move a part: joints with an influence, and those under vertices without. Sorted.
std::vector<int> moving_nodes(const Character& character);

}  // namespace cscd::scenes
