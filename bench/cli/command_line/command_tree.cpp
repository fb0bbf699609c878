#include "bench/cli/command_line/command_tree.h"

#include <sstream>

namespace cscd::bench {
namespace {

// "TEXT:{vf,ee}" names the choices.
std::vector<std::string> choices_in(const std::string& type) {
  const std::size_t begin = type.find('{'), end = type.find('}', begin);
  std::vector<std::string> choices;
  if (begin == std::string::npos || end == std::string::npos) return choices;
  std::istringstream list(type.substr(begin + 1, end - begin - 1));
  for (std::string choice; std::getline(list, choice, ',');) choices.push_back(choice);
  return choices;
}

OptionRow row_of(const CLI::Option& option) {
  OptionRow row;
  row.positional = option.get_positional() && !option.nonpositional();
  for (const std::string& name : option.get_snames()) row.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) row.names.push_back("--" + name);
  if (row.positional) row.names = {option.get_name(true)};
  row.required = option.get_required();
  row.takes_value = option.get_items_expected_max() > 0;
  row.takes_several = option.get_items_expected_max() > 1;
  row.description = option.get_description();
  row.group = option.get_group();
  const std::string type = option.get_type_name();
  row.choices = choices_in(type);
  if (row.takes_value) row.value = type.substr(0, type.find(':'));
  row.otherwise = option.get_default_str();
  return row;
}

void append(const CLI::App& app, const std::vector<std::string>& words, std::vector<CommandRow>& rows) {
  CommandRow row;
  row.words = words;
  row.description = app.get_description();
  for (const CLI::Option* option : app.get_options()) row.options.push_back(row_of(*option));
  const std::vector<const CLI::App*> below = app.get_subcommands([](const CLI::App*) { return true; });
  for (const CLI::App* command : below) row.commands.push_back(command->get_name());
  rows.push_back(std::move(row));
  for (const CLI::App* command : below) {
    std::vector<std::string> longer = words;
    longer.push_back(command->get_name());
    append(*command, longer, rows);
  }
}

}  // namespace

std::vector<CommandRow> command_tree(const CLI::App& program) {
  std::vector<CommandRow> rows;
  append(program, {}, rows);
  return rows;
}

}  // namespace cscd::bench
