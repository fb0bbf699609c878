#include "core/radial/heat_weights.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

// Bone heat (Baran and Popovic, "Automatic Rigging and Animation of 3D Characters", SIGGRAPH 2007, section
// 4). The surface conducts heat, and each vertex is pulled to the temperature of the bones that it sees. The
// weight of bone i is the temperature in equilibrium when bone i is at 1 and all other bones are at 0:
//   (-Laplacian + H) w_i = H p_i,   H_jj = c / d_j^2,
// where p_ij = 1 / k if bone i is one of the k bones of vertex j, at distance d_j, and 0 otherwise.
//
// In the paper, k equally near bones pull k times as hard. Here H does not depend on k, so that the rounding
// that decides a tie cannot change the matrix. Both sides are multiplied by the vertex areas A, which makes
// the matrix symmetric:
//   (L + A H) w_i = A H p_i,   L the cotangent matrix.
//
// Edge weights are kept positive, so that the matrix is an M-matrix, whose inverse has no negative entries.
// So weights stay in [0, 1] and sum to 1 even where triangles are obtuse or degenerate.
//
// Cost: one sparse Cholesky factorisation, and one pair of triangular solves for eight bones at a time,
// because reading the factor takes longer than computing with it. Memory holds the weights of eight bones.

namespace cscd::radial {
namespace {

// The c of the formula, which is 1 in the paper too.
constexpr double kHeat = 1;
// Bounds of an edge's weight, (cot + cot) / 2. The upper bound treats angles below half a tenth of a degree
// alike. The lower bound lets the edge of a non-Delaunay pair conduct a little.
constexpr double kWeakestEdge = 1e-3, kStrongestEdge = 1e3;
// Upper bound of A H, which has no unit. At a vertex with that value, the weights are those of its own bones
// within 1e-3 even against the strongest edges, and the matrix stays well conditioned.
constexpr double kStiffest = 1e6;
// A bone farther away than this many diagonals of the component's box is treated as being at this distance.
constexpr double kFarthest = 100;
// Lower bound of a vertex's area, as a share of the squared diagonal of its component divided by the
// component's number of vertices. On any ordinary surface vertices have more.
constexpr double kLeastArea = 1e-6;

using Matrix = Eigen::SparseMatrix<double>;
using Factor = Eigen::SimplicialLLT<Matrix, Eigen::Lower>;
constexpr int kTogether = 8;  // so many right sides are solved for at a time
using Sides = Eigen::Matrix<double, Eigen::Dynamic, kTogether, Eigen::RowMajor>;

// Returns half the cotangent of the angle at `tip`. For a degenerate triangle the result is infinite or NaN.
double half_cotangent(const Vec3& tip, const Vec3& a, const Vec3& b) {
  const Vec3 u = a - tip, v = b - tip;
  return u.dot(v) / u.cross(v).norm() / 2;
}

std::vector<double> edge_weights(const TriangleMesh& mesh, std::span<const Vec3> positions) {
  std::vector<double> weight(mesh.edge_count(), 0);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const TriangleId id{static_cast<std::int32_t>(t)};
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle& c = mesh.corners(id);
      weight[+mesh.edges_of(id)[k]] +=
          half_cotangent(positions[+c[(k + 2) % 3]], positions[+c[k]], positions[+c[(k + 1) % 3]]);
    }
  }
  for (double& w : weight) w = std::isnan(w) ? kWeakestEdge : std::clamp(w, kWeakestEdge, kStrongestEdge);
  return weight;
}

// Returns a third of the area of the triangles at each vertex, [vertices], but at least the lower bound
// above; 0 for a vertex without triangles.
std::vector<double> vertex_areas(const TriangleMesh& mesh, std::span<const Vec3> positions,
                                 std::span<const double> diagonal, std::span<const std::int32_t> component) {
  std::vector<double> area(mesh.vertex_count(), 0);
  for (const Triangle& c : mesh.triangles()) {
    const Vec3& a = positions[+c[0]];
    const double sixth = (positions[+c[1]] - a).cross(positions[+c[2]] - a).norm() / 6;
    for (const VertexId v : c) area[+v] += sixth;
  }
  std::vector<double> vertices(diagonal.size(), 0);
  for (const std::int32_t c : component)
    if (c >= 0) ++vertices[static_cast<std::size_t>(c)];
  for (std::size_t v = 0; v < area.size(); ++v) {
    if (component[v] < 0) continue;
    const auto c = static_cast<std::size_t>(component[v]);
    area[v] = std::max(area[v], kLeastArea * diagonal[c] * diagonal[c] / vertices[c]);
  }
  return area;
}

// Returns the diagonal of each component's box, [components]; 1 for a component that is a single point.
std::vector<double> component_diagonals(const TriangleMesh& mesh, std::span<const Vec3> positions) {
  std::vector<Eigen::AlignedBox3d> box(static_cast<std::size_t>(mesh.component_count()));
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const TriangleId id{static_cast<std::int32_t>(t)};
    for (const VertexId v : mesh.corners(id))
      box[static_cast<std::size_t>(mesh.component(id))].extend(positions[+v]);
  }
  std::vector<double> diagonal;
  for (const Eigen::AlignedBox3d& b : box) {
    const double length = b.diagonal().norm();
    diagonal.push_back(length > 0 ? length : 1);
  }
  return diagonal;
}

// Returns the diagonal of A H, [vertices]: how strongly its bones pull on each vertex.
Eigen::VectorXd pulls(const TriangleMesh& mesh, std::span<const Vec3> positions,
                      const VisibleBones& visible) {
  std::vector<std::int32_t> component(mesh.vertex_count(), -1);
  for (std::size_t v = 0; v < component.size(); ++v)
    if (const auto around = mesh.triangles_at(VertexId{static_cast<std::int32_t>(v)}); !around.empty())
      component[v] = mesh.component(around.front());
  const std::vector<double> diagonal = component_diagonals(mesh, positions);
  const std::vector<double> area = vertex_areas(mesh, positions, diagonal, component);

  Eigen::VectorXd pull = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh.vertex_count()));
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    if (component[v] < 0 || visible.of(v).empty()) continue;
    const double d =
        std::min(visible.distance[v], kFarthest * diagonal[static_cast<std::size_t>(component[v])]);
    pull[static_cast<Eigen::Index>(v)] = std::min(kHeat * area[v] / (d * d), kStiffest);
  }
  return pull;
}

// Returns the lower half of L + A H.
Matrix system_matrix(const TriangleMesh& mesh, std::span<const Vec3> positions, const Eigen::VectorXd& pull) {
  const std::vector<double> weight = edge_weights(mesh, positions);
  Eigen::VectorXd diagonal = pull;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(mesh.edge_count() + mesh.vertex_count());
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    const Edge& ends = mesh.ends(EdgeId{static_cast<std::int32_t>(e)});
    const auto smaller = static_cast<int>(ends[0]), larger = static_cast<int>(ends[1]);
    entries.emplace_back(larger, smaller, -weight[e]);
    diagonal[smaller] += weight[e];
    diagonal[larger] += weight[e];
  }
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const auto i = static_cast<int>(v);
    // A vertex without triangles has the equation 1 w = 0 of its own.
    entries.emplace_back(i, i, mesh.triangles_at(VertexId{i}).empty() ? 1 : diagonal[i]);
  }
  const auto n = static_cast<Eigen::Index>(mesh.vertex_count());
  Matrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// A vertex that a bone heats directly, with the bone's share of it: p_ij above.
struct Heated {
  BoneId bone;
  std::int32_t vertex;
  double share;
};

std::vector<Heated> heated_by_bone(const VisibleBones& visible) {
  std::vector<Heated> heated;
  heated.reserve(visible.bones.size());
  for (std::size_t v = 0; v + 1 < visible.offset.size(); ++v) {
    const std::span<const BoneId> bones = visible.of(v);
    for (const BoneId b : bones)
      heated.push_back({b, static_cast<std::int32_t>(v), 1 / static_cast<double>(bones.size())});
  }
  std::stable_sort(heated.begin(), heated.end(),
                   [](const Heated& x, const Heated& y) { return x.bone < y.bone; });
  return heated;
}

// Solves for all columns of `sides` in place. Eigen's own solve() takes one column after the other.
void solve(const Factor& factor, Sides& sides) {
  const Matrix& lower = factor.matrixL().nestedExpression();
  Sides x = factor.permutationP() * sides;
  for (Eigen::Index j = 0; j < lower.cols(); ++j) {
    Matrix::InnerIterator entry(lower, j);  // the diagonal comes first
    x.row(j) /= entry.value();
    while (++entry) x.row(entry.row()) -= entry.value() * x.row(j);
  }
  for (Eigen::Index j = lower.cols(); j-- > 0;) {
    Matrix::InnerIterator entry(lower, j);
    const double diagonal = entry.value();
    Eigen::Matrix<double, 1, kTogether> sum = x.row(j);
    while (++entry) sum -= entry.value() * x.row(entry.row());
    x.row(j) = sum / diagonal;
  }
  sides = factor.permutationPinv() * x;
}

}  // namespace

bool diffuse_heat(const TriangleMesh& mesh, std::span<const Vec3> positions, const VisibleBones& visible,
                  const TakeWeights& take) {
  const Eigen::VectorXd pull = pulls(mesh, positions, visible);
  const Factor factor(system_matrix(mesh, positions, pull));
  if (factor.info() != Eigen::Success) return false;

  const std::vector<Heated> heated = heated_by_bone(visible);
  Sides sides(pull.size(), kTogether);
  for (std::size_t i = 0; i < heated.size();) {
    sides.setZero();
    std::vector<BoneId> bones;  // of the columns
    for (; i < heated.size(); ++i) {
      const auto& [bone, vertex, share] = heated[i];
      if (bones.empty() || bones.back() != bone) {
        if (bones.size() == kTogether) break;
        bones.push_back(bone);
      }
      sides(vertex, static_cast<Eigen::Index>(bones.size()) - 1) = pull[vertex] * share;
    }
    solve(factor, sides);
    for (std::size_t b = 0; b < bones.size(); ++b) {
      const Eigen::VectorXd weights = sides.col(static_cast<Eigen::Index>(b));
      take(bones[b], weights);
    }
  }
  return true;
}

}  // namespace cscd::radial
