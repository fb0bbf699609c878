#include "core/base/team.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

namespace cscd {

struct Team::Arena {
  tbb::task_arena arena;
};

Team::Team(int threads) : threads_(static_cast<std::size_t>(threads)) {
  if (threads > 1)  // oneTBB warns on standard error if it is asked for more threads than cores
    arena_ =
        std::make_unique<Arena>(Arena{tbb::task_arena(std::min(threads, tbb::info::default_concurrency()))});
}
Team::~Team() = default;
Team::Team(Team&&) noexcept = default;
Team& Team::operator=(Team&&) noexcept = default;

void Team::share_out(std::size_t parts, const void* context,
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

void on_this_thread(const std::function<void()>& work) {
  tbb::task_arena(1).execute(work);
}

}  // namespace cscd
