#include "core/base/instruction_set.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace cscd {
namespace {

constexpr InstructionSet kAll[] = {InstructionSet::avx512, InstructionSet::avx2, InstructionSet::baseline};

std::string names_of(std::span<const InstructionSet> sets) {
  std::string names;
  for (const InstructionSet set : sets) names.append(names.empty() ? "" : ", ").append(to_string(set));
  return names;
}

}  // namespace

InstructionSet engine_set() {
  return kCompiledFor;
}

std::string_view to_string(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return "avx512";
    case InstructionSet::avx2:
      return "avx2";
    case InstructionSet::baseline:
      return "baseline";
  }
  return "";
}

// The names are those of the compilers' options in scripts/cmake/instruction_sets.cmake.
bool machine_has(InstructionSet set) {
#if defined(__x86_64__)
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                    __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
                    __builtin_cpu_supports("popcnt");
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
  if (set == InstructionSet::avx512) return avx2 && avx512;
  if (set == InstructionSet::avx2) return avx2;
#endif
  return set == InstructionSet::baseline;
}

InstructionSet chosen_among(std::span<const InstructionSet> built) {
  const char* const asked = std::getenv("CSCD_ISA");
  if (asked == nullptr || *asked == '\0') {
    const auto best = std::ranges::find_if(kAll, [&](InstructionSet set) {
      return std::ranges::find(built, set) != built.end() && machine_has(set);
    });
    if (best == std::end(kAll))
      throw InputError("this build has kernels for " + names_of(built) +
                       " alone, which this machine lacks; build without CSCD_NATIVE, or on this machine");
    return *best;
  }
  const auto named = std::ranges::find(kAll, asked, to_string);
  std::string fault;
  if (named == std::end(kAll))
    fault = "no such instruction set";
  else if (std::ranges::find(built, *named) == built.end())
    fault = "this build has no kernels for it";
  else if (!machine_has(*named))
    fault = "this machine lacks it";
  else
    return *named;
  // What can be used here is advised, and nothing else: a set that exists may be missing from the build or
  // the machine.
  std::vector<InstructionSet> usable;
  std::ranges::copy_if(kAll, std::back_inserter(usable), [&](InstructionSet set) {
    return std::ranges::find(built, set) != built.end() && machine_has(set);
  });
  throw InputError("CSCD_ISA=" + std::string(asked) + ": " + fault + "; " +
                   (usable.empty()
                        ? "this build has kernels for " + names_of(built) + " alone, which this machine lacks"
                        : "leave CSCD_ISA unset, or give " + names_of(usable)));
}

}  // namespace cscd
