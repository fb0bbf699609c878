#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace cscd::scenes {

// The resources that a program may use.
struct Limits {
  std::size_t memory_bytes = std::size_t{4} << 30;  // address space; ignored under AddressSanitizer
  double seconds = 60;  // wall-clock time, and processor time rounded up to whole seconds
  std::size_t file_bytes = std::size_t{9} << 30;  // size of each file that the program writes
  unsigned open_files = 64;
};

// How a program ended, and what it used.
struct Outcome {
  enum class End { exited, killed_by_signal, timed_out };
  End end;
  int code = 0;        // exit status, or the number of the signal
  std::string errors;  // first 4 KiB of the program's standard error
  double seconds = 0;
  std::size_t peak_bytes = 0;  // of resident memory
};

// Runs a program with these limits and waits for its end; kills the program when its time is up. The
// program gets an empty environment, no standard input, no other open files and no core dumps, and cannot
// gain privileges. Its standard output is dropped. If this process ends first, the program is killed. Throws
// InputError if the program cannot be started.
Outcome run_limited(const std::filesystem::path& program, std::span<const std::string> arguments,
                    const Limits& limits);

// Limits the address space of this process, within the limit that it already has. Does nothing under
// AddressSanitizer.
void limit_memory(std::size_t bytes);

// Describes an outcome: "crashed with signal 6 (Aborted) after 0.1 s", "exit status 3", ...
std::string to_text(const Outcome& outcome);

}  // namespace cscd::scenes
