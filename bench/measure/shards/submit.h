#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "bench/measure/shards/shard.h"

namespace cscd::bench {

// All cells of a plan, divided among so many workers.
struct Submission {
  std::filesystem::path plan, folder;
  std::size_t workers = 1;
  CellLimits limits;
  ReplayKind kind = ReplayKind::counts;  // of the plan
  int threads = 1;                       // of each worker, as the plan says
};

// Starts the workers as processes of this machine and waits for all of them. They end if this process ends.
// Returns the largest of their exit statuses; a worker that a signal ended counts as 2. Throws InputError if
// a worker cannot be started.
int work_here(const Submission& submission);

// The script of an array job for Slurm, one task a worker, run from the present folder. Workers that count
// share nodes with each other and with other jobs, where the partition allows that; a worker that takes times
// has a node to itself. Slurm starts a task anew if its node fails.
std::string slurm_script(const Submission& submission);
// Hands a script to `sbatch`. Throws InputError if there is no such program or it refuses, with its reason.
void send_to_slurm(const std::string& script);

}  // namespace cscd::bench
