#include "bench/progress.h"

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace cscd::bench {

Progress::Progress(std::string title, std::size_t total)
    : title_(std::move(title)), total_(total), visible_(isatty(STDERR_FILENO) == 1) {
  draw();
}

Progress::~Progress() {
  if (visible_) std::fputs("\r\033[K", stderr);
}

void Progress::set(std::size_t done) {
  done_ = done;
  const auto now = std::chrono::steady_clock::now();
  if (now - drawn_ > std::chrono::milliseconds(100) || done_ == total_) draw();
}

void Progress::draw() {
  if (!visible_) return;
  drawn_ = std::chrono::steady_clock::now();
  constexpr std::size_t width = 30;
  const std::size_t filled = total_ == 0 ? width : std::min(width, width * done_ / total_);
  const std::string bar = std::string(filled, '=') + std::string(width - filled, ' ');
  std::fprintf(stderr, "\r\033[K%s [%s] %zu/%zu", title_.c_str(), bar.c_str(), done_, total_);
  std::fflush(stderr);
}

}  // namespace cscd::bench
