#pragma once

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/test_folder.h"
#include "scenes/catalog/test_scenes.h"

// The program as a user of a shell has it, with scenes and a cache of its own in a folder whose name has a
// space and a letter beyond ASCII.
namespace cscd::bench {

namespace fs = std::filesystem;

struct Ran {
  int status = 0;  // as the shell has it: 128 and the signal for a program that a signal ended
  std::string out, errors;
};

class Program : public testing::Test {
 protected:
  fs::path folder = fs::temp_directory_path() / ("cscd pröbe " + std::to_string(getpid()));

  void SetUp() override {
    // Whoever runs the tests in the background ignores these, and what ignores them hands that on.
    for (const int number : {SIGINT, SIGHUP, SIGPIPE}) signal(number, SIG_DFL);
    fs::remove_all(folder);
    fs::create_directories(folder / "scenes");
    put("scenes/small.json", scenes::small_scene_with_digest());
  }
  void TearDown() override { fs::remove_all(folder); }

  void put(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }
  std::string text(const std::string& name) const { return test::read(folder / name); }
  // Names of what lies in the folder, in order, beside scenes and cache.
  std::string files() const {
    std::set<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      if (const std::string name = entry.path().filename();
          name != "scenes" && name != "cache" && name[0] != '+')
        names.insert(name);
    std::string out;
    for (const std::string& name : names) out += (out.empty() ? "" : " ") + name;
    return out;
  }

  // Runs a script of bash in the folder; `cscd` is the program.
  Ran run(const std::string& script) const {
    const fs::path program = fs::read_symlink("/proc/self/exe").parent_path();
    std::ofstream(folder / "+script") << "cd '" << folder.string() << "'\nexport PATH='" << program.string()
                                      << "':$PATH CSCD_SCENES=$PWD/scenes CSCD_CACHE=$PWD/cache\n"
                                      << script << "\n";
    const std::string quoted = "'" + folder.string() + "/+";
    const int status = std::system(
        ("bash " + quoted + "script' >" + quoted + "out' 2>" + quoted + "errors' </dev/null").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text("+out"), text("+errors")};
  }

  // Makes the folder a repository with one commit, which is committed at 10:00 UTC, and has a record name
  // that commit without changes.
  void commit_for(const std::string& record) const {
    const Ran ran = run(
        "git init -q . && GIT_COMMITTER_DATE=2026-11-25T12:00:00+02:00 git -c user.name=a -c user.email=a "
        "commit -q --allow-empty -m one && sed -i \"s/\\(.commit.: .\\)[0-9a-f]*/\\1$(git rev-parse HEAD)/; "
        "s/\\(.dirty.:\\) true/\\1 false/\" " +
        record);
    ASSERT_EQ(ran.status, 0) << ran.errors;
  }

  // A refusal: exit status 2 and one line.
  void expect_refused(const Ran& ran, const std::string& reason) const {
    EXPECT_EQ(ran.status, 2) << ran.errors;
    EXPECT_NE(ran.errors.find(reason), std::string::npos) << ran.errors;
    EXPECT_EQ(ran.errors.find('\n'), ran.errors.size() - 1) << ran.errors;
  }
};

}  // namespace cscd::bench
