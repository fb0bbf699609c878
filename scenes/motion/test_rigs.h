#pragma once

// For tests only: random skinned tubes whose keys, bones and weights are of every kind, and random hands.

#include <map>
#include <random>
#include <set>

#include "core/mesh/test_shapes.h"
#include "scenes/character/pose.h"
#include "scenes/motion/character_motion.h"

namespace cscd::scenes::test_rigs {

// What a random rig may hold.
struct Kinds {
  bool cubic = false, constant = false, euler = false, scale = false, mirror = false, morph = false,
       response = false, dual = false, follow = false;
  double most_turn = 0.25;  // turns between neighbouring keys
};

class RigMaker {
 public:
  explicit RigMaker(unsigned seed) : random_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  bool coin() { return random_() % 2 == 0; }
  Vec3 vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }

  // A tube along x from 0 to 4, on `bones` joints that hang on each other under a root, with a clip of a
  // second.
  Character tube(const Kinds& kinds, int bones, int sides = 6, int rings = 12) {
    const test::Shape shape = test::capped_tube(sides, rings, 0.35, 4);
    Character character;
    character.nodes.push_back({"root", -1, Transform()});
    character.nodes[0].local.origin = vector(1);
    const double length = 4.0 / bones;
    Part part;
    part.name = "tube";
    part.node = 0;
    for (int b = 0; b < bones; ++b) {
      Transform local, offset;
      local.origin = Vec3(b > 0 ? length : 0, 0, 0);
      offset.origin = Vec3(-b * length, 0, 0);
      character.nodes.push_back({"bone" + std::to_string(b), b, local});
      part.joints.push_back({b + 1, offset});
    }
    if (kinds.follow && bones > 1) character.nodes.back().follows = FollowedScale{1, coin()};
    part.positions = shape.positions;
    for (const Triangle& t : shape.triangles)
      part.triangles.push_back({static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]),
                                static_cast<std::int32_t>(t[2])});
    for (const Vec3& x : part.positions) {
      part.first.push_back(part.influences.size());
      const double along = std::clamp(x.x() / length - 0.5, 0.0, bones - 1.0);
      const int low = std::min(static_cast<int>(along), bones - 1);
      const double upper = along - low;
      if (upper < 1) part.influences.push_back({low, 1 - upper});
      if (upper > 0) part.influences.push_back({low + 1, upper});
    }
    part.first.push_back(part.influences.size());
    if (kinds.dual)
      for (std::size_t v = 0; v < part.positions.size(); ++v)
        part.dual_quaternion.push_back(v % 3 == 0 ? 0.5 : 1);
    Animation clip{"clip", uniform(-1, 1), 1, 0, {}};
    for (int b = 1; b <= bones; ++b)
      if (b == 1 || !character.nodes[static_cast<std::size_t>(b)].follows)
        clip.channels.push_back(
            channel(kinds, b, clip.start, character.nodes[static_cast<std::size_t>(b)].local));
    if (kinds.morph) add_morphs(kinds, part, clip);
    character.parts.push_back(part);
    character.animations = {clip};
    character.format = "test";
    return character;
  }

  // A palm with four fingers of three bones each, that is flat at the start of its clip, whose bones turn by
  // up to `most` turns in the second that the clip lasts: mostly the fingers curl to one side, and each a bit
  // sideways.
  Character bending_hand(const Kinds& kinds, double most) {
    constexpr int kFingers = 4, kBones = 3, kPalm = 3, kFinger = 7;  // lengths in cells
    constexpr double kCell = 0.25;
    std::set<std::array<int, 3>> cells;
    for (int x = 0; x < 2 * kFingers - 1; ++x)
      for (int y = 0; y < (x % 2 == 0 ? kPalm + kFinger : kPalm); ++y) cells.insert({x, y, 0});
    Character character;
    character.nodes = {{"root", -1, Transform()}, {"palm", 0, Transform()}};
    character.nodes[0].local.origin = vector(1);
    Part part;
    part.name = "hand";
    part.node = 0;
    part.joints.push_back({1, Transform()});
    const auto joint_of = [](int finger, int bone) { return 1 + finger * kBones + bone; };
    const auto height = [](int bone) {
      return kPalm + 0.5 + bone * (kFinger - 1.0) / kBones;
    };  // of a bone's start
    for (int f = 0; f < kFingers; ++f)
      for (int b = 0; b < kBones; ++b) {
        Transform local, offset;
        const Vec3 start = kCell * Vec3(2 * f + 0.5, height(b), 0.5);
        local.origin = b == 0 ? start : Vec3(0, kCell * (height(b) - height(b - 1)), 0);
        offset.origin = -start;
        character.nodes.push_back({"finger", b == 0 ? 1 : joint_of(f, b), local});
        part.joints.push_back({1 + joint_of(f, b), offset});
      }
    std::map<std::array<int, 3>, std::int32_t> corners;
    const auto corner = [&](const std::array<int, 3>& at) {
      const auto [found, is_new] = corners.try_emplace(at, static_cast<std::int32_t>(part.positions.size()));
      if (!is_new) return found->second;
      part.positions.push_back(kCell * Vec3(at[0], at[1], at[2]));
      part.first.push_back(part.influences.size());
      // From a cell before a bone's start to a cell after it the bone takes over.
      const int finger = std::min(at[0] / 2, kFingers - 1);
      int before = 0;
      double share = 1;
      for (int b = 0; b < kBones; ++b) {
        const double of_next = std::clamp((at[1] - height(b) + 1) / 2, 0.0, 1.0);
        if (of_next == 0) break;
        if (of_next < 1) {
          part.influences.push_back({joint_of(finger, b), of_next});
          share = 1 - of_next;
          break;
        }
        before = joint_of(finger, b);
      }
      part.influences.push_back({before, share});
      return found->second;
    };
    for (const std::array<int, 3>& cell : cells)
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (const int side : {0, 1}) {
          std::array<int, 3> beside = cell;
          beside[axis] += 2 * side - 1;
          if (cells.contains(beside)) continue;
          std::array<std::int32_t, 4> quad;
          for (std::size_t k = 0; k < 4; ++k) {
            std::array<int, 3> at = cell;
            at[axis] += side;
            at[(axis + 1) % 3] += k == 1 || k == 2;
            at[(axis + 2) % 3] += k >= 2;
            quad[side == 1 ? k : 3 - k] = corner(at);
          }
          part.triangles.push_back({quad[0], quad[1], quad[2]});
          part.triangles.push_back({quad[0], quad[2], quad[3]});
        }
    part.first.push_back(part.influences.size());
    if (kinds.dual) part.dual_quaternion.assign(part.positions.size(), 1);
    Animation clip{"clip", uniform(-1, 1), 1, 0, {}};
    for (std::size_t n = 1; n < character.nodes.size(); ++n)
      clip.channels.push_back(bending(kinds, static_cast<int>(n), clip.start, Vec3(1, 0, 0) + vector(0.4),
                                      most / (n == 1 ? 2 : 1)));
    character.parts.push_back(part);
    character.animations = {clip};
    character.format = "test";
    return character;
  }

  // A longer tube that is straight at the start of its clip, whose bones turn by up to `most` turns in the
  // second that the clip lasts, mostly to one side.
  Character bending_tube(const Kinds& kinds, double most, int bones) {
    Character character = tube({.dual = kinds.dual}, bones, 7, 30);
    Part& part = character.parts[0];
    for (Vec3& x : part.positions) x = Vec3(x.x(), 0.7 * x.y(), 0.7 * x.z());
    if (kinds.dual) part.dual_quaternion.assign(part.positions.size(), 1);
    const Vec3 side = vector(1).normalized();
    for (Channel& channel : character.animations[0].channels)
      channel = bending(kinds, channel.node, character.animations[0].start, side + vector(0.6), most);
    return character;
  }

 private:
  // Turns about an axis in a second, by at most so many turns, mostly to one side.
  Channel bending(const Kinds& kinds, int node, double start, const Vec3& about, double most) {
    const Vec3 axis = about.normalized();
    const double half = uniform(-0.3, 1) * most * 3.14159265358979;
    const Quaternion end{std::cos(half), std::sin(half) * axis.x(), std::sin(half) * axis.y(),
                         std::sin(half) * axis.z()};
    Channel channel{node, {}, {}, {}};
    channel.rotations = {{start, {}}, {start + 1, end}};
    if (!kinds.cubic) return channel;
    channel.rotations[0].next = Between::cubic;
    channel.rotations[0].leaving = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    channel.rotations[1].arriving = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    return channel;
  }
  std::vector<double> times(double start) {
    std::vector<double> out{start};
    while (out.back() < start + 1) out.push_back(out.back() + uniform(0.1, 0.6));
    return out;
  }
  Between between(const Kinds& kinds) {
    const double which = uniform(0, 1);
    if (kinds.cubic && which < 0.5) return Between::cubic;
    return kinds.constant && which > 0.85 ? Between::constant : Between::line;
  }
  Quaternion turn(double most) {
    const Vec3 axis = vector(1).normalized();
    const double half = uniform(-most, most) * 3.14159265358979;
    return {std::cos(half), std::sin(half) * axis.x(), std::sin(half) * axis.y(), std::sin(half) * axis.z()};
  }
  std::vector<Key<double>> numbers(const Kinds& kinds, double start, double low, double high) {
    std::vector<Key<double>> keys;
    for (const double time : times(start))
      keys.push_back({time, uniform(low, high), between(kinds), uniform(-2, 2) * (high - low),
                      uniform(-2, 2) * (high - low)});
    return keys;
  }
  Channel channel(const Kinds& kinds, int node, double start, const Transform& local) {
    Channel out{node, {}, {}, {}};
    if (coin())
      for (const double time : times(start))
        out.moves.push_back({time, local.origin + vector(0.2), between(kinds), vector(1), vector(1)});
    if (kinds.euler) {
      for (Curve& curve : out.angles.degrees.base.axis) {
        curve.keys = numbers(kinds, start + 0.2, -90 * kinds.most_turn, 90 * kinds.most_turn);
        curve.beyond.first = curve.keys.front().time, curve.beyond.last = curve.keys.back().time;
        curve.beyond.before = coin() ? Beyond::straight : Beyond::hold;
      }
      out.angles.order = {2, 0, 1};
    } else {
      Quaternion at = turn(kinds.most_turn / 2);
      for (const double time : times(start)) {
        Quaternion slope = turn(0.5), other = turn(0.5);
        out.rotations.push_back({time, at, between(kinds), slope, other});
        at = product(turn(kinds.most_turn), at);
      }
    }
    if (kinds.scale)
      for (const double time : times(start)) {
        Vec3 scale(uniform(0.7, 1.4), uniform(0.7, 1.4), uniform(0.7, 1.4));
        if (kinds.mirror && node == 1) scale.z() = -scale.z();
        // Dual quaternions take no shears: bones below an uneven scale are even.
        if (kinds.dual && node > 1) scale = Vec3::Ones() * scale.x();
        if (kinds.dual && node == 1)
          scale = Vec3(scale.x(), scale.x(), kinds.mirror ? -scale.x() : scale.x());
        out.scales.push_back(
            {time, scale, between(kinds) == Between::cubic ? Between::line : between(kinds)});
      }
    return out;
  }
  void add_morphs(const Kinds& kinds, Part& part, Animation& clip) {
    MorphChannel morph{0, {}};
    for (int t = 0; t < 2; ++t) {
      MorphTarget target{"target", {}, 0};
      for (std::size_t v = 0; v < part.positions.size(); ++v) target.displacements.push_back(vector(0.1));
      if (kinds.response) target.response = {{0, 0}, {0.3, 0.8}, {0.7, 0.1}, {1, 1}};
      part.targets.push_back(target);
      morph.weights.push_back(driven(numbers(kinds, clip.start, -0.2, 1.2)));
      Curve& curve = morph.weights.back().base.axis[0];
      curve.beyond.first = curve.keys.front().time, curve.beyond.last = curve.keys.back().time;
    }
    clip.morphs.push_back(morph);
  }

  std::mt19937_64 random_;
};

// A rig of each kind, and of all kinds at once.
inline std::vector<std::pair<std::string, Kinds>> kinds_of_rigs() {
  return {
      {"linear keys", {}},
      {"cubic keys", {.cubic = true}},
      {"steps", {.constant = true}},
      {"angles", {.cubic = true, .euler = true}},
      {"scaled bones", {.scale = true}},
      {"mirrored bones", {.cubic = true, .scale = true, .mirror = true}},
      {"followed scales", {.scale = true, .follow = true}},
      {"morph targets", {.cubic = true, .morph = true}},
      {"morph targets with a response", {.cubic = true, .morph = true, .response = true}},
      {"dual quaternions", {.dual = true, .most_turn = 0.15}},
      {"scaled dual quaternions", {.cubic = true, .scale = true, .dual = true, .most_turn = 0.15}},
      {"mirrored dual quaternions", {.scale = true, .mirror = true, .dual = true, .most_turn = 0.15}},
      {"everything linear",
       {.cubic = true, .constant = true, .scale = true, .mirror = true, .morph = true, .response = true}}};
}

// All of a rig's surface.
inline MovingCharacter whole_surface(const Character& character) {
  MovingCharacter out{character, {}};
  for (std::size_t v = 0; v < character.parts[0].positions.size(); ++v)
    out.raw_vertex.push_back(static_cast<std::int32_t>(v));
  return out;
}

// Where the vertices are so many seconds after the clip's start, by the code that poses frames.
inline std::vector<Vec3> sampled(const Character& character, double seconds) {
  const Animation& clip = character.animations.front();
  std::vector<Vec3> out;
  skin(character, pose_at(character, clip, clip.start + seconds),
       weights_at(character, clip, clip.start + seconds), out);
  return out;
}

}  // namespace cscd::scenes::test_rigs
