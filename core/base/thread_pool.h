#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>

namespace cscd {

// A group of threads that share out the parts of one piece of work. The caller's result must not depend on
// which thread does which part. The file thread_pool.cpp is the only place in the project that knows oneTBB.
class ThreadPool {
 public:
  // Makes a pool of `threads` threads, the calling thread included; `threads` is at least 1. At most as many
  // of them run at a time as the machine has cores. Built without oneTBB, every pool has one thread.
  explicit ThreadPool(int threads = 1);
  ~ThreadPool();
  ThreadPool(ThreadPool&&) noexcept;
  ThreadPool& operator=(ThreadPool&&) noexcept;

  std::size_t threads() const { return threads_; }

  // Calls work(part, thread) once for each part in [0, parts) and returns when all calls have returned.
  // `thread` is the number of the thread that makes the call, in [0, threads()). A pool of one thread does
  // the parts in order. `work` must not throw.
  template <class Work>
  void parallel_for(std::size_t parts, const Work& work) const {
    if (threads_ == 1 || parts <= 1) {
      for (std::size_t part = 0; part < parts; ++part) work(part, 0);
      return;
    }
    share_out(parts, &work, [](const void* context, std::size_t part, std::size_t thread) {
      (*static_cast<const Work*>(context))(part, thread);
    });
  }

  // Divides [0, count) into ranges_of(count, least) ranges and calls work(first, last, part) once for each.
  // Every range has at least `least` members, unless there is only one range. Choose `least` so that a
  // range takes some microseconds or more.
  template <class Work>
  void ranges(std::size_t count, std::size_t least, const Work& work) const {
    const std::size_t parts = ranges_of(count, least);
    parallel_for(parts, [&](std::size_t part, std::size_t) {
      work(range_begin(count, parts, part), range_begin(count, parts, part + 1), part);
    });
  }
  // Returns where one of `parts` ranges of [0, count) begins.
  static std::size_t range_begin(std::size_t count, std::size_t parts, std::size_t part) {
    return count * part / parts;
  }
  // Returns the number of ranges that ranges() makes. A pool of one thread has one range. So has a pool that
  // would be done before another of its threads has woken up, because there are fewer than kWorthWaking times
  // `least` members. Others have up to four ranges a thread.
  std::size_t ranges_of(std::size_t count, std::size_t least) const {
    if (threads_ == 1 || count < kWorthWaking * least) return 1;
    return std::min(count / least, 4 * threads_);  // ranges may take unequally long
  }
#ifdef __SANITIZE_THREAD__
  static constexpr std::size_t kWorthWaking = 2;  // ThreadSanitizer is to see small meshes shared out too
#else
  static constexpr std::size_t kWorthWaking = 8;  // ranges
#endif

 private:
  void share_out(std::size_t parts, const void* context,
                 void (*work)(const void* context, std::size_t part, std::size_t thread)) const;

  struct Arena;
  std::size_t threads_;
  std::unique_ptr<Arena> arena_;
};

// Runs `work` in an arena of one thread. A package that shares out its own work by oneTBB finds no other
// thread there, so it works on the calling thread alone.
void on_this_thread(const std::function<void()>& work);

}  // namespace cscd
