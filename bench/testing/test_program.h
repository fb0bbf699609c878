#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/base/test_folder.h"
#include "scenes/catalog/scene.h"
#include "scenes/sandbox/run_limited.h"

// The program from outside: run with arguments and limits, in a folder of its own, on the shared models,
// which are not part of the repository ($CSCD_MODELS, else ../shared/models beside it; tests skip where they
// are absent).
namespace cscd::bench {

namespace fs = std::filesystem;
using scenes::Limits;
using scenes::Outcome;

inline fs::path models_folder() {
  if (const char* named = std::getenv("CSCD_MODELS")) return named;
  return scenes::scenes_folder().parent_path() / ".." / "shared" / "models";
}

inline std::string model(const std::string& name) {
  return (models_folder() / name).string();
}

inline bool absent(const std::string& name) {
  std::error_code error;
  return !fs::exists(model(name), error);
}

// Whether a line says how far a long piece of work is (bench/output/progress.h).
inline bool is_progress(const std::string& line) {
  unsigned long done = 0, total = 0;
  const std::size_t at = line.rfind(": ");
  return at != std::string::npos && std::sscanf(line.c_str() + at, ": %lu of %lu", &done, &total) == 2;
}

// `environment` is all that the program gets of it, such as "CSCD_CACHE=/tmp". Lines of progress, which only
// a slow machine sees, are left out of the errors.
inline Outcome cscd(const std::vector<std::string>& arguments, const Limits& limits = {},
                    const std::vector<std::string>& environment = {}) {
  std::vector<std::string> words = environment;
  words.push_back(fs::read_symlink("/proc/self/exe").parent_path() / "cscd");
  words.insert(words.end(), arguments.begin(), arguments.end());
  Outcome outcome = scenes::run_limited("/usr/bin/env", words, limits);
  std::istringstream lines(std::exchange(outcome.errors, {}));
  for (std::string line; std::getline(lines, line);)
    if (!is_progress(line)) outcome.errors += line + (lines.eof() ? "" : "\n");
  return outcome;
}

// Expects that the program refuses in one line, in which the reason stands.
inline void expect_refused(const std::vector<std::string>& arguments, const std::string& reason) {
  const Outcome refused = cscd(arguments);
  EXPECT_EQ(refused.code, 2) << reason;
  EXPECT_NE(refused.errors.find(reason), std::string::npos) << refused.errors;
  EXPECT_EQ(std::ranges::count(refused.errors, '\n'), 1) << refused.errors;
}

// A folder whose files are named by texts.
struct Scratch : test::Folder {
  Scratch() {}  // clang 14 takes no other constructor for a constant member of a fixture
  std::string operator/(const std::string& name) const { return (path / name).string(); }
};
using test::read;
using test::write;

// The document that a command writes with --json; expects that the command succeeds.
inline nlohmann::json document_of(std::vector<std::string> arguments) {
  const Scratch scratch;
  arguments.insert(arguments.end(), {"--json", scratch / "document.json"});
  const Outcome outcome = cscd(arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  return outcome.code == 0 ? nlohmann::json::parse(read(scratch / "document.json")) : nlohmann::json();
}

}  // namespace cscd::bench
