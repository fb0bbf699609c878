#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace cscd::bench {

// One point of a course of measurements.
struct CoursePoint {
  double value;           // positive
  double standard_error;  // of the value's logarithm, as far as the measurement itself tells; may be 0
};

// Where a course changes its level.
struct ChangePoint {
  std::size_t first;  // the first point of the new level
  double ratio;       // the new level over the old one
};

// Finds the changes of level by penalised least squares: of all ways to cut the course into levels, the one
// with the least sum of squared deviations of logarithms, in units of their noise, plus a penalty a cut. The
// optimum is exact (optimal partitioning: Jackson et al. 2005; PELT of Killick et al. 2012 prunes the same
// recursion, which so short a course does not need). A point's noise is the largest of its own standard
// error, `least_noise`, and what neighbouring points differ by (median absolute difference, so that a few
// steps do not widen it). One point between two levels is an outlier and is ignored; the first and the last
// point may be levels of their own. The penalty is 12 + 2 log(n): change_points_test.cpp measures how often a
// course without change is cut.
std::vector<ChangePoint> change_points(std::span<const CoursePoint> course, double least_noise);

}  // namespace cscd::bench
