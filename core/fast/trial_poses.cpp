#include "core/fast/trial_poses.h"

#include <Eigen/Geometry>
#include <functional>
#include <numbers>
#include <random>

#include "core/base/random.h"
#include "core/geometry/simd_floats.h"

namespace cscd::fast {
namespace {

constexpr double kTurned = std::numbers::pi / 9, kFurther = std::numbers::pi / 36;
constexpr int kSmoothed = 8;  // the number of times that turns are smoothed over the seams

using Transforms = std::vector<Eigen::Isometry3d>;

// The turn of every bone, its parent's turns included.
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

// How far a vertex is moved at both ends of a trial: x, y, z and an unused number each.
using Shift = Float8;

// Moves each vertex by the mean of what the bones of the triangles at the vertex would move it by.
std::vector<Shift> turned_shifts(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                 std::span<const BoneId> bone_of, const std::array<Transforms, 2>& turns) {
  std::vector<Shift> shifts(reference.size());
  for (std::size_t v = 0; v < shifts.size(); ++v) {
    const auto around = mesh.triangles_at(VertexId{static_cast<std::int32_t>(v)});
    for (std::size_t end = 0; end < 2; ++end) {
      Vec3 sum = Vec3::Zero(), one = Vec3::Zero();
      BoneId last{-1};
      for (const TriangleId t : around) {
        if (bone_of[+t] != last) one = turns[end][+bone_of[+t]] * reference[v] - reference[v];
        last = bone_of[+t];
        sum += one / static_cast<double>(around.size());
      }
      for (std::size_t i = 0; i < 3; ++i)
        shifts[v][4 * end + i] = static_cast<float>(sum[static_cast<int>(i)]);
    }
  }
  return shifts;
}

// The neighbours of each vertex, in compressed rows. On a closed and oriented surface each neighbour is a
// corner of two of the triangles at the vertex, and comes behind the vertex in one of them.
struct Neighbours {
  std::vector<std::int32_t> of;
  std::vector<std::size_t> first{0};

  explicit Neighbours(const TriangleMesh& mesh) {
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      const VertexId vertex{static_cast<std::int32_t>(v)};
      for (const TriangleId t : mesh.triangles_at(vertex)) {
        const Triangle& c = mesh.corners(t);
        of.push_back(+c[c[0] == vertex ? 1 : c[1] == vertex ? 2 : 0]);
      }
      first.push_back(of.size());
    }
  }
};

// Replaces every shift by the mean over the corners of the triangles at the vertex, again and again.
void smooth(const Neighbours& neighbours, std::vector<Shift>& shifts) {
  const auto& [of, first] = neighbours;
  std::vector<Shift> before(shifts.size());
  for (int i = 0; i < kSmoothed; ++i) {
    before.swap(shifts);
    for (std::size_t v = 0; v < shifts.size(); ++v) {
      Shift sum{};
      for (std::size_t k = first[v]; k < first[v + 1]; ++k) sum += before[static_cast<std::size_t>(of[k])];
      const std::size_t count = first[v + 1] - first[v];
      shifts[v] = count == 0 ? before[v] : (before[v] + sum * (2 / static_cast<float>(count))) / 3.0F;
    }
  }
}

}  // namespace

std::vector<PosePair> trial_poses(const TriangleMesh& mesh, std::span<const Vec3> reference, const Rig& rig,
                                  std::span<const BoneId> bone_of, std::size_t count) {
  std::mt19937 random(kPreparationSeed);
  const auto dice = [&] { return static_cast<double>(random() >> 8) * 0x1p-23 - 1; };
  const Neighbours neighbours(mesh);
  std::vector<PosePair> trials;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<Vec3> axes;
    for (std::size_t b = 0; b < rig.parent.size(); ++b) {
      Vec3 axis;
      for (int k = 0; k < 3; ++k) axis[k] = dice();
      axes.push_back(axis.squaredNorm() > 0 ? axis.normalized() : Vec3(Vec3::UnitX()));
    }
    std::vector<Shift> shifts = turned_shifts(
        mesh, reference, bone_of, {turned(rig, axes, kTurned), turned(rig, axes, kTurned + kFurther)});
    smooth(neighbours, shifts);
    PosePair& trial = trials.emplace_back();
    for (std::size_t end = 0; end < 2; ++end)
      for (std::size_t v = 0; v < shifts.size(); ++v)
        trial[end].push_back(reference[v] +
                             Vec3(shifts[v][4 * end], shifts[v][4 * end + 1], shifts[v][4 * end + 2]));
  }
  return trials;
}

}  // namespace cscd::fast
