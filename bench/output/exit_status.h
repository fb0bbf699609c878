#pragma once

namespace cscd::bench {

// How the program ends (bench/README.md, "Commands").
enum class ExitStatus : int {
  done = 0,
  failed = 1,        // a verification failed, or a comparison found something worse
  refused = 2,       // bad usage or bad input, or what cannot be compared
  contact_found = 3  // where the user asked for a failure on contact, or on depth
};

// Ends a command that ran to its end. main() catches the status and prints nothing.
inline void end_with(ExitStatus status) {
  if (status != ExitStatus::done) throw status;
}

}  // namespace cscd::bench
