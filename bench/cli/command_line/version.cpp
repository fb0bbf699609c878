#include "bench/cli/command_line/version.h"

#include <utility>

#include "bench/measure/record/environment.h"
#include "core/base/instruction_set.h"

#include "build_info.h"

namespace cscd::bench {

std::string version_number() {
  return build_info::kCscd;
}

std::string version_text() {
  const nlohmann::ordered_json build = build_environment();
  const auto get = [&](const char* key) { return build.at(key).get<std::string>(); };
  std::string out = "cscd " + version_number() + "\n";
  out += "commit: " + get("commit") + (build.at("dirty").get<bool>() ? " with changes" : "") + "\n";
  out += "compiler: " + get("compiler") + ", " + get("build_type") + ", flags " + get("flags") + "\n";
  out += "instruction set: " + get("instruction_set") + " (CSCD_ISA=" + std::string(to_string(engine_set())) +
         "); the program is built for " + build_info::kInstructionSets + "\n";
  out += "libraries:";
  for (const auto& [name, number] : build.at("libraries").items())
    out += " " + name + " " + number.get<std::string>() + ",";
  const std::pair<std::string, std::string> others[] = {
      {"tbb", build_info::kTbb},       {"embree", build_info::kEmbree},
      {"fcl", build_info::kFcl},       {"cgal", build_info::kCgal},
      {"assimp", build_info::kAssimp}, {"meshoptimizer", build_info::kMeshoptimizer},
      {"zlib", build_info::kZlib},     {"pugixml", build_info::kPugixml}};
  for (const auto& [name, number] : others)
    out += " " + name + " " + (number.empty() ? "none" : number) + ",";
  out.back() = '\n';
  return out;
}

}  // namespace cscd::bench
