#pragma once

#include <string>
#include <vector>

#include "bench/measure/studies/scale_input.h"

// Steps as a solver takes them: the frames of a clip, divided.
namespace cscd::bench {

struct SmallStep {
  double start, end;  // times, in frames
};

// So many steps of a series are measured, evenly apart, and those before lead up to each.
inline constexpr std::size_t kMeasuredSteps = 6;

// A series of small steps from a time on, the first of them `length` frames long. `substeps` follow each
// other. `trials` are substeps but for the last three, which are those of a line search: whole, half and a
// quarter of a step from where the substeps end. `iterations` creep towards an end, each 0.9 times as long as
// the one before. Throws InputError for another name.
std::vector<SmallStep> series_of_steps(const std::string& name, double start, double length);

// The input of a subject whose steps move ScaleStep::moves mean edges. Its starts are those of the series,
// each once for every step of it that is measured.
ScaleInput small_steps_input(const ScaleSubject& subject);

}  // namespace cscd::bench
