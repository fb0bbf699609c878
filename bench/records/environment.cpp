#include "bench/records/environment.h"

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <gmp.h>
#include <sched.h>
#include <string>
#include <sys/utsname.h>
#include <unistd.h>

#include "core/base/instruction_set.h"

#include "build_info.h"
#include "commit.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

constexpr char kUnknown[] = "unknown";

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  return std::getline(file, line) && !line.empty() ? line : kUnknown;
}

// The value after "key :" in a file of such lines.
std::string value_in(const char* path, const std::string& key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(':');
    if (!line.starts_with(key) || colon == std::string::npos) continue;
    const std::size_t value = line.find_first_not_of(" \t", colon + 1);
    if (value != std::string::npos) return line.substr(value);
  }
  return kUnknown;
}

ordered_json caches() {
  ordered_json rows = ordered_json::array();
  for (int i = 0;; ++i) {
    const std::string folder = "/sys/devices/system/cpu/cpu0/cache/index" + std::to_string(i) + "/";
    if (!std::ifstream(folder + "level")) break;
    std::string row = first_line(folder + "level");
    row.insert(0, 1, 'L').append(" ").append(first_line(folder + "type"));
    rows.push_back(row.append(" ").append(first_line(folder + "size")));
  }
  if (rows.empty()) return kUnknown;
  return rows;
}

int usable_cores() {
  cpu_set_t set;
  return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
}

ordered_json load_average() {
  double load[3];
  if (getloadavg(load, 3) != 3) return kUnknown;
  return {load[0], load[1], load[2]};
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm calendar{};
  gmtime_r(&now, &calendar);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &calendar);
  return text;
}

std::string kernel() {
  utsname name{};
  if (uname(&name) != 0) return kUnknown;
  return std::string(name.sysname) + " " + name.release + " " + name.machine;
}

// The instruction set that the engine and the baselines are compiled for.
std::string instruction_set_name() {
  switch (engine_set()) {
    case InstructionSet::avx512:
      return "AVX-512";
    case InstructionSet::avx2:
      return "AVX2 and FMA";
    case InstructionSet::baseline:
      break;
  }
#if defined(__x86_64__)
  return "SSE2";
#else
  return "other";
#endif
}

}  // namespace

ordered_json build_environment() {
  return {{"commit", build_info::kCommit},
          {"dirty", build_info::kDirty},
          {"compiler", build_info::kCompiler},
          {"flags", build_info::kFlags},
          {"instruction_set", instruction_set_name()},
          {"build_type", build_info::kBuildType},
          {"libraries",
           {{"eigen", build_info::kEigen},
            {"hdf5", build_info::kHdf5},
            {"gmp", gmp_version},
            {"nlohmann_json", build_info::kNlohmannJson},
            {"cli11", build_info::kCli11}}}};
}

ordered_json environment() {
  const ordered_json build = build_environment();
  return {{"date", utc_now()},
          {"program", build_info::kCscd},
          {"commit", build.at("commit")},
          {"dirty", build.at("dirty")},
          {"cpu", value_in("/proc/cpuinfo", "model name")},
          {"cores", sysconf(_SC_NPROCESSORS_ONLN)},
          {"usable_cores", usable_cores()},
          {"caches", caches()},
          {"memory", value_in("/proc/meminfo", "MemTotal")},
          {"governor", first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor")},
          {"transparent_huge_pages", first_line("/sys/kernel/mm/transparent_hugepage/enabled")},
          {"load_average", load_average()},
          {"kernel", kernel()},
          {"compiler", build.at("compiler")},
          {"flags", build.at("flags")},
          {"instruction_set", build.at("instruction_set")},
          {"build_type", build.at("build_type")},
          {"libraries", build.at("libraries")}};
}

}  // namespace cscd::bench
