#include <gtest/gtest.h>
#include <regex>
#include <sstream>

#include "bench/testing/test_shell.h"

// What shells complete and manual pages say is what the program's help says.
namespace cscd::bench {

namespace {

class Interface : public Program {
 protected:
  // What bash offers for the last word of a command line, in order, in one line.
  std::string offered(const std::string& words) const {
    const Ran ran = run("source <(cscd completion bash)\nCOMP_WORDS=(" + words +
                        ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_cscd\n"
                        "printf '%s\\n' \"${COMPREPLY[@]}\" | sort | paste -s -d ' '");
    EXPECT_EQ(ran.status, 0) << ran.errors;
    EXPECT_EQ(ran.errors, "") << words;
    return ran.out.substr(0, ran.out.find('\n'));
  }

  // Every option in the list that a command's help shows.
  std::set<std::string> options_of(const std::string& command) const {
    const std::string help = run("cscd help " + command).out;
    const std::regex column("\n  (-[-a-zA-Z,]+)"), name("--[a-z-]+");
    std::set<std::string> names;
    for (std::sregex_iterator i(help.begin(), help.end(), column), end; i != end; ++i) {
      const std::string all = (*i)[1];
      for (std::sregex_iterator k(all.begin(), all.end(), name); k != end; ++k) names.insert(k->str());
    }
    return names;
  }

  std::vector<std::string> commands() const {
    std::istringstream lines(run("cscd help").out);
    std::vector<std::string> names;
    bool listed = false;
    for (std::string line; std::getline(lines, line);) {
      if (line == "Subcommands:" || line.empty())
        listed = !line.empty();
      else if (std::smatch found; listed && std::regex_search(line, found, std::regex("^  ([a-z]+) ")))
        names.push_back(found[1]);
    }
    return names;
  }
};

TEST_F(Interface, BashCompletesWhatTheHelpNames) {
  EXPECT_EQ(offered("cscd qu"), "query");
  EXPECT_EQ(offered("cscd benchmark ''"), "answer judge make");
  EXPECT_EQ(offered("cscd query --fail-d"), "--fail-deeper-than");
  EXPECT_EQ(offered("cscd query small --fail-d"), "--fail-deeper-than");
  EXPECT_EQ(offered("cscd completion ''"), "bash zsh");
  EXPECT_EQ(offered("cscd elementary a.csv --kind ''"), "ee vf");
  EXPECT_EQ(offered("cscd help benc"), "benchmark");
  const std::vector<std::string> all = commands();
  ASSERT_GT(all.size(), 15u);
  for (const std::string& command : all) {
    const std::set<std::string> named = options_of(command);
    std::istringstream words(offered("cscd " + command + " -"));
    std::set<std::string> completed;
    for (std::string word; words >> word;)
      if (word.starts_with("--")) completed.insert(word);
    EXPECT_EQ(completed, named) << command;
    EXPECT_TRUE(named.contains("--help")) << command;
  }
}

// Mutations: names of scenes are those of the build; what stands before a comma is lost.
TEST_F(Interface, BashCompletesNamesThatTheProgramLists) {
  put("scenes/my.json", "{");
  put("mesh.obj", "");
  EXPECT_EQ(offered("cscd query m"), "mesh.obj my");
  EXPECT_EQ(offered("cscd run --scene my"), "my");
  EXPECT_EQ(offered("cscd run --scene small,s"), "small,scenes small,small");
  EXPECT_EQ(offered("cscd run --strategy drvbc_fast_a"), "drvbc_fast_all");
  EXPECT_EQ(offered("cscd run --strategy mcd,drvbc_fast_a"), "mcd,drvbc_fast_all");
  EXPECT_EQ(offered("cscd run --strategy = drvbc_fast_a"), "drvbc_fast_all");
  EXPECT_EQ(offered("cscd run --pipeline ="), "published today");
  EXPECT_EQ(offered("cscd run --pipeline p"), "published");
  EXPECT_EQ(offered("cscd scale --study si"), "size");
  EXPECT_EQ(offered("cscd scale --study size,st"), "size,step");
  EXPECT_EQ(offered("cscd history --stage pre"), "preparation");
  EXPECT_EQ(offered("cscd run --json mes"), "mesh.obj");
  EXPECT_EQ(offered("cscd list effe"), "effects");
  EXPECT_EQ(offered("cscd list twi"), "twist");
}

TEST_F(Interface, ZshReadsWhatIsWrittenForIt) {
  if (run("command -v zsh").status != 0) GTEST_SKIP() << "zsh is not installed";
  // The functions of zsh's completion say what they were given.
  const Ran ran = run(R"sh(cscd completion zsh >_cscd
cat >ask <<'TEXT'
_arguments() { local word; for word; do print -r -- "$word"; done; state=rest line=(query) }
source ./_cscd
TEXT
zsh -f ask)sh");
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.errors, "");
  EXPECT_NE(ran.out.find("--fail-deeper-than["), std::string::npos) << ran.out;
  for (const std::string& option : options_of("query"))
    EXPECT_TRUE(ran.out.find(option + "[") != std::string::npos ||
                ran.out.find(option + "=[") != std::string::npos)
        << option;
}

TEST_F(Interface, EachCommandHasAManualPage) {
  const Ran written = run("cscd manual --out pages/man");
  EXPECT_EQ(written.status, 0) << written.errors;
  expect_refused(run("cscd manual --out pages/man"), "cscd.1");
  EXPECT_EQ(run("cscd manual --out pages/man --force").status, 0);
  const bool can_be_shown = run("command -v man").status == 0;
  for (const std::string& command : commands()) {
    const std::string page = "pages/man/cscd-" + command + ".1";
    std::string source = text(page);
    EXPECT_EQ(source.find(".TH CSCD-"), 0u) << command;
    for (const std::string& option : options_of(command))
      EXPECT_NE(std::regex_replace(source, std::regex(R"(\\-)"), "-").find("\\fB" + option + "\\fR"),
                std::string::npos)
          << command << " " << option;
    if (!can_be_shown) continue;
    const Ran shown = run("MANWIDTH=120 LC_ALL=C.UTF-8 man --warnings -l '" + page + "'");
    EXPECT_EQ(shown.status, 0) << shown.errors;
    EXPECT_EQ(shown.errors, "") << command;
    EXPECT_NE(shown.out.find("SYNOPSIS\n"), std::string::npos) << command;
  }
  EXPECT_NE(text("pages/man/cscd-benchmark-make.1").find(".SH SYNOPSIS\n\\fBcscd benchmark make\\fR"),
            std::string::npos);
}

}  // namespace

}  // namespace cscd::bench
