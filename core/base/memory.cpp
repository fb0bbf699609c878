#include "core/base/memory.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#ifndef __wasm__
#include <fstream>
#if __has_include(<sys/resource.h>)
#include <sys/resource.h>
#include <unistd.h>
#endif
#endif

namespace cscd {
namespace {

unsigned long long megabytes(std::uint64_t bytes) {
  return bytes / 1'000'000;
}

#ifndef __wasm__

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The first number of a text; nothing where it begins with none, as "max" does.
std::optional<std::uint64_t> number_of(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} ? std::optional(number) : std::nullopt;
}

// The number behind a word that begins a line.
std::optional<std::uint64_t> number_behind(std::string_view word, const std::string& text) {
  const std::string key = "\n" + std::string(word);
  const std::string lines = "\n" + text;
  const std::size_t at = lines.find(key);
  return at == lines.npos ? std::nullopt : number_of(std::string_view(lines).substr(at + key.size()));
}

std::uint64_t less(std::uint64_t all, std::uint64_t used) {
  return all > used ? all - used : 0;
}

std::uint64_t left_by_machine() {
  constexpr std::uint64_t kKibi = 1024;
  const auto kibibytes = number_behind("MemAvailable:", text_of("/proc/meminfo"));
  return kibibytes ? kKibi * *kibibytes : kNoLimit;
}

std::uint64_t left_of_address_space() {
#ifdef RLIMIT_AS
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kNoLimit;
  const auto pages = number_of(text_of("/proc/self/statm"));
  if (pages) return less(limit.rlim_cur, *pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)));
#endif
  return kNoLimit;
}

// The names of version 1 and 2 of control groups. Files that are cached count as used by the group, and the
// kernel gives them up first.
struct GroupNames {
  const char *line, *folder, *limit, *usage, *cached;
};
constexpr GroupNames kVersions[] = {
    {":memory:", "/sys/fs/cgroup/memory", "/memory.limit_in_bytes", "/memory.usage_in_bytes",
     "total_inactive_file "},
    {"0::", "/sys/fs/cgroup", "/memory.max", "/memory.current", "inactive_file "}};

std::uint64_t left_by_group(const std::string& folder, const GroupNames& names) {
  const auto limit = number_of(text_of(folder + names.limit)),
             usage = number_of(text_of(folder + names.usage));
  if (!limit || !usage) return kNoLimit;
  const std::uint64_t cached = number_behind(names.cached, text_of(folder + "/memory.stat")).value_or(0);
  return less(*limit, less(*usage, cached));
}

// A group is limited by those above it, too. In a container its path may not be there, and its own limits
// then stand at the top.
std::uint64_t left_by_groups() {
  const std::string groups = text_of("/proc/self/cgroup");
  std::uint64_t left = kNoLimit;
  for (const GroupNames& names : kVersions) {
    const std::size_t line = groups.find(names.line);
    if (line == groups.npos) continue;
    const std::size_t begin = groups.find('/', line);
    std::string path = groups.substr(std::min(begin, groups.size()), groups.find('\n', line) - begin);
    for (;;) {
      left = std::min(left, left_by_group(names.folder + path, names));
      if (path.empty()) break;
      path.erase(path.rfind('/'));
    }
  }
  return left;
}

#endif

}  // namespace

std::uint64_t available_memory() {
#ifdef __wasm__
  // Memory grows to four gibibytes and never shrinks. What was freed within it is not counted.
  constexpr std::uint64_t kPage = 1 << 16, kAddresses = std::uint64_t{1} << 32;
  return kAddresses - kPage * __builtin_wasm_memory_size(0);
#else
  return std::min({left_by_machine(), left_of_address_space(), left_by_groups()});
#endif
}

MemoryShortage::MemoryShortage(std::size_t pairs, std::uint64_t needed, std::uint64_t left) noexcept {
  char so_far[80] = "testing the pairs of features that may be near";
  if (pairs > 0)
    std::snprintf(so_far, sizeof so_far, "%zu pairs of features are near enough so far, and going on", pairs);
  const int length =
      std::snprintf(text_, sizeof text_, "%s takes %llu MB more memory, of which %llu MB are left", so_far,
                    megabytes(needed), megabytes(left));
  finding_ = static_cast<std::size_t>(length);
  std::snprintf(
      text_ + length, sizeof text_ - finding_,
      "; give a smaller thickness or radius, ask for the first contact alone, or exclude neighbours");
}

void require_memory(std::size_t pairs, std::uint64_t bytes) {
  constexpr std::uint64_t kWorthALook = std::uint64_t{4} << 20;
  if (bytes < kWorthALook) return;
  if (const std::uint64_t left = available_memory(); bytes > left) throw MemoryShortage(pairs, bytes, left);
}

}  // namespace cscd
