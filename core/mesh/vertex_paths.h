#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/base/vec3.h"

namespace cscd {

// The paths of a mesh's vertices over time, of which straight lines between positions are approximations with
// a proven error. A path may jump at certain times; elsewhere it is continuous.
class VertexPaths {
 public:
  virtual ~VertexPaths() = default;

  virtual std::size_t vertex_count() const = 0;
  // Where vertices are at a time, and how far the place that is told may be from the true one, infinity where
  // that is not known. Places are finite. At the time of a jump, where they are after it.
  virtual void positions(double time, std::span<const VertexId> vertices, std::span<Vec3> at,
                         std::span<double> error) const = 0;
  // Bounds how far each true path leaves the straight line, run through at constant speed, between its true
  // places at both times; infinity where no bound is known. There must be no jump after `from` and up to
  // `to`.
  virtual void deviations(double from, double to, std::span<const VertexId> vertices,
                          std::span<double> out) const = 0;
  // A bound on the deviations of all vertices, which may be larger than theirs and cost less.
  virtual double largest_deviation(double from, double to) const {
    std::vector<VertexId> all;
    for (std::size_t v = 0; v < vertex_count(); ++v) all.push_back(VertexId{static_cast<std::int32_t>(v)});
    std::vector<double> out(all.size());
    deviations(from, to, all, out);
    double largest = 0;
    for (const double x : out) {
      if (!(x < std::numeric_limits<double>::infinity())) return std::numeric_limits<double>::infinity();
      largest = std::max(largest, x);
    }
    return largest;
  }
  // A time strictly between, at which to divide a span of time.
  virtual double split(double from, double to) const { return from + (to - from) / 2; }
  // A time within `reach` of another at which paths turn corners, or else that other time. Spans that end at
  // corners have the best bounds.
  virtual double at_corner(double time, double reach) const {
    (void)reach;
    return time;
  }
  // The first jump after `from` and up to `to`: the last time before it and the first time after it.
  struct Jump {
    double before, after;
  };
  virtual std::optional<Jump> next_jump(double from, double to) const {
    (void)from, (void)to;
    return std::nullopt;
  }
};

}  // namespace cscd
