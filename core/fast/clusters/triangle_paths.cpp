#include "core/fast/clusters/triangle_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/mesh/adjacency.h"

namespace cscd::fast {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kMostBuckets = 1 << 16;

}  // namespace

TrianglePaths::TrianglePaths(const TriangleMesh& mesh, std::span<const Vec3> positions, Steps steps)
    : length_(mesh.triangle_count()) {
  std::vector<Vec3> middle;
  for (const Triangle& c : mesh.triangles())
    middle.push_back(positions[+c[0]] / 3 + positions[+c[1]] / 3 + positions[+c[2]] / 3);
  std::vector<std::int32_t> met(mesh.triangle_count(), -1);
  std::size_t finite = 0;
  double sum = 0;
  for (std::size_t t = 0; t < middle.size(); ++t) {
    const auto number = static_cast<std::int32_t>(t);
    first_step_.push_back(steps_.size());
    const auto take = [&](TriangleId next) {
      if (met[+next] == number || +next == t) return;
      met[+next] = number;
      steps_.push_back({next, (middle[+next] - middle[t]).norm()});
      if (std::isfinite(steps_.back().length)) sum += steps_.back().length, ++finite;
    };
    if (steps == Steps::over_vertices)
      for_each_neighbour(mesh, TriangleId{number}, take);
    else
      for (const EdgeId e : mesh.edges_of(TriangleId{number}))
        std::ranges::for_each(mesh.triangles_at(e), take);
  }
  first_step_.push_back(steps_.size());
  if (finite > 0 && sum > 0) bucket_width_ = sum / static_cast<double>(finite);
}

void TrianglePaths::put(TriangleId t, double length) {
  length_[+t] = length;
  const auto bucket = static_cast<std::size_t>(std::min(length / bucket_width_, kMostBuckets));
  if (bucket >= buckets_.size()) buckets_.resize(bucket + 1);
  buckets_[bucket].push_back({t, length});
}

// Paths wait in buckets by their length. A bucket is about one step wide, and within it no order is kept: a
// triangle that is reached on a shorter path later is looked at again. That takes less time than a heap, and
// ends at the same lengths.
template <class LengthOf, class Take>
void TrianglePaths::flood(std::span<const TriangleId> reached, std::span<const TriangleId> seeds,
                          const LengthOf& length_of, const Take& take) {
  for (const TriangleId t : reached) length_[+t] = kInfinite;
  for (const TriangleId seed : seeds) put(seed, 0);
  for (std::size_t bucket = 0; bucket < buckets_.size(); ++bucket) {
    for (std::size_t i = 0; i < buckets_[bucket].size(); ++i) {
      const auto [t, length] = buckets_[bucket][i];
      if (length > length_[+t]) continue;
      for (const Step& step : steps_from(t)) {
        const double through = length + length_of(t, step);
        if (!(through < length_[+step.to])) continue;
        take(t, step.to);
        put(step.to, through);
      }
    }
    buckets_[bucket].clear();
  }
}

void TrianglePaths::measure(std::span<const std::int32_t> piece, std::span<const TriangleId> reached,
                            std::span<const TriangleId> seeds) {
  flood(
      reached, seeds,
      [&](TriangleId from, const Step& step) {
        return piece[+step.to] == piece[+from] ? step.length : kInfinite;
      },
      [](TriangleId, TriangleId) {});
}

void TrianglePaths::grow(std::span<std::int32_t> piece, std::span<const TriangleId> reached,
                         std::span<const TriangleId> seeds, std::span<const double> stretch) {
  std::fill(length_.begin(), length_.end(), 0.0);  // no path is shorter, so none leaves what is to be reached
  flood(
      reached, seeds,
      [&](TriangleId from, const Step& step) {
        return step.length * stretch[static_cast<std::size_t>(piece[+from])];
      },
      [&](TriangleId from, TriangleId to) { piece[+to] = piece[+from]; });
}

}  // namespace cscd::fast
