#pragma once

#include <array>
#include <span>
#include <string_view>

#include "scenes/queries/query_file.h"
#include "scenes/random/surface.h"

// Families of elementary queries that are hard on purpose. Each family has a story that tells why its
// queries are hard.
//
// Every query is made on a lattice: its coordinates are integers times a power of two. So the query is
// degenerate exactly, and its answer can be proved. `disturbance.h` then moves the query off the lattice by
// ulps or by shares of its size.
namespace cscd::scenes::hard {

enum class Kind { vertex_face, edge_edge };

struct Family {
  std::string_view name, story;
  // Makes a query on the lattice. The query has no truth; the oracle gives it (in_contact).
  Query (*make)(Kind kind, Random& random);
};

// All families. A new family is a function and a row in families.cpp.
std::span<const Family> families();

// The oracle's answer: true if the features of the query touch at some t in [0, 1].
bool in_contact(const Query& query, Kind kind);

// A query that is hard at a distance: on the lattice its features come exactly as near as r, along a lattice
// direction whose length is an integer.
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
// scale, and r scaled with it. It depends on the arguments alone.
CloseQuery close_suite_query(const CloseFamily& family, Kind kind, std::size_t number, std::uint64_t seed);

// The oracle's answer: true if the features are within r of each other at some t in [0, 1].
bool is_close(const CloseQuery& query, Kind kind);

}  // namespace cscd::scenes::hard
