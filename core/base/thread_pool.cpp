#include "core/base/thread_pool.h"

#ifdef CSCD_TBB
#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>
#endif

#ifdef __SANITIZE_THREAD__
#include <atomic>
#include <thread>
#include <vector>
#endif

namespace cscd {

struct ThreadPool::Arena {
#ifdef CSCD_TBB
  tbb::task_arena arena;
#endif
};

ThreadPool::ThreadPool(ThreadPool&&) noexcept = default;
ThreadPool& ThreadPool::operator=(ThreadPool&&) noexcept = default;
ThreadPool::~ThreadPool() = default;

#ifdef __SANITIZE_THREAD__

// ThreadSanitizer cannot see how the threads of oneTBB's library wait for each other, and would report every
// part. So it watches plain threads. They take parts by a counter that orders nothing between them: what one
// part writes, no other part may touch.
ThreadPool::ThreadPool(int threads) : threads_(static_cast<std::size_t>(threads)) {}

void ThreadPool::share_out(std::size_t parts, const void* context,
                           void (*work)(const void* context, std::size_t part, std::size_t thread)) const {
  std::atomic<std::size_t> next = 0;
  const auto run = [&](std::size_t thread) {
    for (std::size_t part; (part = next.fetch_add(1, std::memory_order_relaxed)) < parts;)
      work(context, part, thread);
  };
  std::vector<std::jthread> others;
  for (std::size_t thread = 1; thread < threads_; ++thread) others.emplace_back(run, thread);
  run(0);
}

#elif defined CSCD_TBB

ThreadPool::ThreadPool(int threads) : threads_(static_cast<std::size_t>(threads)) {
  if (threads > 1)  // oneTBB warns on standard error if it is asked for more threads than cores
    arena_ =
        std::make_unique<Arena>(Arena{tbb::task_arena(std::min(threads, tbb::info::default_concurrency()))});
}

void ThreadPool::share_out(std::size_t parts, const void* context,
                           void (*work)(const void* context, std::size_t part, std::size_t thread)) const {
  arena_->arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, parts),
        [&](const tbb::blocked_range<std::size_t>& range) {
          const auto thread = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
          for (std::size_t part = range.begin(); part < range.end(); ++part) work(context, part, thread);
        },
        tbb::simple_partitioner());
  });
}

#else

// A pool of one thread never shares out.
ThreadPool::ThreadPool(int /*threads*/) : threads_(1) {}
void ThreadPool::share_out(std::size_t, const void*, void (*)(const void*, std::size_t, std::size_t)) const {}

#endif

void on_this_thread(const std::function<void()>& work) {
#ifdef CSCD_TBB
  tbb::task_arena(1).execute(work);
#else
  work();
#endif
}

}  // namespace cscd
