#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace cscd::scenes {

// What a program may use.
struct Limits {
  std::size_t memory_bytes = std::size_t{4} << 30;  // address space; ignored under AddressSanitizer
  double seconds = 60;                              // of the clock; of the processor, rounded up
  std::size_t file_bytes = std::size_t{9} << 30;    // size of a file that it writes
  unsigned open_files = 64;
};

struct Outcome {
  enum class End { exited, killed_by_signal, timed_out };
  End end;
  int code = 0;        // exit status, or the signal
  std::string errors;  // the first 4 KiB of what it wrote on standard error
  double seconds = 0;
  std::size_t peak_bytes = 0;  // of resident memory
};

// Runs a program with those limits, without privileges to gain, core dumps, other open files or standard
// input, and with an empty environment; its standard output is dropped. Waits for its end, and ends it when
// its time is up. Throws InputError if it cannot be started.
Outcome run_limited(const std::filesystem::path& program, std::span<const std::string> arguments,
                    const Limits& limits);

// Limits the address space of this process, as far as it may; does nothing under AddressSanitizer.
void limit_memory(std::size_t bytes);

// "ended by signal 6 (Aborted) after 0.1 s", "exit status 3", ...
std::string to_text(const Outcome& outcome);

}  // namespace cscd::scenes
