#pragma once

#include <span>
#include <string_view>

// The instruction sets for which the kernels of core/geometry are written. A build compiles the engine for
// all of them (scripts/cmake/instruction_sets.cmake) and chooses when the program runs, or for one of them.
namespace cscd {

// In the order in which they are preferred. `baseline` is what every processor of the architecture has.
enum class InstructionSet { avx512, avx2, baseline };

// The instruction set for which the file that includes this header is compiled.
inline constexpr InstructionSet kCompiledFor =
#if defined(__AVX512F__)
    InstructionSet::avx512;
#elif defined(__AVX2__) && defined(__FMA__)
    InstructionSet::avx2;
#else
    InstructionSet::baseline;
#endif

// Returns the instruction set for which the engine of this program is compiled. In a build for all sets,
// files outside of the engine are compiled for plain x86-64 (kCompiledFor), whatever the engine is compiled
// for.
InstructionSet engine_set();

// Returns the name of the enumerator.
std::string_view to_string(InstructionSet set);

// Returns whether this machine has everything that the build uses of the instruction set.
bool machine_has(InstructionSet set);

// Returns the set among `built` that is to be used: the one that the environment variable CSCD_ISA names, or
// the most preferred one that this machine has. Throws InputError if CSCD_ISA names no set, or a set that the
// build or the machine lacks, and if the machine has none of `built`.
InstructionSet chosen_among(std::span<const InstructionSet> built);

}  // namespace cscd
