#pragma once

#include <string>

namespace cscd::bench {

// Ends the program if a step takes too long: prints one line, removes unfinished output
// (scenes/base/temporaries.h), and exits with status 2. Detection cannot be interrupted in any other way, and
// an untrusted animation can sweep everything through everything. One at a time.
class Watchdog {
 public:
  // Starts to watch. Zero seconds: never ends anything.
  Watchdog(double seconds, std::string line);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  // A new step begins.
  void restart();

 private:
  double seconds_;
  std::string line_;
};

}  // namespace cscd::bench
