#pragma once

#include "scenes/hard/family.h"

// From the lattice to its neighbourhood: a query turned, its features in another order, at another scale, and
// its coordinates a little off.
namespace cscd::scenes::hard {

enum class Turn {
  none,
  exact,    // by multiples of 90 degrees and by the right triangle of 3, 4 and 5; the lattice becomes another
            // one
  rounded,  // by anything; coordinates are rounded
};

struct Disturbance {
  Turn turn = Turn::none;
  bool permuted = false;  // corners, ends, the two edges
  int exponent = 0;       // scaled by this power of two
  int ulps = 0;           // every coordinate moves by up to so many of its own
  double share = 0;       // and by up to this share of the query's extent
};

Query disturbed(Query query, Kind kind, const Disturbance& by, Random& random);

// The suite: turns, orders and scales of every sort, and off the lattice by 0, 1, 16 and 2^20 ulps, in turn
// with the number of the query.
Disturbance suite_disturbance(std::size_t number, Random& random);

// The i-th query of a family in the suite. Depends on its arguments alone.
Query suite_query(const Family& family, Kind kind, std::size_t number, std::uint64_t seed);
// One at the given hardness: off its lattice by that share of its size. The smaller, the harder.
Query random_query(const Family& family, Kind kind, double hardness, std::size_t number, std::uint64_t seed);

}  // namespace cscd::scenes::hard
