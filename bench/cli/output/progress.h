#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace cscd::bench {

// Shows on standard error how far a long piece of work is, and how long it will still take: on a terminal a
// bar that is redrawn, elsewhere a line every ten seconds, so that a log stays short. Work that takes less
// than ten seconds leaves no line there.
class Progress {
 public:
  using Seconds = std::chrono::duration<double>;

  Progress(std::string title, std::size_t total, Seconds between_lines = std::chrono::seconds(10));
  ~Progress();  // clears the bar
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void set(std::size_t done);
  void advance() { set(done_ + 1); }

 private:
  void draw(Seconds elapsed) const;
  std::string title_;
  std::size_t total_, done_ = 0;
  bool terminal_;
  Seconds between_lines_;
  std::chrono::steady_clock::time_point begin_, drawn_;
};

// ", about 40 s left", from what the work done so far has taken; empty where that says nothing.
std::string time_left(std::size_t done, std::size_t total, double elapsed_seconds);

}  // namespace cscd::bench
