#include "scenes/catalog/resized.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "scenes/catalog/shapes.h"
#include "scenes/effects/sequence.h"
#include "scenes/shape/subdivide.h"

namespace cscd::scenes {
namespace {

// The scene's own resolution is used for numbers of triangles within this factor of it.
constexpr double kOwn = 1.1;

const EffectRow* row_of(const EffectCall& call) {
  for (const EffectRow& row : effects())
    if (row.name == call.name) return &row;
  return nullptr;
}

// Returns the effects of one pace. Effects that move bones run in substeps, and effects that move the
// surface run once a frame.
std::vector<EffectCall> calls_of(const Scene& scene, Pace pace) {
  std::vector<EffectCall> calls;
  for (const EffectCall& call : scene.effects) {
    const EffectRow* row = row_of(call);
    if (row && (row->predicts || row->of_surface))
      throw InputError("scene " + scene.name + ": its effect " + call.name +
                       " changes the motion by the surface; name a scene without it");
    if (!row || row->pace == pace) calls.push_back(call);  // the sequence refuses an unknown effect
  }
  return calls;
}

Shape built(const Scene& scene, double factor) {
  if (factor == 1) return make_shape(scene.shape, scene.shape_parameters);
  const ShapeRow& row = shape_row(scene.shape, scene.shape_parameters);
  return make_shape(scene.shape, row.at_resolution(scene.shape_parameters, factor));
}

}  // namespace

std::size_t triangle_count(const Scene& scene) {
  if (scene.expected.triangles) return *scene.expected.triangles;
  return make_shape(scene.shape, scene.shape_parameters).triangles.size();
}

Shape resized_shape(const Scene& scene, std::size_t triangles) {
  double share = static_cast<double>(triangles) / static_cast<double>(triangle_count(scene));
  int steps = 0;
  if (shape_row(scene.shape, scene.shape_parameters).settles)
    for (; share > kOwn; share /= 4) ++steps;
  if (share > 1 / kOwn && share < kOwn) share = 1;
  Shape shape = built(scene, std::sqrt(share));
  for (; steps > 0; --steps) shape = subdivided(shape);
  return shape;
}

std::vector<BonePose> poses_at(const Scene& scene, std::span<const std::size_t> frames) {
  const Shape shape = make_shape(scene.shape, scene.shape_parameters);
  EffectSequence skeleton(calls_of(scene, Pace::substep), shape, scene.substeps);
  SceneState state(shape);
  std::vector<BonePose> poses;
  std::size_t at = 0;
  for (const std::size_t frame : frames) {
    if (frame >= scene.frames || frame < at)
      throw InputError("scene " + scene.name + ": frame " + std::to_string(frame) + " is not among its " +
                       std::to_string(scene.frames) + " frames, or out of order; ask for others");
    while (at < frame) skeleton.advance(state, static_cast<int>(++at));
    poses.push_back({frame, state.bones, state.rotations});
  }
  return poses;
}

std::vector<Vec3> carried(const Scene& scene, const Shape& shape, const BonePose& pose) {
  SceneState state(shape);
  if (pose.frame == 0) return std::move(state.positions);
  state.bones = pose.bones;
  state.rotations = pose.rotations;
  EffectSequence surface(calls_of(scene, Pace::frame), shape, 1);
  surface.advance(state, static_cast<int>(pose.frame));
  return std::move(state.positions);
}

}  // namespace cscd::scenes
