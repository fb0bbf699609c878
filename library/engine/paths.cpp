#include "library/engine/paths.h"

#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/number_text.h"
#include "core/base/rounding.h"
#include "core/fast/drvbc_fast.h"
#include "core/mesh/mean_edge.h"
#include "core/session/true_motion.h"

namespace cscd {
namespace {

// Paths as the caller tells them.
class CallersPaths final : public VertexPaths {
 public:
  CallersPaths(const SelfCollision::Paths& paths, std::size_t vertices) : paths_(paths), vertices_(vertices) {
    if (!paths.positions || !paths.acceleration)
      throw InputError("paths: a function is missing; give positions and acceleration");
    if (!(paths.position_error >= 0) || !std::isfinite(paths.position_error))
      throw InputError("paths: position_error is " + exact_text(paths.position_error) +
                       "; give a finite length of at least 0");
  }
  std::size_t vertex_count() const override { return vertices_; }
  void positions(double time, std::span<const VertexId> vertices, std::span<Vec3> at,
                 std::span<double> error) const override {
    const std::vector<double> all = paths_.positions(time);
    if (all.size() != 3 * vertices_)
      throw InputError("paths: positions at " + exact_text(time) + " are " + std::to_string(all.size()) +
                       " numbers for " + std::to_string(vertices_) + " vertices; give 3 a vertex");
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const double* const x = all.data() + 3 * +vertices[i];
      at[i] = {x[0], x[1], x[2]};
      error[i] = paths_.position_error;
    }
  }
  void deviations(double from, double to, std::span<const VertexId> vertices,
                  std::span<double> out) const override {
    const std::vector<double> bounds = paths_.acceleration(from, to);
    if (bounds.size() != 1 && bounds.size() != vertices_)
      throw InputError("paths: " + std::to_string(bounds.size()) + " bounds of the acceleration for " +
                       std::to_string(vertices_) + " vertices; give one, or one a vertex");
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const double bound = bounds.size() == 1 ? bounds[0] : bounds[+vertices[i]];
      if (!(bound >= 0)) throw InputError("paths: a bound of the acceleration is no number of at least 0");
      constexpr double kGrown = 1 + 16 * kUnitRoundoff;
      out[i] = bound * (to - from) * (to - from) / 8 * kGrown;
    }
  }

 private:
  const SelfCollision::Paths& paths_;
  std::size_t vertices_;
};

// The library's header stands alone, so it has an enum of its own.
SelfCollision::PathsAnswer::Verdict written(IntervalVerdict verdict) {
  using Verdict = SelfCollision::PathsAnswer::Verdict;
  switch (verdict) {
    case IntervalVerdict::clear:
      return Verdict::clear;
    case IntervalVerdict::touches:
      return Verdict::touches;
    case IntervalVerdict::intersects_at_start:
      return Verdict::intersects_at_start;
    case IntervalVerdict::undecided:
      break;
    case IntervalVerdict::close:
      return Verdict::close;
  }
  return Verdict::undecided;
}

SelfCollision::PathsAnswer written(const TrueAnswer& answer) {
  SelfCollision::PathsAnswer out{written(answer.verdict), answer.from, answer.to, answer.within, {-1, -1}};
  if (answer.pair) out.faces = {static_cast<int>(answer.pair->first), static_cast<int>(answer.pair->second)};
  return out;
}

}  // namespace

SelfCollision::PathsAnswer answer_paths(const SelfCollision::Paths& paths, double from, double to,
                                        double resolution, const StrategyInput& setup) {
  if (!(from < to) || !std::isfinite(to - from))
    throw InputError("true_motion: " + exact_text(from) + " to " + exact_text(to) +
                     " is no span of time; give two times, the earlier first");
  if (!(resolution >= 0) || !std::isfinite(resolution))
    throw InputError("true_motion: resolution " + exact_text(resolution) +
                     "; give a finite length of at least 0");
  const CallersPaths callers(paths, setup.mesh.vertex_count());
  TrueMotionOptions options = true_motion_options(mean_edge(setup.mesh, setup.reference));
  if (resolution > 0) options.resolution = resolution;
  TrueMotion motion(callers, setup, kDrvbcFastComplete, options);
  if (const auto met = motion.meeting_at(from))
    return written({.verdict = met->crosses ? IntervalVerdict::intersects_at_start : IntervalVerdict::touches,
                    .from = from,
                    .to = from,
                    .pair = met->pair});
  return written(motion.answer(from, to));
}

}  // namespace cscd
