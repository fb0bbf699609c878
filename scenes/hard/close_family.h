#pragma once

#include <span>
#include <string_view>

#include "scenes/hard/family.h"

// Families of queries that are hard at a distance. On the lattice their features come exactly as near as r,
// along a lattice direction whose length is an integer.
namespace cscd::scenes::hard {

struct CloseQuery {
  Query query;
  double r;  // above 0
};

struct CloseFamily {
  std::string_view name, story;
  CloseQuery (*make)(Kind kind, Random& random);
};

std::span<const CloseFamily> close_families();

// The query of a family with the given number, disturbed as in the suite (disturbance.h) but for turns that
// scale, and r scaled with it. It
// depends on the arguments alone.
CloseQuery close_suite_query(const CloseFamily& family, Kind kind, std::size_t number, std::uint64_t seed);

// The referee's answer: true if the features are within r of each other at some t in [0, 1].
bool is_close(const CloseQuery& query, Kind kind);

}  // namespace cscd::scenes::hard
