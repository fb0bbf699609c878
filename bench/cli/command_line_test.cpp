#include <nlohmann/json.hpp>

#include "bench/testing/test_shell.h"

// These tests read what the program says about itself, and what it answers to mistyped words.
namespace cscd::bench {
namespace {

class CommandLine : public Program {};

TEST_F(CommandLine, NamesWhatIsMisspeltBeforeWhatIsMissing) {
  const struct {
    const char *words, *line;
  } kCases[] = {
      {"query small --jsno out.json", "unknown option --jsno; did you mean --json?; see cscd query --help"},
      {"query small --jsno=out.json", "unknown option --jsno; did you mean --json?"},
      {"run", "--json is required; see cscd run --help"},
      {"run small", "write cscd run --scene small --json FILE; see cscd run --help"},
      {"run small --json x.json", "write cscd run --scene small; see cscd run --help"},
      {"qurey small --json x", "unknown command qurey; did you mean query?; see cscd --help"},
      {"frobnicate", "unknown command frobnicate; see cscd --help"},
      {"--verson", "unknown option --verson; did you mean --version?"},
      {"scene acept x.json", "unknown command acept; did you mean accept?; see cscd scene --help"},
      {"export small a.h5 b.h5", "one argument too many: b.h5; see cscd export --help"},
      {"query smal --json -", "unknown scene smal; did you mean small?; "},
      {"query small --json - --strategy drvbc-fast",
       "strategy 'drvbc-fast' is not known; did you mean drvbc_fast?"},
      {"query small --json - --elementary newtom@1", "did you mean newton?"},
      {"run --json x.json --strategy basee", "did you mean base?"},
      {"help qurey", "unknown command qurey; did you mean query?"},
      {"", "subcommand is required"},
      {"query small --json - --threads many", "--threads"},
      {"query small --json - --threads 0", "--threads"},
      {"query small --interval-seconds nan", "--interval-seconds: nan is no finite number"},
      {"query small --interval-seconds inf", "--interval-seconds"},
      {"query small --interval-seconds -1", "--interval-seconds"},
      {"query x.glb --fps nan", "--fps: nan is no finite number"},
      {"query x.glb --weld nan", "--weld: nan is no finite number"},
      {"query x.glb --import-seconds nan", "--import-seconds: nan is no finite number"},
      {"query x.glb --memory 1e3", "--memory"},
      {"verify --intervals 99999999999999999999999", "--intervals: 99999999999999999999999 is beyond all"},
      {"verify --seed -1", "--seed: -1 is no whole number of 0 or more"},
      {"scale --steps 1,nan", "--steps: nan is no finite number"},
      {"hardcases --out . --hardness nan", "--hardness: nan is no finite number"},
      {"list --names --json", "--names"},
  };
  for (const auto& one : kCases) {
    const Ran ran = run(std::string("cscd ") + one.words);
    expect_refused(ran, one.line);
    EXPECT_EQ(ran.out, "") << one.words;
  }
  EXPECT_EQ(files(), "");
}

// Any folder called scenes above may be found, and may hold files without end.
TEST_F(CommandLine, RefusesAnUnknownSceneInOneLine) {
  const Ran ran = run(R"sh(for i in $(seq 300); do cp scenes/small.json scenes/other_$i.json; done
cscd query nosuch)sh");
  expect_refused(ran, "/scenes holds 301 scenes, which `cscd list` names");
  EXPECT_LT(ran.errors.size(), 400u) << ran.errors;
}

TEST_F(CommandLine, RefusesWordsThatAreNoText) {
  expect_refused(run("cscd query $'p\\xe4th.h5' --json -"), "is not UTF-8");
}

// As `cmake --install` leaves it: the scenes lie beside the program, where a user cannot write.
TEST_F(CommandLine, FindsItsScenesWhereItIsInstalled) {
  const Ran ran = run(R"sh(mkdir -p prefix/bin prefix/share/cscd home
cp "$(command -v cscd)"{,-*} prefix/bin
mv scenes prefix/share/cscd
here=$PWD
cd /
unset CSCD_SCENES CSCD_CACHE XDG_CACHE_HOME
HOME=$here/home "$here/prefix/bin/cscd" query small --json - && ls "$here/home/.cache/cscd")sh");
  EXPECT_EQ(ran.status, 0) << ran.errors;
  EXPECT_NE(ran.out.find(".h5\n"), std::string::npos) << ran.out;
  EXPECT_EQ(text("prefix/share/cscd/scenes/small.json"), scenes::small_scene_with_digest());
  EXPECT_FALSE(fs::exists(folder / "prefix/share/cscd/.cache"));
}

TEST_F(CommandLine, RefusesAnInstructionSetThatItIsNotBuiltFor) {
  expect_refused(run("CSCD_ISA=sse cscd list"),
                 "CSCD_ISA=sse: no such instruction set; leave CSCD_ISA unset, or give ");
  EXPECT_EQ(run("CSCD_ISA= cscd list").status, 0);
}

TEST_F(CommandLine, SaysWhatItWasBuiltOf) {
  const Ran ran = run("cscd --version");
  EXPECT_EQ(ran.status, 0) << ran.errors;
  EXPECT_EQ(ran.out.find("cscd "), 0u);
  for (const char* part :
       {"\ncommit: ", "\ncompiler: ", "\ninstruction set: ", "\nlibraries: eigen 3", " hdf5 1", " gmp 6"})
    EXPECT_NE(ran.out.find(part), std::string::npos) << part << " in " << ran.out;
}

TEST_F(CommandLine, HelpsAsEachCommandDoes) {
  EXPECT_EQ(run("cscd help").out, run("cscd --help").out);
  for (const std::string command : {"query", "run", "scene accept"}) {
    const Ran ran = run("cscd help " + command);
    EXPECT_EQ(ran.status, 0);
    EXPECT_EQ(ran.out, run("cscd " + command + " --help").out);
    EXPECT_GT(ran.out.size(), 50u);
  }
}

TEST_F(CommandLine, ListsNamesAndFaults) {
  put("scenes/broken.json", "{");
  EXPECT_EQ(run("cscd list scenes --names").out, "broken\nsmall\n");
  const Ran listed = run("cscd list scenes");
  EXPECT_EQ(listed.status, 0);
  EXPECT_NE(listed.out.find("  broken  FAULT: "), std::string::npos) << listed.out;
  EXPECT_NE(listed.out.find("  small   160 triangles, 6 frames. A chain falls.\n"), std::string::npos)
      << listed.out;
  EXPECT_NE(run("cscd list small").out.find("  vertices: 82\n"), std::string::npos);
  EXPECT_EQ(run("cscd query small --json /dev/null").status, 0) << "breaks nothing else";
  const Ran all = run("cscd run --scene all --json records");
  expect_refused(all, "broken.json: is not JSON");
}

TEST_F(CommandLine, ListsEverythingInALineEach) {
  const Ran all = run("cscd list");
  EXPECT_EQ(all.status, 0) << all.errors;
  std::istringstream lines(all.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 110u) << line;
  EXPECT_NE(all.out.find("\n  base "), std::string::npos) << all.out;
  const Ran twist = run("cscd list twist");
  EXPECT_NE(twist.out.find("turns  rows of 2 numbers; unit frame, turn; required\n"), std::string::npos)
      << twist.out;
  expect_refused(run("cscd list twits"), "did you mean twist?");
  expect_refused(run("cscd list --markdown"), "scene-file");
}

// The page comes from the rows by which scene files are read. To write it anew:
// cscd list scene-file --markdown > scenes/README.md
TEST_F(CommandLine, HasThePageOfSceneFiles) {
  EXPECT_EQ(run("cscd list scene-file --markdown").out, test::read(scenes::scenes_folder() / "README.md"));
  EXPECT_NE(run("cscd list scene-file").out.find("  frames    whole number; 2 to 100000000; required\n"),
            std::string::npos);
}

// Whoever asks for help learns within ten lines what the command does and how it is called.
TEST_F(CommandLine, SaysFirstWhatEachCommandDoes) {
  std::istringstream commands(run("cscd help | sed -n '/^Subcommands:/,/^$/s/^  \\([a-z]*\\) .*/\\1/p'").out);
  std::size_t seen = 0;
  for (std::string command; std::getline(commands, command); ++seen) {
    const std::string head = run("cscd " + command + " --help | head -10").out;
    EXPECT_NE(head.find("Usage:"), std::string::npos) << command << "\n" << head;
    EXPECT_TRUE(std::isupper(static_cast<unsigned char>(head.front()))) << command << "\n" << head;
  }
  EXPECT_GT(seen, 15u);
}

TEST_F(CommandLine, TakesASceneFileFromAnyPath) {
  std::string open = scenes::kSmallScene;
  open.replace(open.find("\"digest\": \"0000000000000000\""), 28, "\"digest\": null");
  open.replace(open.find(", \"digest\": null"), 16, "");
  put("mein Stück.json", open);
  const std::string file = "'mein Stück.json'";
  const Ran first = run("cscd query " + file + " --json -");
  EXPECT_EQ(first.status, 0);
  EXPECT_NE(first.errors.find("cscd scene accept"), std::string::npos) << first.errors;
  const Ran accepted = run("cscd scene accept " + file);
  EXPECT_EQ(accepted.status, 0) << accepted.errors;
  EXPECT_NE(accepted.out.find("82 vertices, 160 triangles, 4 bones, digest "), std::string::npos);
  EXPECT_EQ(text("mein Stück.json"), scenes::small_scene_with_digest());
  const Ran second = run("cscd query " + file + " --json -");
  EXPECT_EQ(second.errors.find("note"), std::string::npos) << second.errors;

  for (const std::string& command :
       {"export " + file + " out.h5", "inspect " + file, "clusters " + file + " --json c.json"})
    EXPECT_EQ(run("cscd " + command).status, 0) << command;
  const Ran ran = run("cscd run --smoke --strategy base,drvbc_fast --scene " + file + " --json r.json");
  EXPECT_EQ(ran.status, 0) << ran.errors;
  EXPECT_NE(ran.out.find("median total of an interval, with refit:\n  base "), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find(" ms\nrecord: r.json\n"), std::string::npos) << ran.out;
  const nlohmann::json record = nlohmann::json::parse(text("r.json"));
  EXPECT_EQ(record["scene"]["name"], "mein_Stück");
  EXPECT_EQ(record["scene"]["path"], "mein Stück.json");
  const Ran tables = run("cscd tables r.json");
  EXPECT_NE(tables.out.find(" mein_Stück\n"), std::string::npos) << tables.out;
  EXPECT_EQ(tables.out.find("no record of"), std::string::npos) << tables.out;
  // Two repetitions of a few intervals say nothing of speed, and the paper's claims are about whole scenes.
  EXPECT_EQ(tables.out.find("times faster"), std::string::npos) << tables.out;
  EXPECT_EQ(tables.out.find("are reproduced"), std::string::npos) << tables.out;
  EXPECT_NE(tables.out.find("\nclaims      none is made where "), std::string::npos) << tables.out;
}

TEST_F(CommandLine, DrawsFiguresOfAFileIntoTheFolderAlone) {
  const std::string scripts = (scenes::scenes_folder().parent_path() / "scripts").string();
  if (run("/usr/bin/python3 -c 'import matplotlib'").status != 0) GTEST_SKIP() << "no matplotlib";
  ASSERT_EQ(run("cscd export small model.h5 && cscd run --smoke --strategy base,mcd --scene "
                "\"$PWD/model.h5\" --json r.json")
                .status,
            0);
  nlohmann::json old = nlohmann::json::parse(text("r.json"));
  EXPECT_EQ(old["scene"]["name"], "model");
  old["scene"]["name"] = (folder / "model.h5").string();  // as older records have it
  put("old.json", old.dump());
  for (const char* record : {"r.json", "old.json"}) {
    const Ran ran = run("'" + scripts + "/figures' " + record +
                        " --program \"$(command -v cscd)\" --out figures && ls figures | head -1");
    EXPECT_EQ(ran.status, 0) << ran.errors;
    EXPECT_EQ(ran.out.substr(0, 5), "model") << ran.out;
    EXPECT_NE(ran.errors.find("drawn: figures/model"), std::string::npos) << ran.errors;
    EXPECT_EQ(run("rm -r figures").status, 0);
    EXPECT_EQ(files(), "model.h5 old.json r.json");
  }
}

}  // namespace
}  // namespace cscd::bench
