#include "bench/command_line/add_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <vector>

namespace cscd::bench {
namespace {

struct Asked {
  std::string mode = "slow";
  std::vector<std::string> records, names, each;
  std::vector<double> steps;
  std::size_t count = 3;
  double tolerance = 0, weight = 0;
  std::optional<int> rings;
  bool smoke = false;
  bool operator==(const Asked&) const = default;
};

using A = Asked;
const OptionRow<A> kRecords[] = {required<A>({"records", &A::records, "files"})};
const OptionRow<A> kRows[] = {
    {.name = "--mode", .member = &A::mode, .help = "how", .choices = {"slow", "fast"}},
    {"--names", &A::names, "with commas"},
    {.name = "--each", .member = &A::each, .help = "one by one", .repeats = true},
    {"--steps", &A::steps, "numbers", {{0, 10}}},
    {"--count", &A::count, "how many", {{1, 100}}},
    {.name = "--tolerance", .member = &A::tolerance, .help = "a share", .names_zero = true},
    {"--weight", &A::weight, "default by the others"},
    {"--rings", &A::rings, "how far"},
    {"--smoke", &A::smoke, "soon"}};

struct Command {
  CLI::App app;
  Asked asked;
  Command() {
    add_options<A>(app, kRecords, asked);
    add_options<A>(app, kRows, asked);
  }
  Asked parsed(std::vector<std::string> words) {
    std::ranges::reverse(words);  // as CLI11 takes them
    app.parse(words);
    return asked;
  }
};

std::vector<std::string> echoed(const Asked& asked) {
  std::vector<std::string> words = {"a,b.json", "c.json"};
  echo_options<A>(kRows, asked, words);
  return words;
}

// Mutations: a positional list is divided at commas; a repeated option is echoed as one with commas.
TEST(OptionRows, AreEchoedAsACommandLineThatSaysTheSame) {
  const std::vector<std::string> words = {"a,b.json", "c.json", "--mode",      "fast", "--names",  "x,y",
                                          "--each",   "p,q",    "--each",      "r",    "--steps",  "0.5,2.0",
                                          "--count",  "7",      "--tolerance", "0.25", "--weight", "0.0",
                                          "--rings",  "0",      "--smoke"};
  const Asked asked = Command().parsed(words);
  EXPECT_EQ(asked.records, (std::vector<std::string>{"a,b.json", "c.json"}));
  EXPECT_EQ(asked.names, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(asked.each, (std::vector<std::string>{"p,q", "r"}));
  EXPECT_EQ(asked.steps, (std::vector<double>{0.5, 2}));
  EXPECT_EQ(echoed(asked), words);

  const Asked usual = Command().parsed({"a,b.json", "c.json"});
  const std::vector<std::string> spelt_out = echoed(usual);
  EXPECT_EQ(spelt_out, (std::vector<std::string>{"a,b.json", "c.json", "--mode", "slow", "--count", "3",
                                                 "--tolerance", "0.0", "--weight", "0.0"}));
  EXPECT_EQ(Command().parsed(spelt_out), usual);
}

TEST(OptionRows, RefuseWhatTheyDoNotAllow) {
  EXPECT_THROW(Command().parsed({}), CLI::RequiredError);
  EXPECT_THROW(Command().parsed({"a", "--mode", "fats"}), CLI::ValidationError);
  EXPECT_THROW(Command().parsed({"a", "--count", "0"}), CLI::ValidationError);
  EXPECT_THROW(Command().parsed({"a", "--steps", "1,11"}), CLI::ValidationError);
}

// A zero that stands for another default is not named.
TEST(OptionRows, NameDefaultsInHelp) {
  const std::string help = Command().app.help();
  for (const char* named : {"--count UINT:INT in [1 - 100]=3\n", "--tolerance FLOAT=0 ", "--weight FLOAT  ",
                            "--rings INT  ", "--mode TEXT:{slow,fast}=slow\n"})
    EXPECT_NE(help.find(named), std::string::npos) << named << help;
}

}  // namespace
}  // namespace cscd::bench
