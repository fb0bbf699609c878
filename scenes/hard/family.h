#pragma once

#include <array>
#include <span>
#include <string_view>

#include "core/elementary/queries/query_file.h"
#include "scenes/random/surface.h"

// Elementary queries that are hard on purpose: one family a file, each with its story. Every query is made on
// a lattice, its coordinates integers times a power of two, so that it is degenerate exactly and its answer
// can be proved; `disturbance.h` then moves it off the lattice by ulps or by shares of its size.
namespace cscd::scenes::hard {

enum class Kind { vertex_face, edge_edge };

struct Family {
  std::string_view name, story;
  Query (*make)(Kind kind, Random& random);  // without truth: the referee gives it
};

// Every family; a new one is a file and a row in families.cpp.
std::span<const Family> families();

// The referee's answer.
bool in_contact(const Query& query, Kind kind);

}  // namespace cscd::scenes::hard
