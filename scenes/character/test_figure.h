#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "core/mesh/test_shapes.h"
#include "scenes/character/character.h"
#include "scenes/character/test_characters.h"
#include "scenes/shape/limbed_sphere.h"

// A generated figure with the traits of real characters, so that tests over characters also run where no
// model file is at hand. The figure is a body of tubes with two legs, eyes that cross the head at rest, and
// a shirt that is open. Lengths are in centimetres; the figure stands on z = 0 and looks towards -y.
namespace cscd::scenes {

// A limb of two bones that grows out of a square patch of the body's grid.
inline Limb figure_limb(const std::string& name, const std::string& parent, const BoxGrid::Face& face,
                        int cell_u, int cell_v, int size, int rings, const std::vector<Vec3>& joints,
                        const Parameters::Table& sections) {
  Limb limb;
  limb.name = name;
  limb.parent = parent;
  for (std::size_t i = 1; i < joints.size(); ++i)
    limb.bones.push_back(i == 1 ? name : name + "_" + std::to_string(i));
  limb.form.joints = joints;
  limb.form.sections = sections;
  limb.form.tip = 3;
  limb.face = face;
  limb.cell_u = cell_u, limb.cell_v = cell_v, limb.size = size, limb.rings = rings;
  limb.flare = 1.1, limb.collar = 4, limb.root_blend = 14, limb.blend = 0.35;
  return limb;
}

// The body at rest: 1,136 quads, closed, of genus 0. Its bones are pelvis, chest, head, and for each side
// leg, leg_2, arm and arm_2, whose names begin with left_ or right_.
inline Shape figure_body() {
  LimbedSphereParameters p;
  p.cells = 8;
  p.body.axis = 2;
  p.body.sections = {{80, 15, 10, 0, 0.6},
                     {90, 17, 11.2, 0, 1.2},
                     {108, 13.6, 9.2, 0, -0.2},
                     {131, 18, 11, 0, -0.2},
                     {147, 14, 7.2, 0, 0.8}};
  p.body.end_power = 8;
  p.body_bones = {"pelvis", "chest"};
  p.body_joints = {{0, 0.8, 92}, {0, 0, 112}, {0, 0.5, 142}};
  p.body_blend = 14;
  p.relax = 100;
  p.smooth = 4;
  const Parameters::Table leg{{0, 8.4, 9, 0, 0}, {0.5, 5.4, 5.8, 0, 0}, {1, 3.6, 4, 0, 0}},
      arm{{0, 6.4, 6.2, 0, 0}, {0.2, 5, 5.2, 0, 0}, {1, 3, 2.8, 0, 0}},
      head{{0, 6, 6, 0, 0.4}, {0.25, 5.5, 5.8, 0, 0}, {0.6, 7.4, 9.3, 0, -1}, {1, 7, 8.9, 0, 0}};
  for (const bool left : {true, false}) {
    const double side = left ? 1 : -1;
    const std::string name = left ? "left_" : "right_";
    p.limbs.push_back(figure_limb(name + "leg", "pelvis", {2, false}, left ? 5 : 0, 2, 3, 18,
                                  {{side * 9.4, 0.8, 91}, {side * 9.9, 0.2, 49}, {side * 10.3, 1, 0}}, leg));
    p.limbs.push_back(figure_limb(name + "arm", "chest", {0, left}, 3, 5, 2, 16,
                                  {{side * 13, 0.4, 134}, {side * 39, 0.4, 122}, {side * 70, -2, 108}}, arm));
  }
  p.limbs.push_back(
      figure_limb("head", "chest", {2, true}, 3, 3, 2, 8, {{0, 0.8, 142}, {0, -0.6, 176}}, head));
  p.limbs.back().form.tip = 9;
  return limbed_sphere(p);
}

// The shirt: the body's triangles around the trunk and the shoulders, moved outward by `gap` along the
// normals. It is open in front, at the waist, at the neck and at the sleeves.
inline Part figure_shirt(const Part& body, int node, double gap) {
  std::vector<Vec3> normals(body.positions.size(), Vec3::Zero());
  for (const auto& t : body.triangles) {
    const Vec3 &a = body.positions[static_cast<std::size_t>(t[0])],
               &b = body.positions[static_cast<std::size_t>(t[1])],
               &c = body.positions[static_cast<std::size_t>(t[2])];
    for (const std::int32_t corner : t) normals[static_cast<std::size_t>(corner)] += (b - a).cross(c - a);
  }
  const auto covers = [&](std::int32_t corner) {
    const Vec3& x = body.positions[static_cast<std::size_t>(corner)];
    return x.z() > 94 && x.z() < 141 && std::abs(x.x()) < 27 && !(std::abs(x.x()) < 2 && x.y() < 0);
  };
  Part shirt;
  shirt.name = "shirt";
  shirt.node = node;
  shirt.joints = body.joints;
  std::map<std::int32_t, std::int32_t> place;
  for (const auto& t : body.triangles) {
    if (!std::all_of(t.begin(), t.end(), covers)) continue;
    std::array<std::int32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [found, is_new] = place.try_emplace(t[k], static_cast<std::int32_t>(shirt.positions.size()));
      corners[k] = found->second;
      if (!is_new) continue;
      const auto v = static_cast<std::size_t>(t[k]);
      shirt.positions.push_back(body.positions[v] + gap * normals[v].normalized());
      shirt.first.push_back(shirt.influences.size());
      for (std::size_t i = body.first[v]; i < body.first[v + 1]; ++i)
        shirt.influences.push_back(body.influences[i]);
    }
    shirt.triangles.push_back(corners);
  }
  shirt.first.push_back(shirt.influences.size());
  return shirt;
}

// The whole figure. Its parts are the body, the left eye, the right eye and the shirt. It has
// two clips of one second each: in `walk` the body does not touch itself, and in `hug` its arms
// meet in front of the chest.
inline Character walking_figure() {
  const Shape body = figure_body();
  Character character;
  character.format = "test";
  character.nodes = {{"figure", -1, Transform()}, {"skin", 0, Transform()}, {"clothes", 0, Transform()}};
  const auto node_of = [&](const std::string& name) {
    const auto found = std::ranges::find(character.nodes, name, &Node::name);
    return static_cast<int>(found - character.nodes.begin());
  };

  Part skin;
  skin.name = "body";
  skin.node = 1;
  skin.positions = body.positions;
  for (std::size_t b = 0; b < body.bone_names.size(); ++b) {
    const BoneId parent = body.rig.parent[b];
    const Vec3& head = body.rig.reference[b].head;
    const int above = parent == BoneId{-1} ? 0 : node_of(body.bone_names[+parent]);
    const Vec3 origin = parent == BoneId{-1} ? Vec3::Zero() : body.rig.reference[+parent].head;
    character.nodes.push_back({body.bone_names[b], above, moved_by(head - origin)});
    skin.joints.push_back({node_of(body.bone_names[b]), moved_by(-head)});
  }
  for (const Triangle& t : body.triangles)
    skin.triangles.push_back(
        {static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]), static_cast<std::int32_t>(t[2])});
  for (const JointWeights& weights : body.weights) {
    skin.first.push_back(skin.influences.size());
    for (std::size_t k = 0; k < JointWeights::most && weights.bone[k] != BoneId{-1}; ++k)
      skin.influences.push_back({static_cast<int>(weights.bone[k]), weights.weight[k]});
  }
  skin.first.push_back(skin.influences.size());
  character.parts.push_back(skin);

  // The eyes are balls of 80 triangles that hang on the head and stick halfway in it.
  const int head = node_of("head");
  const Vec3 to_head = std::ranges::find(skin.joints, head, &Joint::node)->offset.origin;
  for (const double side : {1.0, -1.0}) {
    const test::Shape ball = test::icosphere(1, 2);
    Part eye;
    eye.name = side > 0 ? "left_eye" : "right_eye";
    eye.node = static_cast<int>(character.nodes.size());
    character.nodes.push_back({eye.name, head, moved_by(to_head + Vec3(side * 3.4, -8.6, 166))});
    eye.positions = ball.positions;
    for (const Triangle& t : ball.triangles)
      eye.triangles.push_back({static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]),
                               static_cast<std::int32_t>(t[2])});
    eye.first.assign(eye.positions.size() + 1, 0);
    character.parts.push_back(eye);
  }
  character.parts.push_back(figure_shirt(character.parts.front(), node_of("clothes"), 1));

  // Rotations in degrees about x, y and z, at equally spaced times from 0 to 1 second.
  const auto turns = [&](const std::string& bone, const std::vector<Vec3>& degrees) {
    Channel channel{node_of(bone), {}, {}, {}};
    for (std::size_t i = 0; i < degrees.size(); ++i)
      channel.rotations.push_back({static_cast<double>(i) / static_cast<double>(degrees.size() - 1),
                                   from_euler(degrees[i], {0, 1, 2})});
    return channel;
  };
  const Vec3 ahead(-25, 0, 0), behind(20, 0, 0), straight(5, 0, 0), bent(35, 0, 0);
  Animation walk{"walk", 0, 1, 0, {}};
  walk.channels = {turns("left_leg", {ahead, behind, ahead}),
                   turns("right_leg", {behind, ahead, behind}),
                   turns("left_leg_2", {straight, straight, straight, bent, straight}),
                   turns("right_leg_2", {straight, bent, straight, straight, straight}),
                   turns("left_arm", {{20, 20, 0}, {-20, 20, 0}, {20, 20, 0}}),
                   turns("right_arm", {{-20, -20, 0}, {20, -20, 0}, {-20, -20, 0}}),
                   turns("head", {{0, 0, 8}, {0, 0, -8}, {0, 0, 8}}),
                   turns("left_eye", {{0, 0, 20}, {0, 0, -20}, {0, 0, 20}}),
                   turns("right_eye", {{0, 0, 20}, {0, 0, -20}, {0, 0, 20}})};
  const Vec3 hips = body.rig.reference.front().head;
  walk.channels.push_back({node_of("pelvis"), {{0, hips}, {1, hips + Vec3(0, -90, 0)}}, {}, {}});
  Animation hug{"hug", 0, 1, 0, {}};
  hug.channels = {turns("left_arm", {{0, 0, 0}, {0, 5, -70}}), turns("left_arm_2", {{0, 0, 0}, {0, 0, -90}}),
                  turns("right_arm", {{0, 0, 0}, {0, -5, 70}}),
                  turns("right_arm_2", {{0, 0, 0}, {0, 0, 90}})};
  character.animations = {walk, hug};
  return character;
}

}  // namespace cscd::scenes
