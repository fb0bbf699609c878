#pragma once

#include "core/mesh/test_shapes.h"
#include "scenes/character/character.h"

namespace cscd::scenes {

inline Transform moved_by(const Vec3& by) {
  Transform map;
  map.origin = by;
  return map;
}

// A quarter turn about z, then a move.
inline Transform quarter_turn(const Vec3& move = Vec3::Zero()) {
  return {{Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1)}, move};
}

// A tube along x from 0 to 4 on two joints: `lower` at x = 0 and `upper` at x = 2, under a root that stands
// at (0, 0, 5). Vertices below x = 1.5 follow the lower joint, vertices beyond 2.5 the upper joint, and both
// joints share the vertices between. The clip 'bend' turns the upper joint by a quarter turn in one second.
inline Character bending_tube(int sides = 8, int rings = 16) {
  const test::Shape tube = test::capped_tube(sides, rings, 0.5, 4);
  Character character;
  character.nodes = {{"root", -1, moved_by({0, 0, 5})},
                     {"tube", 0, Transform()},
                     {"lower", 0, Transform()},
                     {"helper", 2, moved_by({1, 0, 0})},
                     {"upper", 3, moved_by({1, 0, 0})}};
  Part part;
  part.name = "tube";
  part.node = 1;
  part.positions = tube.positions;
  for (const Triangle& t : tube.triangles)
    part.triangles.push_back(
        {static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]), static_cast<std::int32_t>(t[2])});
  part.joints = {{2, Transform()}, {4, moved_by({-2, 0, 0})}};
  for (const Vec3& x : part.positions) {
    const double upper = std::clamp(x.x() - 1.5, 0.0, 1.0);
    part.first.push_back(part.influences.size());
    if (upper < 1) part.influences.push_back({0, 1 - upper});
    if (upper > 0) part.influences.push_back({1, upper});
  }
  part.first.push_back(part.influences.size());
  character.parts.push_back(part);
  const double half = std::sqrt(0.5);
  character.animations = {
      {"bend", 0, 1, 0, {{4, {}, {{0, Quaternion{}}, {1, Quaternion{half, 0, 0, half}}}, {}}}}};
  character.format = "test";
  return character;
}

}  // namespace cscd::scenes
