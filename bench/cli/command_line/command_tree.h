#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace cscd::bench {

// The description of one option. Help pages, the manual page and the completion are all made from these
// descriptions, so that none of them is written twice.
struct OptionRow {
  std::vector<std::string> names;  // "--scene", "--input"; of a positional argument its one name
  bool positional = false, required = false, takes_value = false, takes_several = false;
  std::string description, group;
  std::string value;                 // "TEXT", "UINT", ...; empty for a flag
  std::string otherwise;             // the default; empty where there is none
  std::vector<std::string> choices;  // where only these are allowed
};

struct CommandRow {
  std::vector<std::string> words;  // {"scene", "accept"}; empty for the program itself
  std::string description;
  std::vector<OptionRow> options;
  std::vector<std::string> commands;  // the words that may follow
};

// The program, then every command, each before the commands below it.
std::vector<CommandRow> command_tree(const CLI::App& program);

}  // namespace cscd::bench
