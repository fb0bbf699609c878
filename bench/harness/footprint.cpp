#include "bench/harness/footprint.h"

#include <cstring>
#include <fstream>
#include <linux/perf_event.h>
#include <malloc.h>
#include <string>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

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

std::optional<std::uint64_t> growth(std::optional<std::uint64_t> before, std::optional<std::uint64_t> after) {
  if (!before || !after) return std::nullopt;
  return *after > *before ? *after - *before : 0;
}

}  // namespace

ResidentMemory::ResidentMemory() {
  malloc_trim(0);
  peak_is_ours_ = reset_peak();
  resident_ = status_bytes("VmRSS");
}

Footprint ResidentMemory::footprint() const {
  Footprint out;
  if (peak_is_ours_) out.peak_bytes = growth(resident_, status_bytes("VmHWM"));
  malloc_trim(0);
  out.held_bytes = growth(resident_, status_bytes("VmRSS"));
  return out;
}

InstructionCounter::InstructionCounter() {
  perf_event_attr attributes;
  std::memset(&attributes, 0, sizeof attributes);
  attributes.type = PERF_TYPE_HARDWARE;
  attributes.size = sizeof attributes;
  attributes.config = PERF_COUNT_HW_INSTRUCTIONS;
  attributes.exclude_kernel = 1;
  attributes.exclude_hv = 1;
  descriptor_ = static_cast<int>(syscall(SYS_perf_event_open, &attributes, 0, -1, -1, 0));
}

InstructionCounter::~InstructionCounter() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::optional<std::uint64_t> InstructionCounter::so_far() const {
  std::uint64_t count = 0;
  if (descriptor_ < 0 || read(descriptor_, &count, sizeof count) != sizeof count) return std::nullopt;
  return count;
}

}  // namespace cscd::bench
