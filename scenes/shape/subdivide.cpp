#include "scenes/shape/subdivide.h"

#include <algorithm>

namespace cscd::scenes {
namespace {

// A weighted mean of vertices: of their positions and of their skinning weights.
class Mean {
 public:
  explicit Mean(const Shape& shape) : shape_(shape) {}

  void add(VertexId vertex, double share) {
    position_ += share * shape_.positions[+vertex];
    const JointWeights& weights = shape_.weights[+vertex];
    for (std::size_t k = 0; k < JointWeights::most && weights.bone[k] != BoneId{-1}; ++k) {
      const BoneId bone = weights.bone[k];
      auto place = std::ranges::find(bones_, bone, &Bones::value_type::second);
      if (place == bones_.end()) place = bones_.insert(bones_.end(), {0, bone});
      place->first += share * weights.weight[k];
    }
  }

  void append_to(Shape& out) {
    std::ranges::sort(bones_, [](const auto& a, const auto& b) {
      return a.first > b.first || (a.first == b.first && a.second < b.second);
    });
    bones_.resize(std::min(bones_.size(), JointWeights::most));
    double sum = 0;
    for (const auto& [weight, bone] : bones_) sum += weight;
    JointWeights weights;
    for (std::size_t k = 0; k < bones_.size(); ++k) {
      weights.bone[k] = bones_[k].second;
      weights.weight[k] = bones_[k].first / sum;
    }
    out.positions.push_back(position_);
    out.weights.push_back(weights);
  }

 private:
  using Bones = std::vector<std::pair<double, BoneId>>;
  const Shape& shape_;
  Vec3 position_ = Vec3::Zero();
  Bones bones_;
};

VertexId opposite(const TriangleMesh& mesh, TriangleId triangle, const Edge& edge) {
  const Triangle& corners = mesh.corners(triangle);
  return *std::ranges::find_if(corners, [&](VertexId v) { return v != edge[0] && v != edge[1]; });
}

}  // namespace

Shape subdivided(const Shape& shape) {
  const TriangleMesh mesh(shape.triangles, shape.positions.size(), "subdivision");
  require_closed_and_oriented(mesh, "subdivision");
  Shape fine;
  fine.rig = shape.rig;
  fine.bone_names = shape.bone_names;
  const std::size_t old = mesh.vertex_count();
  fine.positions.reserve(old + mesh.edge_count());
  fine.weights.reserve(old + mesh.edge_count());

  for (std::size_t i = 0; i < old; ++i) {
    const VertexId vertex{static_cast<int>(i)};
    const auto around = mesh.triangles_at(vertex);
    const auto valence = static_cast<double>(around.size());
    const double share = around.size() == 3 ? 3.0 / 16 : 3 / (8 * valence);
    Mean mean(shape);
    mean.add(vertex, 1 - valence * share);
    for (const TriangleId triangle : around) {  // every neighbour is the next corner in one triangle
      const Triangle& corners = mesh.corners(triangle);
      const auto own = static_cast<std::size_t>(std::ranges::find(corners, vertex) - corners.begin());
      mean.add(corners[(own + 1) % 3], share);
    }
    mean.append_to(fine);
  }
  for (std::size_t i = 0; i < mesh.edge_count(); ++i) {
    const EdgeId id{static_cast<int>(i)};
    const Edge& edge = mesh.ends(id);
    Mean mean(shape);
    for (const VertexId end : edge) mean.add(end, 3.0 / 8);
    for (const TriangleId side : mesh.triangles_at(id)) mean.add(opposite(mesh, side, edge), 1.0 / 8);
    mean.append_to(fine);
  }
  fine.triangles.reserve(4 * mesh.triangle_count());
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const TriangleId triangle{static_cast<int>(i)};
    const auto& [a, b, c] = mesh.corners(triangle);
    std::array<VertexId, 3> mid;
    for (std::size_t k = 0; k < 3; ++k)
      mid[k] = VertexId{static_cast<int>(old + +mesh.edges_of(triangle)[k])};
    fine.triangles.push_back({a, mid[0], mid[2]});
    fine.triangles.push_back({mid[0], b, mid[1]});
    fine.triangles.push_back({mid[2], mid[1], c});
    fine.triangles.push_back({mid[0], mid[1], mid[2]});
  }
  return fine;
}

}  // namespace cscd::scenes
