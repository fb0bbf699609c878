#include <algorithm>

#include "scenes/effects/effect.h"

namespace cscd::scenes {
namespace {

// Restores the volume that skinning loses where bones bend. There the surface bulges along its normals, or
// shrinks if skinning has gained volume. For a vertex with weights w, the displacement is
//   s sum over joints of 4 w_b w_p sin^2(turn between b and p / 2),
// where a joint is between a bone b and its parent p. The displacement is largest half-way between two
// bones that are folded on each other, and 0 if no bone bends. The common factor s restores the volume at
// rest to first order; it is limited so that no vertex moves by more than `most`.
//
// The method is ours. The idea of spreading a correction of the volume over the vertices by weights is from
// Rohmer, Hahmann, Cani, "Exact volume preserving skinning with shape control", SCA 2009, who solve for it
// exactly. The effect runs after skinning.
class VolumeBulge final : public Effect {
 public:
  VolumeBulge(const Parameters& p, const Shape& shape)
      : share_(p.number("share")),
        most_(p.number("most")),
        at_rest_(volume(shape.triangles, shape.positions)) {}

  void step(SceneState& state) override {
    const Shape& shape = state.shape;
    bend_.assign(shape.rig.parent.size(), 0);
    for (std::size_t bone = 0; bone < bend_.size(); ++bone)
      if (shape.rig.parent[bone] != BoneId{-1})
        bend_[bone] = bend(state.rotations[+shape.rig.parent[bone]], state.rotations[bone]);

    // The derivative of the volume by each vertex is a third of the sum of the area vectors round the vertex.
    gradient_.assign(state.positions.size(), Vec3::Zero());
    for (const Triangle& t : shape.triangles) {
      const Vec3& a = state.positions[+t[0]];
      const Vec3 sixth = (state.positions[+t[1]] - a).cross(state.positions[+t[2]] - a) / 6;
      for (const VertexId vertex : t) gradient_[+vertex] += sixth;
    }
    double gain = 0, largest = 0;  // gain in volume and largest displacement for s = 1
    for (std::size_t vertex = 0; vertex < gradient_.size(); ++vertex) {
      const double amount = bulge(shape, shape.weights[vertex]);
      const double area = gradient_[vertex].norm();
      gain += area * amount;
      largest = std::max(largest, amount);
      if (area > 0) gradient_[vertex] *= amount / area;
    }
    if (!(gain > 0)) return;
    const double limit = most_ / largest;
    const double lost = at_rest_ - volume(shape.triangles, state.positions);
    const double s = std::clamp(share_ * lost / gain, -limit, limit);
    for (std::size_t vertex = 0; vertex < gradient_.size(); ++vertex)
      state.positions[vertex] += s * gradient_[vertex];
  }

 private:
  // sin^2 of half the angle between two rotations, from the trace of their quotient.
  static double bend(const Eigen::Matrix3d& parent, const Eigen::Matrix3d& bone) {
    double trace = 0;
    for (int column = 0; column < 3; ++column) trace += parent.col(column).dot(bone.col(column));
    return std::clamp((3 - trace) / 4, 0.0, 1.0);
  }

  // The displacement of a vertex for s = 1.
  double bulge(const Shape& shape, const JointWeights& weights) const {
    double sum = 0;
    for (std::size_t k = 0; k < JointWeights::most && weights.bone[k] != BoneId{-1}; ++k) {
      const BoneId parent = shape.rig.parent[+weights.bone[k]];
      for (std::size_t l = 0; l < JointWeights::most; ++l)
        if (parent != BoneId{-1} && weights.bone[l] == parent)
          sum += 4 * weights.weight[k] * weights.weight[l] * bend_[+weights.bone[k]];
    }
    return sum;
  }

  static double volume(std::span<const Triangle> triangles, std::span<const Vec3> positions) {
    const Vec3& origin = positions[0];
    double six = 0;
    for (const Triangle& t : triangles)
      six += (positions[+t[0]] - origin).dot((positions[+t[1]] - origin).cross(positions[+t[2]] - origin));
    return six / 6;
  }

  double share_, most_, at_rest_;
  std::vector<double> bend_;    // [bones]
  std::vector<Vec3> gradient_;  // [vertices]; turned into the displacements for s = 1
};

}  // namespace

EffectRow volume_bulge_row() {
  static const ParameterRow rows[] = {
      number_row("most", "length", "largest displacement of a vertex", {0, 1e9}),
      number_row("share", "", "share of the lost volume that is given back", {0, 1}).or_else({1}),
  };
  return {"volume_bulge", "gives back the volume that skinning loses, by bulging where bones bend",
          Pace::frame, rows, make_effect<VolumeBulge>};
}

}  // namespace cscd::scenes
