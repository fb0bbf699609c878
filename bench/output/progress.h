#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
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
  using Clock = std::chrono::steady_clock;
  struct Moment {
    Clock::time_point time;
    std::size_t done;
  };
  void draw(const Moment& now) const;
  std::string title_;
  std::size_t total_, done_ = 0;
  bool terminal_;
  Seconds between_lines_;
  Clock::time_point drawn_;
  std::deque<Moment>
      recent_;  // moments at which it was drawn, oldest first; the rate is taken since the first
};

// Returns a function to which work reports how far it is. It shows a Progress from the first report on, until
// the function is gone.
std::function<void(std::size_t done, std::size_t total)> progress_of(std::string title);

// Returns ", about 40 s left" for work of which `left` is left, if `done` of it took so many seconds. Returns
// an empty string if nothing is done or nothing is left.
std::string time_left(std::size_t done, std::size_t left, double seconds);

}  // namespace cscd::bench
