#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bench/harness/replay.h"

// A long run can be interrupted, resumed and shared among workers. It is divided into shards, each of which
// measures a range of the run's intervals and has a result file of its own. The files lie in one folder, and
// a worker measures those shards of its share whose files are missing.
namespace cscd::bench {

struct RunShard {
  // The name of the result file. It holds a digest of everything that decides the result: the input's
  // content, the command line with all defaults, the intervals, the kind, and the version of the program.
  std::string file_name;
  Replay replay;  // of the shard's intervals; at least one of them is counted
};

// The shards that belong to worker `number` of `count`, counted from 1: every count-th one.
struct Worker {
  std::size_t number = 1, count = 1;
};
// Reads "1/3". Throws InputError for any other text.
Worker parse_worker(const std::string& text);

// Divides a replay into shards of `shard_intervals` intervals; the last shard may have fewer.
std::vector<RunShard> divide(Input& input, const Replay& replay, std::size_t shard_intervals);

// How many of the shards have no result file in the folder.
std::size_t missing_results(std::span<const RunShard> shards, const std::filesystem::path& folder);

// Measures the worker's shards that have no result file, and says on standard output which shard is done. A
// result file, a run record, appears whole or not at all. Several workers may measure the same shard: the
// first result is kept. Returns whether every strategy kept its promise in these shards. Throws OutputError
// if the folder does not take a result.
bool measure_shards(Input& input, std::span<const RunShard> shards, Worker worker,
                    const std::filesystem::path& folder);

// Joins the results of all shards into one record, as a single run of the whole range would have written it.
// The record depends on the results alone, and not on who measured them or in which order. Lists by interval
// are joined, sums and maxima are taken of what is one number a run, and the environment is that of the first
// shard. `whole` is the replay that was divided. Throws InputError if a result is missing, is not its
// shard's, or comes from another build or, where there are times, from another machine than the others.
Record join(const Replay& whole, std::span<const RunShard> shards, const std::filesystem::path& folder);

}  // namespace cscd::bench
