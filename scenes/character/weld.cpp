#include "scenes/character/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace cscd::scenes {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t i : cell) {
      hash = (hash ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

// The groups met so far, found through the cells of a grid whose cells are as wide as the tolerance.
class Grid {
 public:
  Grid(std::span<const Vec3> positions, double tolerance) : positions_(positions), tolerance_(tolerance) {
    // A cell must not be smaller than the coordinates' rounding, or cell numbers would tell equal numbers
    // apart, or overflow.
    double largest = 0;
    for (const Vec3& x : positions) largest = std::max(largest, x.cwiseAbs().maxCoeff());
    cell_ = std::max({tolerance, largest * 1e-15, std::numeric_limits<double>::min()});
  }

  // Returns the smallest of the points that lead a group and lie within the tolerance of `point`. Where
  // there is none, the point leads a new group, and its own index is returned.
  std::int32_t group_of(std::int32_t point) {
    const Vec3& x = positions_[static_cast<std::size_t>(point)];
    const Cell cell = cell_of(x);
    std::int32_t found = point;
    for (std::int64_t i = -1; i <= 1; ++i)
      for (std::int64_t j = -1; j <= 1; ++j)
        for (std::int64_t k = -1; k <= 1; ++k) {
          const auto near = groups_.find({cell[0] + i, cell[1] + j, cell[2] + k});
          if (near == groups_.end()) continue;
          for (const std::int32_t other : near->second)
            if (other < found && (positions_[static_cast<std::size_t>(other)] - x).norm() <= tolerance_)
              found = other;
        }
    if (found == point) groups_[cell].push_back(point);
    return found;
  }

 private:
  Cell cell_of(const Vec3& x) const {
    Cell cell;
    for (int axis = 0; axis < 3; ++axis)
      cell[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::floor(x[axis] / cell_));
    return cell;
  }

  std::span<const Vec3> positions_;
  double tolerance_, cell_;
  std::unordered_map<Cell, std::vector<std::int32_t>, CellHash> groups_;
};

}  // namespace

std::vector<std::int32_t> weld(std::span<const Vec3> positions, double tolerance) {
  Grid grid(positions, tolerance);
  std::vector<std::int32_t> group(positions.size());
  for (std::size_t v = 0; v < group.size(); ++v) group[v] = grid.group_of(static_cast<std::int32_t>(v));
  return group;
}

void split_groups(std::vector<std::int32_t>& group, std::span<const Vec3> positions, double tolerance) {
  const std::vector<std::int32_t> before = group;
  std::unordered_map<std::int32_t, std::vector<std::int32_t>> split;  // group to its pieces
  for (std::size_t v = 0; v < group.size(); ++v) {
    const auto point = static_cast<std::int32_t>(v);
    if (before[v] == point) continue;
    const auto near = [&](std::int32_t other) {
      return (positions[v] - positions[static_cast<std::size_t>(other)]).norm() <= tolerance;
    };
    if (near(before[v])) continue;
    std::vector<std::int32_t>& parts = split[before[v]];
    const auto joined = std::find_if(parts.begin(), parts.end(), near);
    group[v] = joined == parts.end() ? parts.emplace_back(point) : *joined;
  }
}

double largest_spread(std::span<const std::int32_t> group, std::span<const Vec3> positions) {
  double largest = 0;
  for (std::size_t v = 0; v < group.size(); ++v)
    if (group[v] != static_cast<std::int32_t>(v))
      largest = std::max(largest, (positions[v] - positions[static_cast<std::size_t>(group[v])]).norm());
  return largest;
}

WeldedTriangles welded(std::span<const RawTriangle> triangles, std::span<const std::int32_t> group) {
  WeldedTriangles out;
  std::vector<std::pair<Triangle, std::size_t>> sorted;  // corners in ascending order, index in `out`
  for (std::size_t r = 0; r < triangles.size(); ++r) {
    const RawTriangle& raw = triangles[r];
    Triangle corner;
    for (std::size_t k = 0; k < 3; ++k) corner[k] = VertexId{group[static_cast<std::size_t>(raw[k])]};
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) {
      ++out.collapsed;
      continue;
    }
    Triangle key = corner;
    std::sort(key.begin(), key.end());
    sorted.emplace_back(key, out.triangles.size());
    out.triangles.push_back(corner);
    out.source.push_back(r);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<bool> again(out.triangles.size(), false);
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i].first == sorted[i - 1].first) again[sorted[i].second] = true;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < out.triangles.size(); ++t)
    if (!again[t]) {
      out.triangles[kept] = out.triangles[t];
      out.source[kept++] = out.source[t];
    }
  out.duplicate = out.triangles.size() - kept;
  out.triangles.resize(kept);
  out.source.resize(kept);
  return out;
}

std::size_t crowded_edges(std::span<const Triangle> triangles, std::size_t points) {
  if (triangles.empty()) return 0;
  const TriangleMesh mesh({triangles.begin(), triangles.end()}, points);
  for (const TriangleMesh::DefectReport& defect : mesh.defects())
    if (defect.kind == Defect::non_manifold_edge) return defect.count;
  return 0;
}

}  // namespace cscd::scenes
