#pragma once

#include <string>
#include <vector>

#include "bench/inputs/input.h"
#include "bench/strategies/strategy_row.h"

// The input of the study of growing work: one surface, prepared once, in intervals of its own or of other
// motions.
namespace cscd::bench {

// Intervals that are alike.
struct ScaleStep {
  std::string scene;  // of whose motion they are
  double frames = 1;  // a whole number of frame steps, or a share of one
  double edges = 0;   // the thickness, in mean edges at rest
  // Of the study of small steps: how far a step moves, in mean edges at rest, and as part of which series
  // (small_steps.h).
  double moves = 0;
  std::string series = {};
};

struct ScaleSubject {
  std::string study;      // size, step, bones, threads, contacts, thickness or small
  std::string scene;      // whose surface and bones these are; of recorded steps, also a point cache
  bool recorded = false;  // each step as its scene's clip holds it; else posed anew from the subject's scene
  std::size_t triangles = 0;        // asked for, of a posed one; 0 for the scene's own
  std::size_t bones = 0;            // of the chain, of a posed one; 0 for the scene's own
  std::vector<ScaleStep> steps;     // none shorter or thinner than the one before
  std::vector<std::size_t> starts;  // frames at which intervals start
  std::vector<StrategyRow> rows;
  std::size_t repetitions = 5;
  int threads = 1;  // for the strategies that can share their work
  // Triangles above which the complete reference answers one interval a step.
  std::size_t reference_limit = 0;
};

// The surface at rest, and all intervals of its first step, then those of the next. `leads` are those of
// Measurement::Setup: intervals of the same length that end where an interval starts.
struct ScaleInput {
  Input input;
  std::vector<IntervalRange> leads;
  double build_ms;
};

// Throws InputError for a scene that a subject cannot be made of.
ScaleInput scale_input(const ScaleSubject& subject);

// So many frames, spread evenly, from each of which the longest step stays inside the clip. Throws InputError
// where there is no room.
std::vector<std::size_t> spread_starts(std::size_t frames, std::size_t count, double longest_step);

}  // namespace cscd::bench
