#pragma once

#include <vector>

#include "scenes/clip/clip.h"

namespace cscd::scenes {

// For tests only: a tetrahedron whose vertices and joints move in recognisable ways.
struct SmallClip {
  std::size_t frames = 2, bones = 0;
  bool predicted = false;
};

inline Vec3 frame_position(std::size_t frame, std::size_t point) {
  const double t = static_cast<double>(frame), p = static_cast<double>(point);
  return {p / 3, t / 7 + (point == 1), (point == 2) + 0.1 * p * t};
}
inline Vec3 predicted_position(std::size_t interval, std::size_t point) {
  return frame_position(interval + 1, point) + Vec3(0, 0, 0.3);
}

inline Clip small_clip(const SmallClip& what) {
  ClipHeader header;
  header.vertex_count = 4;
  const auto triangle = [](int a, int b, int c) { return Triangle{VertexId{a}, VertexId{b}, VertexId{c}}; };
  header.triangles = {triangle(0, 2, 1), triangle(0, 1, 3), triangle(1, 2, 3), triangle(2, 0, 3)};
  for (std::size_t bone = 0; bone < what.bones; ++bone)
    header.bone_parent.push_back(BoneId{static_cast<std::int32_t>(bone) - 1});
  header.predicted = what.predicted;
  Clip clip(header);
  for (std::size_t frame = 0; frame < what.frames; ++frame) {
    std::vector<Vec3> positions[2];
    std::vector<Bone> bones[2];
    for (const bool predicted : {false, true}) {
      const auto at = [&](std::size_t point) {
        return predicted ? predicted_position(frame - 1, point) : frame_position(frame, point);
      };
      for (std::size_t vertex = 0; vertex < header.vertex_count; ++vertex)
        positions[predicted].push_back(at(vertex));
      for (std::size_t bone = 0; bone < what.bones; ++bone)
        bones[predicted].push_back({at(100 + 2 * bone), at(101 + 2 * bone)});
    }
    const FrameView predicted{positions[1], bones[1]};
    clip.append({positions[0], bones[0]}, what.predicted && frame > 0 ? &predicted : nullptr);
  }
  return clip;
}

}  // namespace cscd::scenes
