#include "bench/output/glossary.h"

#include <algorithm>
#include <set>

#include "bench/strategies/catalogue.h"
#include "bench/testing/test_shell.h"
#include "core/elementary/catalogue.h"

namespace cscd::bench {
namespace {

// How many sentences a text has. The blank behind "et al." ends none.
std::size_t sentences(std::string text) {
  for (std::size_t at = 0; (at = text.find("et al. ", at)) != std::string::npos;) text.erase(at + 5, 1);
  std::size_t count = text.ends_with('.') ? 1 : 0;
  for (std::size_t at = 0; (at = text.find(". ", at)) != std::string::npos; ++at) ++count;
  return count;
}

TEST(Glossary, SaysTwoSentencesOfEachWord) {
  std::set<std::string> forms;
  for (const Word& word : words()) {
    EXPECT_EQ(sentences(word.means), 2u) << word.name;
    std::vector<std::string> all = word.also;
    all.push_back(word.name);
    for (const std::string& form : all) {
      EXPECT_TRUE(forms.insert(form).second) << form << " is explained twice";
      EXPECT_EQ(word_called(form), &word) << form;
    }
  }
}

TEST(Glossary, SaysTwoSentencesOfEachStrategyAndTest) {
  std::vector<std::string> names;
  for (const Strategy& strategy : strategies()) names.emplace_back(strategy.name);
  for (const ElementaryTest& test : all_elementary_tests()) names.emplace_back(test.name);
  for (const std::string& name : names) EXPECT_EQ(sentences(meaning_of_name(name).value_or("")), 2u) << name;
  for (const Strategy& strategy : strategies()) {
    EXPECT_NE(word_called(to_string(strategy.guarantee)), nullptr) << strategy.name;
    if (!strategy.group.empty()) {
      EXPECT_NE(word_called(strategy.group), nullptr) << strategy.group;
    }
  }
}

TEST(Glossary, FindsWordsInAnyForm) {
  EXPECT_EQ(word_called("bvot"), word_called("BVOT"));
  EXPECT_EQ(word_called("mega-clusters"), word_called("mega cluster"));
  EXPECT_EQ(word_called("first contact"), word_called("first_contact"));
  EXPECT_EQ(word_called("nothing of this"), nullptr);
  EXPECT_EQ(words_in("an ulp; Embedded starts."), (std::vector<std::string>{"start", "embedded", "ulp"}));
  EXPECT_TRUE(words_in("gulps").empty()) << "a part of a word is no word";
}

class GlossaryProgram : public Program {};

TEST_F(GlossaryProgram, ExplainsWhatIsAskedFor) {
  for (const std::string what :
       {"BVOT", "pctp", "DRVBC", "16-dop", "embedding", "embedded", "oracle", "refit", "guarantee",
        "mega cluster", "mcd", "drvbc_fast_all", "filtered_exact"}) {
    const Ran ran = run("cscd list " + what);
    EXPECT_EQ(ran.status, 0) << ran.errors;
    const std::size_t from = ran.out.find("\n  "), to = ran.out.find('\n', from + 1);
    ASSERT_NE(from, std::string::npos) << ran.out;
    EXPECT_EQ(sentences(ran.out.substr(from + 3, to - from - 3)), 2u) << ran.out;
  }
  EXPECT_NE(run("cscd list small").out.find("story: "), std::string::npos) << "of a scene, its story";
  expect_refused(run("cscd list refti"), "did you mean refit?");
}

// Words of this field, or of this project alone, that help has used. Whichever help still uses has to be
// explained.
TEST_F(GlossaryProgram, ExplainsTheWordsOfHelp) {
  constexpr const char* kHard[] = {"BVOT",           "PCTP",
                                   "embedded",       "guarantee",
                                   "void",           "observer",
                                   "positive",       "public format",
                                   "oracle",         "lattice",
                                   "ulps",           "digest",
                                   "pairings",       "penalised least squares",
                                   "floors",         "diagonal",
                                   "refit",          "culling",
                                   "elementary test"};
  const Ran commands =
      run("cscd --help | sed -n '/^Subcommands:/,/^$/p' | sed -n 's/^  \\([a-z]\\+\\) .*/\\1/p'");
  ASSERT_NE(commands.out.find("hardcases"), std::string::npos) << commands.out;
  std::stringstream names(commands.out);
  std::size_t used = 0;
  for (std::string name; std::getline(names, name);) {
    const std::string help = run("cscd help " + name).out;
    const std::size_t footer = help.find("Words that `cscd list WORD` explains:");
    for (const char* word : kHard) {
      if (help.substr(0, footer).find(word) == std::string::npos) continue;
      ++used;
      ASSERT_NE(word_called(word), nullptr) << name << " uses " << word;
      ASSERT_NE(footer, std::string::npos) << name << " uses " << word;
      EXPECT_NE(help.find(word_called(word)->name, footer), std::string::npos) << name << " uses " << word;
    }
  }
  EXPECT_GT(used, 10u);
}

}  // namespace
}  // namespace cscd::bench
