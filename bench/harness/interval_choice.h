#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "bench/inputs/input.h"
#include "core/detect/detector.h"

namespace cscd::bench {

// Every K-th interval of a range, from its first.
std::vector<std::size_t> every_kth(const IntervalRange& range, std::size_t k);

// So many of the first `over` numbers, or all of them, spread evenly.
std::vector<std::size_t> spread(std::size_t count, std::size_t over);

// All intervals of the range on which the detector finds a contact, ascending.
std::vector<std::size_t> intervals_with_contacts(Input& input, Detector& detector,
                                                 const IntervalRange& range);

// The chosen intervals and as many others with contacts, spread evenly over those that there are, as make at
// least `count` of the result intervals with contacts; all of them where there are fewer. Everything is
// ascending.
std::vector<std::size_t> with_contacts(std::span<const std::size_t> chosen,
                                       std::span<const std::size_t> touching, std::size_t count);

// The union of sets of intervals, ascending.
std::vector<std::size_t> united(std::span<const std::vector<std::size_t>> sets);

}  // namespace cscd::bench
