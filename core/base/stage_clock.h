#pragma once

#include <array>
#include <chrono>
#include <cstddef>

namespace cscd {

// The stages of one interval (refit to start) and of the preparation before the first interval
// (distance_and_heat, decomposition); see Table 3 and Table 1 of the paper, which calls `classify` rv update.
enum class Stage { refit, classify, traversal, elementary, start, distance_and_heat, decomposition, count_ };

// Measures the time spent in each stage. At any moment the clock charges at most one stage.
class StageClock {
 public:
  using Clock = std::chrono::steady_clock;

  void enter(Stage stage) {
    const Clock::time_point now = Clock::now();
    charge(now);
    running_ = static_cast<int>(stage);
    since_ = now;
  }
  void stop() {
    charge(Clock::now());
    running_ = none;
  }
  void reset() {
    spent_.fill(Clock::duration::zero());
    running_ = none;
  }
  double milliseconds(Stage stage) const {
    return std::chrono::duration<double, std::milli>(spent_[static_cast<std::size_t>(stage)]).count();
  }

 private:
  static constexpr int none = -1;
  void charge(Clock::time_point now) {
    if (running_ != none) spent_[static_cast<std::size_t>(running_)] += now - since_;
  }
  std::array<Clock::duration, static_cast<std::size_t>(Stage::count_)> spent_{};
  Clock::time_point since_{};
  int running_ = none;
};

}  // namespace cscd
