#include "bench/measure/shards/code_version.h"

#include <fstream>
#include <iterator>
#include <string>

#include "bench/measure/record/environment.h"
#include "scenes/clip/digest.h"

namespace cscd::bench {
namespace {

std::string digest_of_this_program() {
  std::ifstream file("/proc/self/exe", std::ios::binary);
  return scenes::digest({std::istreambuf_iterator<char>(file), {}});
}

}  // namespace

nlohmann::ordered_json code_version() {
  const nlohmann::ordered_json build = build_environment();
  nlohmann::ordered_json version = {{"commit", build.at("commit")},
                                    {"dirty", build.at("dirty")},
                                    {"instruction_set", build.at("instruction_set")}};
  const bool is_known = build.at("commit") != "unknown" && !build.at("dirty").get<bool>();
  if (!is_known) version["program"] = digest_of_this_program();
  return version;
}

}  // namespace cscd::bench
