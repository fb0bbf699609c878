#pragma once

#include "scenes/hard/family.h"

// A disturbance takes a query from its lattice to the neighbourhood of the lattice: it turns the query,
// permutes its features, scales the query, and moves its coordinates a little.
namespace cscd::scenes::hard {

enum class Turn {
  none,
  exact,    // by 90 degrees, or by an angle of the right triangle of 3, 4 and 5, onto another lattice
  rounded,  // by any angle; coordinates are rounded
};

struct Disturbance {
  Turn turn = Turn::none;
  bool permuted = false;  // the corners, the ends of edges, or the two edges change places
  int exponent = 0;       // coordinates are multiplied by 2^exponent
  int ulps = 0;           // every coordinate moves by up to so many of its ulps
  double share = 0;       // and by up to this share of the query's extent
};

// Returns the query after the disturbance.
Query disturbed(Query query, Kind kind, const Disturbance& by, Random& random);

// The disturbance of a query in the suite. All turns, and moves by 0, 1, 16 and 2^20 ulps, take turns with
// the number of the query; scales are random, and features are permuted.
Disturbance suite_disturbance(std::size_t number, Random& random);

// A generator whose seed is a hash of the arguments.
Random random_of(std::string_view family, Kind kind, std::size_t number, std::uint64_t seed);

// The query of a family in the suite with the given number. It depends on the arguments alone.
Query suite_query(const Family& family, Kind kind, std::size_t number, std::uint64_t seed);
// A query that is off its lattice by up to the share `hardness` of its extent, and turned by any angle. A
// smaller share makes a harder query. The query depends on the arguments alone.
Query random_query(const Family& family, Kind kind, double hardness, std::size_t number, std::uint64_t seed);

}  // namespace cscd::scenes::hard
