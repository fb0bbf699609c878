#pragma once

#include <initializer_list>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "bench/inputs/input.h"
#include "core/mesh/test_shapes.h"
#include "scenes/random/random_interval.h"

// Inputs in memory: frames that a test gives, and random intervals.
namespace cscd::bench {

inline Input input_of(const test::Shape& shape, const std::vector<std::vector<Vec3>>& frames,
                      std::vector<Vec3> rest = {}) {
  auto clip = std::make_unique<scenes::Clip>(
      scenes::ClipHeader{shape.triangles, shape.positions.size(), {}, false, std::move(rest)});
  for (const std::vector<Vec3>& frame : frames) clip->append({frame, {}});
  return {"test", std::move(clip), shape.mesh(), frames.front(), std::nullopt};
}

// The positions of a shape, those of the vertices from `first` on shifted.
inline std::vector<Vec3> moved_part(const test::Shape& shape, std::size_t first, const Vec3& by) {
  std::vector<Vec3> x = shape.positions;
  for (std::size_t v = first; v < x.size(); ++v) x[v] += by;
  return x;
}

// Two balls side by side. In each frame the second one is shifted along x by one of `shifts`.
inline Input two_balls(std::initializer_list<double> shifts) {
  const test::Shape balls =
      test::together(test::icosphere(1), test::moved(test::icosphere(1), {3, 0.1, 0.2}));
  std::vector<std::vector<Vec3>> frames;
  for (const double x : shifts) frames.push_back(moved_part(balls, balls.positions.size() / 2, {x, 0, 0}));
  return input_of(balls, frames);
}

inline Input random_input(std::uint64_t seed, bool torn = false) {
  auto clip = std::make_unique<scenes::Clip>(
      (torn ? scenes::make_torn_interval(seed) : scenes::make_random_interval(seed)).clip);
  TriangleMesh mesh(clip->header().triangles, clip->header().vertex_count, "random interval");
  const std::span<const Vec3> first = clip->frame(0).positions;
  std::vector<Vec3> reference(first.begin(), first.end());
  std::optional<Rig> rig = scenes::rig_of(*clip);
  return {"random", std::move(clip), std::move(mesh), std::move(reference), std::move(rig)};
}

}  // namespace cscd::bench
