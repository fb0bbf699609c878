#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace cscd::bench {

// A line on standard error that shows how far a long piece of work is; silent unless that is a terminal.
class Progress {
 public:
  Progress(std::string title, std::size_t total);
  ~Progress();  // clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void set(std::size_t done);
  void advance() { set(done_ + 1); }

 private:
  void draw();
  std::string title_;
  std::size_t total_, done_ = 0;
  bool visible_;
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace cscd::bench
