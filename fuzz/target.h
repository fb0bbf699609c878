#pragma once

#include <cstdint>
#include <span>
#include <string>

// A fuzz target is one function that takes any bytes. libFuzzer searches for bytes that break a promise of
// the code behind it (entry.cpp, scripts/find-faults fuzz); replay.cpp runs stored and random bytes in every
// build.
namespace cscd::fuzz {

using Bytes = std::span<const std::uint8_t>;

// Defined once in each program. Returns where the code does what it promises, a refusal by InputError
// included.
void target(Bytes bytes);

// Says which promise is broken, and ends the program abnormally.
[[noreturn]] void broken(const std::string& promise);

}  // namespace cscd::fuzz
