#include "core/fast/trial_poses.h"

#include <Eigen/Geometry>
#include <functional>
#include <numbers>
#include <random>

#include "core/base/random.h"

namespace cscd::fast {
namespace {

constexpr double kTurned = std::numbers::pi / 6, kFurther = std::numbers::pi / 36;
constexpr int kSmoothed = 8;  // times that the shifts of vertices are smoothed

using Transforms = std::vector<Eigen::Isometry3d>;

// Returns the transform of every bone, [bones]: a turn about its own joint, followed by those of its parents.
Transforms turned(const Rig& rig, std::span<const Vec3> axes, double angle) {
  const std::size_t count = rig.parent.size();
  Transforms transforms(count);
  std::vector<bool> known(count, false);
  const std::function<const Eigen::Isometry3d&(std::size_t)> of =
      [&](std::size_t bone) -> const Eigen::Isometry3d& {
    if (known[bone]) return transforms[bone];
    const Vec3& joint = rig.reference[bone].head;
    const Eigen::Isometry3d own =
        Eigen::Translation3d(joint) * Eigen::AngleAxisd(angle, axes[bone]) * Eigen::Translation3d(-joint);
    const BoneId parent = rig.parent[bone];
    transforms[bone] = +parent < rig.parent.size() ? of(+parent) * own : own;
    known[bone] = true;
    return transforms[bone];
  };
  for (std::size_t bone = 0; bone < count; ++bone) of(bone);
  return transforms;
}

std::vector<Vec3> moved(const TriangleMesh& mesh, std::span<const Vec3> reference,
                        std::span<const BoneId> bone_of, const Transforms& transforms) {
  std::vector<Vec3> shift(reference.size(), Vec3::Zero());
  for (std::size_t v = 0; v < shift.size(); ++v) {
    const auto around = mesh.triangles_at(VertexId{static_cast<std::int32_t>(v)});
    for (const TriangleId t : around)
      shift[v] +=
          (transforms[+bone_of[+t]] * reference[v] - reference[v]) / static_cast<double>(around.size());
  }
  std::vector<Vec3> sum(mesh.triangle_count());  // [triangles]; of the shifts of its corners
  for (int i = 0; i < kSmoothed; ++i) {
    for (std::size_t t = 0; t < sum.size(); ++t) {
      const Triangle& c = mesh.triangles()[t];
      sum[t] = shift[+c[0]] + shift[+c[1]] + shift[+c[2]];
    }
    for (std::size_t v = 0; v < shift.size(); ++v) {
      const auto around = mesh.triangles_at(VertexId{static_cast<std::int32_t>(v)});
      if (around.empty()) continue;
      shift[v].setZero();
      for (const TriangleId t : around) shift[v] += sum[+t] / static_cast<double>(3 * around.size());
    }
  }
  for (std::size_t v = 0; v < shift.size(); ++v) shift[v] += reference[v];
  return shift;
}

}  // namespace

std::vector<Trial> trial_poses(const TriangleMesh& mesh, std::span<const Vec3> reference, const Rig& rig,
                               std::span<const BoneId> bone_of, std::size_t count) {
  std::mt19937 random(kPreparationSeed);
  const auto dice = [&] { return static_cast<double>(random() >> 8) * 0x1p-23 - 1; };
  std::vector<Trial> trials;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<Vec3> axes;
    for (std::size_t b = 0; b < rig.parent.size(); ++b) {
      Vec3 axis;
      for (int k = 0; k < 3; ++k) axis[k] = dice();
      axes.push_back(axis.squaredNorm() > 0 ? axis.normalized() : Vec3(Vec3::UnitX()));
    }
    Trial& trial = trials.emplace_back();
    for (std::size_t end = 0; end < 2; ++end)
      trial[end] = moved(mesh, reference, bone_of, turned(rig, axes, kTurned + (end == 0 ? 0 : kFurther)));
  }
  return trials;
}

}  // namespace cscd::fast
