#include "bench/catalogue.h"

#include <array>
#include <string>

#include "baselines/base.h"
#include "baselines/brute.h"
#include "baselines/rvbc.h"
#include "core/base/error.h"
#include "core/engine/drvbc.h"

namespace cscd::bench {
namespace {

// The first row is the reference, the second the oracle.
constexpr std::array kStrategies = {
    Strategy{"base", "16-DOP hierarchy (Klosowski et al. 1998)", Guarantee::complete, false, make_base},
    Strategy{"brute", "all pairs of triangles", Guarantee::complete, false, make_brute},
    Strategy{"rvbc", "radial view based culling (Wong et al. 2013)", Guarantee::first_contact, true,
             make_rvbc},
    Strategy{"drvbc", "dynamic radial view based culling (Wong et al. 2014)", Guarantee::first_contact, true,
             [](const Setup& setup) { return make_drvbc(setup); }},
};

template <class Rows>
[[noreturn]] void refuse(const char* what, std::string_view name, const Rows& rows) {
  std::string known;
  for (const auto& row : rows) known += (known.empty() ? "" : ", ") + std::string(row.name);
  throw InputError(std::string(what) + " '" + std::string(name) + "' is not known; choose one of " + known);
}

}  // namespace

std::span<const Strategy> strategies() {
  return kStrategies;
}

const Strategy& strategy_named(std::string_view name) {
  for (const Strategy& strategy : kStrategies)
    if (strategy.name == name) return strategy;
  refuse("strategy", name, kStrategies);
}

const ElementaryTest& elementary_test_named(std::string_view name) {
  if (const ElementaryTest* test = find_elementary_test(name)) return *test;
  refuse("elementary test", name, elementary_tests());
}

const Strategy& complete_reference() {
  return kStrategies[0];
}

const Strategy& all_pairs() {
  return kStrategies[1];
}

}  // namespace cscd::bench
