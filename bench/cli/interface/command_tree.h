#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

// What the program's command line knows of itself, as shells and manual pages need it.
namespace cscd::bench {

// What a value of an option, or an argument without an option's name, may be.
struct Values {
  std::vector<std::string> words;  // a fixed choice
  std::string section;             // of `cscd list`: its names are values, too
  bool files = false;
  bool are_joined = false;  // by commas
};

struct OptionWords {
  const CLI::Option* option;
  std::vector<std::string> names;  // "-o", "--out"; of a positional argument its name alone
  std::string meaning;             // its description on one line
  bool takes_value = false;
  bool may_repeat = false;
  Values values;
};

// A command, or the program itself.
struct CommandWords {
  const CLI::App* command;
  std::vector<std::string> path;     // "benchmark", "make"; empty for the program
  std::string meaning;               // the first paragraph of its description, on one line
  std::vector<OptionWords> options;  // help included
  std::vector<OptionWords> arguments;
  std::vector<std::size_t> commands;  // the places in command_tree() of the commands below it
};

// Returns the program and all of its commands, each before those below it.
std::vector<CommandWords> command_tree(const CLI::App& program);

}  // namespace cscd::bench
