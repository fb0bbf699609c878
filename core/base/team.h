#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>

namespace cscd {

// Threads that share out the parts of one piece of work. Which thread takes which part is left open: what
// comes out must not depend on it. The one place that knows oneTBB (team.cpp).
class Team {
 public:
  // `threads`, the caller among them; at least 1. No more run at a time than the machine has cores.
  explicit Team(int threads = 1);
  ~Team();
  Team(Team&&) noexcept;
  Team& operator=(Team&&) noexcept;

  std::size_t threads() const { return threads_; }

  // work(part, thread) once for each part below `parts`, `thread` being the number of the thread that does
  // it, below threads(); returns when all are done. One thread does them in order. `work` must not throw.
  template <class Work>
  void each(std::size_t parts, const Work& work) const {
    if (threads_ == 1 || parts <= 1) {
      for (std::size_t part = 0; part < parts; ++part) work(part, 0);
      return;
    }
    share_out(parts, &work, [](const void* context, std::size_t part, std::size_t thread) {
      (*static_cast<const Work*>(context))(part, thread);
    });
  }

  // work(first, last, part) on ranges that make up [0, count), in as many parts as ranges_of(count, least)
  // says: none shorter than `least` unless it is the only one.
  template <class Work>
  void ranges(std::size_t count, std::size_t least, const Work& work) const {
    const std::size_t parts = ranges_of(count, least);
    each(parts, [&](std::size_t part, std::size_t) {
      work(count * part / parts, count * (part + 1) / parts, part);
    });
  }
  std::size_t ranges_of(std::size_t count, std::size_t least) const {
    const std::size_t most = threads_ == 1 ? 1 : 4 * threads_;  // they need not take equally long
    return std::clamp<std::size_t>(count / least, 1, most);
  }

 private:
  void share_out(std::size_t parts, const void* context,
                 void (*work)(const void* context, std::size_t part, std::size_t thread)) const;

  struct Arena;
  std::size_t threads_;
  std::unique_ptr<Arena> arena_;
};

// Runs `work` where a package that shares out its own work by oneTBB finds no other thread.
void on_this_thread(const std::function<void()>& work);

}  // namespace cscd
