#include "bench/measure/shards/shards.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <random>

#include "bench/output/gzip.h"
#include "bench/output/json_text.h"
#include "bench/records/environment.h"
#include "core/base/error.h"
#include "scenes/base/output_target.h"
#include "scenes/clip/digest.h"

namespace cscd::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// The commit and the instruction set decide which counters and digests a program finds. A program whose
// sources differ from their commit, or have none, is told apart by a digest of its executable file.
ordered_json code_version() {
  const ordered_json build = build_environment();
  ordered_json version = {build.at("commit"), build.at("dirty"), build.at("instruction_set")};
  if (build.at("commit") != "unknown" && !build.at("dirty").get<bool>()) return version;
  std::ifstream program("/proc/self/exe", std::ios::binary);
  version.push_back(scenes::digest({std::istreambuf_iterator<char>(program), {}}));
  return version;
}

template <class T>
void append_bytes(const std::vector<T>& values, std::string& bytes) {
  bytes += std::to_string(values.size()) + ":";
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

// Digests of what all frames share, and of the frames.
ordered_json content_of(const Input& input) {
  const scenes::ClipHeader& header = input.clip->header();
  std::string surface = std::to_string(input.clip->frame_count()) + (header.predicted ? " predicted " : " ");
  append_bytes(header.triangles, surface);
  append_bytes(header.bone_parent, surface);
  append_bytes(header.rest, surface);
  scenes::DigestSink frames;
  scenes::copy_frames(*input.clip, frames);
  return {scenes::digest(surface), frames.text()};
}

std::vector<std::size_t> within(const std::vector<std::size_t>& ascending, const IntervalRange& range) {
  return {std::ranges::lower_bound(ascending, range.first), std::ranges::lower_bound(ascending, range.last)};
}

// A number that this process draws once. It tells how many processes measured the shards of a record.
std::uint64_t process_number() {
  static const std::uint64_t number = std::uint64_t{std::random_device{}()} << 32 | std::random_device{}();
  return number;
}

void write_unless_there(const fs::path& path, const std::string& content) {
  try {
    UnfinishedFile file(path, false);
    file.write(content);
    file.finish();
  } catch (const OutputError& error) {
    if (error.reason != EEXIST) throw;
  }
}

}  // namespace

Worker parse_worker(const std::string& text) {
  Worker worker{0, 0};
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, worker.number);
  if (first.ec == std::errc{} && first.ptr != end && *first.ptr == '/') {
    const auto second = std::from_chars(first.ptr + 1, end, worker.count);
    if (second.ec == std::errc{} && second.ptr == end && 1 <= worker.number && worker.number <= worker.count)
      return worker;
  }
  throw InputError("--worker " + text + ": is no worker; write I/N with 1 <= I <= N, such as 1/3");
}

std::vector<RunShard> divide(Input& input, const Replay& replay, std::size_t shard_intervals) {
  const ordered_json content = content_of(input), code = code_version();
  std::vector<RunShard> shards;
  for (std::size_t first = replay.range.first; first < replay.range.last; first += shard_intervals) {
    const IntervalRange range{first, std::min(first + shard_intervals, replay.range.last)};
    RunShard shard{{}, replay};
    shard.replay.range = range;
    Section& own = shard.replay.section;
    for (std::vector<std::size_t>* list : {&own.verified, &own.counted, &own.timed})
      *list = within(*list, range);
    if (own.counted.empty()) continue;
    const ordered_json decisive = {content,      replay.command, range.first, range.last,
                                   own.verified, own.counted,    own.timed,   code};
    shard.file_name = scenes::digest(decisive.dump()) + ".json.gz";
    shards.push_back(std::move(shard));
  }
  return shards;
}

std::size_t missing_results(std::span<const RunShard> shards, const fs::path& folder) {
  std::error_code ignored;
  return static_cast<std::size_t>(std::ranges::count_if(
      shards, [&](const RunShard& shard) { return !fs::exists(folder / shard.file_name, ignored); }));
}

bool measure_shards(Input& input, std::span<const RunShard> shards, Worker worker, const fs::path& folder) {
  remove_forsaken_files(folder);
  bool ok = true;
  for (std::size_t i = worker.number - 1; i < shards.size(); i += worker.count) {
    const RunShard& shard = shards[i];
    const fs::path path = folder / shard.file_name;
    if (fs::exists(path)) {
      ok = read_record(path).verification.ok() && ok;
      continue;
    }
    Record record = execute(input, shard.replay);
    if (!shard.replay.request.counts) record.environment["process"] = process_number();
    ok = record.verification.ok() && ok;
    write_unless_there(path, gzipped(json_text(to_json(record))));
    const IntervalRange& range = shard.replay.range;
    std::printf("shard %zu of %zu, intervals %zu to %zu: %s\n", i + 1, shards.size(), range.first,
                range.last - 1, path.c_str());
    std::fflush(stdout);
  }
  return ok;
}

}  // namespace cscd::bench
