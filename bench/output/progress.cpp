#include "bench/output/progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <unistd.h>

namespace cscd::bench {
namespace {

constexpr Progress::Seconds kBetweenBars{0.1};
constexpr int kWindows = 3;  // the rate is that of about so many times the time between lines
constexpr char kClearLine[] = "\r\033[K";

}  // namespace

std::string time_left(std::size_t done, std::size_t left, double seconds_taken) {
  if (done == 0 || left == 0) return "";
  constexpr double kSecondsUpTo = 100, kMinutesUpTo = 100 * 60;
  const double seconds = seconds_taken * static_cast<double>(left) / static_cast<double>(done);
  char text[48];
  if (seconds < kSecondsUpTo)
    std::snprintf(text, sizeof text, ", about %.0f s left", std::ceil(seconds));
  else if (seconds < kMinutesUpTo)
    std::snprintf(text, sizeof text, ", about %.0f min left", std::ceil(seconds / 60));
  else
    std::snprintf(text, sizeof text, ", about %.1f h left", seconds / 3600);
  return text;
}

std::function<void(std::size_t, std::size_t)> progress_of(std::string title) {
  return [title = std::move(title), shown = std::make_shared<std::optional<Progress>>()](std::size_t done,
                                                                                         std::size_t total) {
    if (!*shown) shown->emplace(title, total);
    (*shown)->set(done);
  };
}

Progress::Progress(std::string title, std::size_t total, Seconds between_lines)
    : title_(std::move(title)),
      total_(total),
      terminal_(isatty(STDERR_FILENO) == 1),
      between_lines_(between_lines),
      drawn_(Clock::now()),
      recent_{{drawn_, 0}} {
  if (terminal_) draw(recent_.front());
}

Progress::~Progress() {
  if (terminal_ && done_ != total_) std::fputs(kClearLine, stderr);
}

void Progress::set(std::size_t done) {
  done_ = done;
  const Clock::time_point now = Clock::now();
  if (terminal_ && done_ == total_) {  // what is printed next begins a line of its own
    std::fputs(kClearLine, stderr);
    return;
  }
  if (now - drawn_ < (terminal_ ? kBetweenBars : between_lines_)) return;
  drawn_ = now;
  draw({now, done_});
  recent_.push_back({now, done_});
  // Keep one moment from before the window, so that the rate covers at least the whole window.
  while (recent_.size() > 1 && now - recent_[1].time >= kWindows * between_lines_) recent_.pop_front();
}

void Progress::draw(const Moment& now) const {
  const Moment& then = recent_.front();
  const std::string left =
      now.done < then.done || now.done > total_
          ? ""
          : time_left(now.done - then.done, total_ - now.done, Seconds(now.time - then.time).count());
  if (!terminal_) {
    std::fprintf(stderr, "%s: %zu of %zu%s\n", title_.c_str(), done_, total_, left.c_str());
    return;
  }
  constexpr std::size_t width = 30;
  const std::size_t filled = total_ == 0 ? width : std::min(width, width * done_ / total_);
  const std::string bar = std::string(filled, '=') + std::string(width - filled, ' ');
  std::fprintf(stderr, "%s%s [%s] %zu/%zu%s", kClearLine, title_.c_str(), bar.c_str(), done_, total_,
               left.c_str());
  std::fflush(stderr);
}

}  // namespace cscd::bench
