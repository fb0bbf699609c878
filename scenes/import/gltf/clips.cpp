#include "scenes/import/gltf/clips.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/number_text.h"

namespace cscd::scenes::gltf {
namespace {

Between between(const std::string& interpolation, const std::string& where) {
  if (interpolation.empty() || interpolation == "LINEAR") return Between::line;
  if (interpolation == "STEP") return Between::constant;
  if (interpolation == "CUBICSPLINE") return Between::cubic;
  throw InputError(where + ": its interpolation '" + interpolation + "' is unknown; export it again");
}

Vec3 vector(std::span<const double> v) {
  return {v[0], v[1], v[2]};
}
Quaternion quaternion(std::span<const double> q) {
  return {q[3], q[0], q[1], q[2]};
}

// The rotations of keys must be unit quaternions up to rounding. Tangents may have any
// length and are left alone.
void normalise(Quaternion& value, const std::string& where) {
  value = unit(value, where);
}
void normalise(const Vec3&, const std::string&) {}
void normalise(double, const std::string&) {}

struct ByNode {
  bool operator()(const Part& part, int node) const { return part.node < node; }
  bool operator()(int node, const Part& part) const { return node < part.node; }
};

struct Reach {
  double first = std::numeric_limits<double>::infinity(), last = -first;

  // A single key holds at all times, so it does not bear on the clip's length.
  template <class Value>
  void take(const std::vector<Key<Value>>& keys) {
    if (keys.size() < 2) return;
    first = std::min(first, keys.front().time);
    last = std::max(last, keys.back().time);
  }
};

}  // namespace

// The numbers of one sampler.
struct Clips::Sampled {
  std::string where;
  Numbers times, values;
  Between next;
  // Number of values that one key sets: the number of morph targets, or 1. A key of a cubic has three times
  // as many in `values`: the arriving tangents first, then the values, then the leaving tangents.
  std::size_t elements = 1;
};

Clips::Sampled Clips::sampled(const tinygltf::Animation& source, int index, const std::string& path,
                              std::size_t targets) {
  const std::string where = "clip '" + source.name + "' of the glTF file, sampler " + std::to_string(index);
  const tinygltf::AnimationSampler& sampler = at(source.samplers, index, "animation sampler");
  Sampled out;
  out.where = where;
  out.next = between(sampler.interpolation, where);
  out.elements = path == "weights" ? targets : 1;
  const std::size_t most = limits_.keys - keys_;
  out.times = accessors_.read(sampler.input,
                              {where + ", times", TINYGLTF_TYPE_SCALAR, Components::floats, false, most});
  const std::size_t a_key = out.elements * (out.next == Between::cubic ? 3 : 1);
  if (out.elements * out.times.count > most)
    throw InputError("has more than " + std::to_string(limits_.keys) + " animation keys; resample it");
  keys_ += out.elements * out.times.count;
  constexpr Components kFractions = Components::floats | Components::bytes | Components::unsigned_bytes |
                                    Components::shorts | Components::unsigned_shorts;
  const int type = path == "weights"    ? TINYGLTF_TYPE_SCALAR
                   : path == "rotation" ? TINYGLTF_TYPE_VEC4
                                        : TINYGLTF_TYPE_VEC3;
  const bool fractions = path == "weights" || path == "rotation";
  out.values =
      accessors_.read(sampler.output, {where + ", values", type, fractions ? kFractions : Components::floats,
                                       fractions, a_key * out.times.count});
  if (out.values.count != a_key * out.times.count)
    throw InputError(where + ": has " + std::to_string(out.values.count) + " values instead of " +
                     std::to_string(a_key * out.times.count) + "; export it again");
  for (const double time : out.times.values)
    if (!std::isfinite(time)) throw InputError(where + ": a key's time is not finite; repair the animation");
  return out;
}

void Clips::refuse_time(const Sampled& from, std::size_t key) {
  throw InputError(from.where + ": its key times do not rise: key " + std::to_string(key) +
                   " (counted from 0) is at " + exact_text(from.times.values[key]) +
                   " s, and the key before at " + exact_text(from.times.values[key - 1]) +
                   " s; sort the keys, and export it again");
}

// Makes the keys of a sampler. `convert` makes a value from the key's only element, or from the element of
// one morph target.
template <class Value, class Convert>
std::vector<Key<Value>> Clips::keys(const Sampled& from, const Convert& convert) {
  std::vector<Key<Value>> keys;
  const bool cubic = from.next == Between::cubic;
  for (std::size_t i = 0; i < from.times.count; ++i) {
    const double time = from.times.values[i];
    const std::size_t a_key = from.elements * (cubic ? 3 : 1);
    if (!keys.empty() && !(time > keys.back().time)) {
      bool is_twice = time == keys.back().time;  // with the values of the key before
      for (std::size_t k = 0; k < a_key; ++k)
        is_twice =
            is_twice && std::ranges::equal(from.values[i * a_key + k], from.values[(i - 1) * a_key + k]);
      if (!is_twice) refuse_time(from, i);
      ++twice_set_;
      continue;
    }
    const auto element = [&](std::size_t which) {
      return convert([&, which](std::size_t target) {
        return from.values[(i * (cubic ? 3 : 1) + which) * from.elements + target];
      });
    };
    Key<Value> key{time, element(cubic ? 1 : 0), from.next};
    normalise(key.value, from.where);
    if (cubic) {
      key.arriving = element(0);
      key.leaving = element(2);
    }
    keys.push_back(key);
  }
  return keys;
}

void Clips::read_weights(const tinygltf::Animation& source, const tinygltf::AnimationChannel& channel,
                         int node, const std::vector<Part>& parts, std::map<int, MorphChannel>& by_part) {
  bool any = false;
  const auto [first, last] = std::equal_range(parts.begin(), parts.end(), node, ByNode{});
  for (auto part = first; part != last; ++part) {
    const std::size_t targets = part->targets.size();
    if (targets == 0) continue;
    any = true;
    const int index = static_cast<int>(part - parts.begin());
    const auto [to, fresh] = by_part.try_emplace(index, MorphChannel{index, {}});
    if (!fresh) {
      ++twice_;
      continue;
    }
    const Sampled from = sampled(source, channel.sampler, channel.target_path, targets);
    for (std::size_t t = 0; t < targets; ++t)
      to->second.weights.push_back(driven(keys<double>(from, [t](const auto& at) { return at(t)[0]; })));
  }
  no_targets_ += !any;
}

void Clips::read_node(const tinygltf::Animation& source, const tinygltf::AnimationChannel& channel,
                      Channel& to) {
  const std::string& path = channel.target_path;
  const auto fill = [&](auto& list, const auto& convert) {
    if (!list.empty()) {
      ++twice_;
      return;
    }
    using Value = decltype(list[0].value);
    list = keys<Value>(sampled(source, channel.sampler, path, 1), convert);
  };
  const auto to_vector = [](const auto& at) { return vector(at(0)); };
  if (path == "translation")
    fill(to.moves, to_vector);
  else if (path == "rotation")
    fill(to.rotations, [](const auto& at) { return quaternion(at(0)); });
  else if (path == "scale")
    fill(to.scales, to_vector);
  else
    throw InputError("clip '" + source.name + "' of the glTF file moves the unknown '" + path +
                     "' of a node; export it again");
}

Animation Clips::read(const tinygltf::Animation& source, const Tree& tree, const std::vector<Part>& parts) {
  Animation animation;
  animation.name = source.name;
  animation.ticks_per_second = 1;  // glTF's times are seconds
  std::map<int, Channel> by_node;
  std::map<int, MorphChannel> by_part;
  for (const tinygltf::AnimationChannel& channel : source.channels) {
    const int node = at(tree.place, channel.target_node, "node");
    if (channel.target_path == "weights")
      read_weights(source, channel, node, parts, by_part);
    else
      read_node(source, channel, by_node.try_emplace(node, Channel{node, {}, {}, {}}).first->second);
  }
  Reach reach;
  for (auto& [node, channel] : by_node) {
    reach.take(channel.moves);
    reach.take(channel.rotations);
    reach.take(channel.scales);
    animation.channels.push_back(std::move(channel));
  }
  for (auto& [part, morph] : by_part) {
    for (const Layered<1>& weight : morph.weights) reach.take(weight.base.axis[0].keys);
    animation.morphs.push_back(std::move(morph));
  }
  if (reach.first <= reach.last) {
    animation.start = reach.first;
    animation.seconds = reach.last - reach.first;
  }
  return animation;
}

std::vector<std::string> Clips::notes() const {
  std::vector<std::string> notes;
  const auto note = [&](std::size_t count, const char* what) {
    if (count > 0) notes.push_back(std::to_string(count) + " " + what);
  };
  note(twice_set_, "keys ignored that repeat the key before");
  note(twice_, "animation channels ignored: an earlier channel moves the same");
  note(no_targets_, "animation channels move weights of nodes without morph targets and are ignored");
  return notes;
}

}  // namespace cscd::scenes::gltf
