#pragma once

#include "scenes/character/character.h"
#include "scenes/import/gltf/accessor.h"
#include "scenes/import/gltf/tree.h"

namespace cscd::scenes::gltf {

// Makes clips from a file's animations, and counts what it leaves out.
class Clips {
 public:
  Clips(Accessors& accessors, const CharacterLimits& limits) : accessors_(accessors), limits_(limits) {}

  // Reads one animation. `parts` must be in ascending order of their nodes. Throws InputError for damaged
  // keys and for more keys than the limits allow.
  Animation read(const tinygltf::Animation& source, const Tree& tree, const std::vector<Part>& parts);

  // Returns messages about what was left out of all clips read so far.
  std::vector<std::string> notes() const;

 private:
  struct Sampled;
  Sampled sampled(const tinygltf::Animation& source, int sampler, const std::string& path,
                  std::size_t targets);
  void read_weights(const tinygltf::Animation& source, const tinygltf::AnimationChannel& channel, int node,
                    const std::vector<Part>& parts, std::map<int, MorphChannel>& by_part);
  void read_node(const tinygltf::Animation& source, const tinygltf::AnimationChannel& channel, Channel& to);
  [[noreturn]] static void refuse_time(const Sampled& from, std::size_t key);
  template <class Value, class Convert>
  std::vector<Key<Value>> keys(const Sampled& from, const Convert& convert);

  Accessors& accessors_;
  const CharacterLimits& limits_;
  // Counts over all clips read so far.
  std::size_t keys_ = 0, twice_set_ = 0, twice_ = 0, no_targets_ = 0;
};

}  // namespace cscd::scenes::gltf
