#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "scenes/catalog/scene.h"
#include "scenes/shape/shape.h"

// A scene with more or fewer triangles in the same motion. Bones move alike whatever they carry, so they are
// moved once, and carry surfaces of any resolution on the frames that are wanted.
namespace cscd::scenes {

// The bones of a scene at one frame.
struct Pose {
  std::size_t frame = 0;
  std::vector<Bone> bones;
  std::vector<Eigen::Matrix3d> rotations;  // of each bone, from its reference pose
};

// How many triangles the scene's own shape has.
std::size_t triangle_count(const Scene& scene);

// The scene's shape with about so many triangles: built with other counts of cells, and for body and limbs
// above the scene's own resolution by Loop's subdivision from there on. Throws InputError where the shape
// cannot be built so coarse.
Shape resized_shape(const Scene& scene, std::size_t triangles);

// Poses at these frames, in increasing order. Throws InputError for a scene whose surface acts back on its
// steps (contact_response), and for a frame that it does not have.
std::vector<Pose> poses_at(const Scene& scene, std::span<const std::size_t> frames);

// Where the scene's surface effects bring a shape of it in a pose: its positions [vertices].
std::vector<Vec3> carried(const Scene& scene, const Shape& shape, const Pose& pose);

}  // namespace cscd::scenes
