#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "scenes/catalog/scene.h"
#include "scenes/shape/shape.h"

// Makes a scene with more or fewer triangles and the same motion. Bones move alike whatever surface hangs
// on them. So they are moved once, and then move surfaces of any resolution on the frames that are wanted.
namespace cscd::scenes {

// The bones of a scene in one frame.
struct BonePose {
  std::size_t frame = 0;
  std::vector<Bone> bones;
  std::vector<Eigen::Matrix3d> rotations;  // [bones]; rotation of each bone from its reference pose
};

// Returns the number of triangles of the scene's own shape.
std::size_t triangle_count(const Scene& scene);

// Returns the scene's shape with about this many triangles. The shape is built with other counts of cells.
// Shapes of a body with limbs that shall be finer than the scene's own resolution are refined by Loop's
// subdivision instead. Throws InputError if the shape cannot be built so coarse.
Shape resized_shape(const Scene& scene, std::size_t triangles);

// Returns the poses in these frames, which must ascend. Throws InputError for a scene whose surface acts
// back on its steps (contact_response), and for a frame that the scene does not have.
std::vector<BonePose> poses_at(const Scene& scene, std::span<const std::size_t> frames);

// Returns the positions, [vertices], to which the scene's surface effects move `shape` in a pose.
std::vector<Vec3> carried(const Scene& scene, const Shape& shape, const BonePose& pose);

}  // namespace cscd::scenes
