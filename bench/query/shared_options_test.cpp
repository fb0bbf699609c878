// The options that all commands share which answer a clip: each command takes each of them, and makes the
// same of it.
#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "bench/query/view/viewer_page.h"
#include "bench/testing/test_queries.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

constexpr char kClip[] = "figure.glb --clip hug --fps 6 ";
// Each with what else it needs. The last ones are about the closed body alone.
constexpr const char* kOptions[] = {"",
                                    "--strategy base",
                                    "--elementary exact",
                                    "--first",
                                    "--unproven --strategy drvbc_fast_complete",
                                    "--keep-rest-crossings",
                                    "--new-contacts",
                                    "--ignore left_arm:*",
                                    "--ignore-neighbours 1",
                                    "--thickness 0.2e",
                                    "--thickness 0.2e --exclude-rings 2",
                                    "--thickness 0.2e --exclude-near-rest 2e",
                                    "--true-motion --resolution 0.1e",
                                    "--interval-seconds 50",
                                    "--threads 2",
                                    "--frames 2:5",
                                    "--preparation kept --component auto"};

class SharedOptions : public QueryProgram {
 protected:
  // The options that a command's help lists as those of answers.
  std::set<std::string> answer_options(const std::string& command) const {
    const std::string help = run("cscd help " + command).out;
    std::size_t at = help.find("Answers:\n");
    std::set<std::string> names;
    const std::size_t end = help.find("\n\n", at);
    while ((at = help.find("\n  --", at)) < end) {
      at += 3;
      names.insert(help.substr(at, help.find_first_of(" \n", at) - at));
    }
    return names;
  }
  // How many contacts each file of points has that export writes.
  std::vector<std::size_t> exported_contacts() const {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(folder / "out"))
      if (entry.path().string().find(".contacts.") != std::string::npos) paths.push_back(entry.path());
    std::ranges::sort(paths);
    std::vector<std::size_t> counts;
    for (const fs::path& path : paths) {
      const std::string vtp = text("out/" + path.filename().string()), key = "NumberOfPoints=\"";
      counts.push_back(std::stoul(vtp.substr(vtp.find(key) + key.size())));
    }
    return counts;
  }
};

TEST_F(SharedOptions, AreTheSameForEveryCommand) {
  const std::set<std::string> names = answer_options("query");
  EXPECT_GT(names.size(), 12u);
  for (const char* command : {"view", "export"}) EXPECT_EQ(answer_options(command), names) << command;
  for (const std::string& name : names)
    EXPECT_TRUE(std::ranges::any_of(kOptions,
                                    [&](const std::string& words) {
                                      return (" " + words + " ").find(" " + name + " ") != std::string::npos;
                                    }))
        << name << " is not tried";
}

// Mutation: a command passes over an option.
TEST_F(SharedOptions, GiveTheSameContactsInEveryCommand) {
  if (viewer_page().empty()) GTEST_SKIP() << "built without the viewer";
  std::set<std::string> different;
  for (const std::string words : kOptions) {
    SCOPED_TRACE(words);
    json query = answer(kClip + words);
    std::vector<std::size_t> contacts;
    for (const json& interval : query["intervals"]) contacts.push_back(interval["contacts"].size());
    contacts.push_back(0);  // the last pose starts no interval
    ASSERT_EQ(run("cscd view " + (kClip + words) + " -o page.html").status, 0);
    json page = header_of(text("page.html"))["strategies"][0]["summary"];
    for (json* summary : {&query["summary"], &page}) {
      summary->erase("ms");
      if (summary->contains("true_motion")) (*summary)["true_motion"].erase("ms");
    }
    EXPECT_EQ(page, query["summary"]);
    fs::create_directory(folder / "out");
    const Ran ran = run("cscd export " + (kClip + words) + " out/clip.pvd");
    ASSERT_EQ(ran.status, 0) << ran.errors;
    EXPECT_NE(ran.out.find(query["summary"]["sentence"].get<std::string>()), std::string::npos) << ran.out;
    EXPECT_EQ(exported_contacts(), contacts);
    fs::remove_all(folder / "out");
    different.insert(query["summary"].dump());
  }
  EXPECT_GT(different.size(), 8u) << "most of the options change the answer";
}

// Frames alone are the same whatever is asked of contacts. Mutation: such an option is passed over.
TEST_F(SharedOptions, AreRefusedWhereNoAnswerIsWritten) {
  for (const char* format : {"clip.h5", "clip.ply", "clip.pc2", "--bake clip.glb"})
    expect_refused(run("cscd export " + std::string(kClip) + "--thickness 0.2e " + format),
                   "--thickness: is about contacts");
  ASSERT_EQ(run("cscd export " + std::string(kClip) + "--frames 2:4 part.h5").status, 0);
  EXPECT_EQ(answer("part.h5")["intervals"].size(), 2u);
  ASSERT_EQ(run("cscd export " + std::string(kClip) + "--frames 2:4 part.ply").status, 0);
  EXPECT_EQ(text("part.0002.ply").empty(), false);
  EXPECT_FALSE(fs::exists(folder / "part.0001.ply"));
  EXPECT_FALSE(fs::exists(folder / "part.0005.ply"));
  expect_refused(run("cscd query " + std::string(kClip) + "--strategy base --strategy aabb"), "--strategy");
  expect_refused(
      run("cscd view " + std::string(kClip) + "--strategy base --strategy aabb --preparation kept"),
      "--preparation: is that of one strategy");
}

}  // namespace
}  // namespace cscd::bench
