#include "bench/harness/footprint.h"

#include <cstring>
#include <fstream>
#include <linux/perf_event.h>
#include <malloc.h>
#include <string>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "bench/harness/contestant.h"
#include "core/base/stopwatch.h"

namespace cscd::bench {
namespace {

// "VmHWM" and the like in /proc/self/status, in bytes.
std::optional<std::uint64_t> status_bytes(const std::string& key) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(key + ":")) return std::stoull(line.substr(key.size() + 1)) * 1024;
  return std::nullopt;
}

// Forgets the peak so far (man 5 proc, clear_refs).
bool reset_peak() {
  std::ofstream file("/proc/self/clear_refs");
  return static_cast<bool>(file << "5" << std::flush);
}

// A hardware counter of this thread.
class InstructionCounter {
 public:
  InstructionCounter() {
    perf_event_attr attributes;
    std::memset(&attributes, 0, sizeof attributes);
    attributes.type = PERF_TYPE_HARDWARE;
    attributes.size = sizeof attributes;
    attributes.config = PERF_COUNT_HW_INSTRUCTIONS;
    attributes.exclude_kernel = 1;
    attributes.exclude_hv = 1;
    descriptor_ = static_cast<int>(syscall(SYS_perf_event_open, &attributes, 0, -1, -1, 0));
  }
  ~InstructionCounter() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  InstructionCounter(const InstructionCounter&) = delete;
  InstructionCounter& operator=(const InstructionCounter&) = delete;

  std::optional<std::uint64_t> so_far() const {
    std::uint64_t count = 0;
    if (descriptor_ < 0 || read(descriptor_, &count, sizeof count) != sizeof count) return std::nullopt;
    return count;
  }

 private:
  int descriptor_;
};

std::optional<std::uint64_t> growth(std::optional<std::uint64_t> before, std::optional<std::uint64_t> after) {
  if (!before || !after) return std::nullopt;
  return *after > *before ? *after - *before : 0;
}

}  // namespace

Made make_measured(Input& input, const StrategyRow& row, const ElementaryTest& elementary, std::size_t at) {
  const scenes::ClipInterval interval =
      input.clip->load(at);  // the source's own buffers are not the strategy's
  malloc_trim(0);            // nor is what earlier strategies freed
  const bool peak_is_ours = reset_peak();
  const auto resident = status_bytes("VmRSS");

  const Stopwatch making;
  Made made{row.strategy->make(measured_setup(input, *row.strategy, elementary, row.first, row.pipeline)),
            {}};
  made.make_ms = making.milliseconds();
  ContactSet found;
  for (int time = 0; time < 2; ++time) made.prepared.detector->detect(input.step(interval), found);
  if (peak_is_ours) made.footprint.peak_bytes = growth(resident, status_bytes("VmHWM"));
  malloc_trim(0);
  made.footprint.held_bytes = growth(resident, status_bytes("VmRSS"));
  return made;
}

Footprint measure_footprint(Input& input, const StrategyRow& row, const ElementaryTest& elementary,
                            std::span<const std::size_t> intervals) {
  const Made made = make_measured(input, row, elementary, intervals.front());
  Footprint footprint = made.footprint;
  if (made.prepared.preparation.threads > 1) return footprint;  // the counter sees one
  ContactSet found;
  const InstructionCounter counter;
  std::uint64_t instructions = 0;
  for (const std::size_t i : intervals) {
    const scenes::ClipInterval interval = input.clip->load(i);
    const auto before = counter.so_far();
    if (!before) return footprint;
    made.prepared.detector->detect(input.step(interval), found);
    instructions += growth(before, counter.so_far()).value_or(0);
  }
  footprint.instructions = static_cast<double>(instructions) / static_cast<double>(intervals.size());
  return footprint;
}

}  // namespace cscd::bench
