#include "bench/cli/interface/command_tree.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace cscd::bench {
namespace {

std::string on_one_line(std::string text) {
  text.erase(std::min(text.find("\n\n"), text.size()));
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

// The words of a choice, which CLI11 writes behind the type of a value as "TEXT:{bash,zsh}".
std::vector<std::string> choice_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{'), end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  return CLI::detail::split(type.substr(begin + 1, end - begin - 1), ',');
}

// A number and a choice are no files. A name that stands for a section of `cscd list` has the names of its
// rows.
Values values_of(const CLI::Option& option, const std::vector<std::string>& names) {
  struct Named {
    std::string_view option, section;
    bool or_files;
  };
  constexpr std::array kSections = {Named{"--scene", "scenes", true}, Named{"input", "scenes", true},
                                    Named{"--strategy", "strategies", false},
                                    Named{"--elementary", "tests", false}, Named{"what", "all", false}};
  Values values;
  values.words = choice_of(option);
  values.are_joined = option.get_delimiter() != '\0';
  if (!values.words.empty()) return values;
  const auto* const named = std::ranges::find_if(
      kSections, [&](const Named& row) { return std::ranges::find(names, row.option) != names.end(); });
  if (named != kSections.end()) values.section = named->section;
  const std::string type = option.get_type_name();
  values.files =
      named != kSections.end() ? named->or_files : type.starts_with("TEXT") || type.starts_with("FILE");
  values.are_joined = named != kSections.end() && names.front().starts_with("--");
  return values;
}

OptionWords words_of(const CLI::Option& option) {
  OptionWords words{&option, {}, on_one_line(option.get_description()), option.get_items_expected_max() > 0,
                    false,   {}};
  for (const std::string& name : option.get_snames()) words.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) words.names.push_back("--" + name);
  if (words.names.empty()) words.names.push_back(option.get_name(true));
  words.may_repeat = option.get_items_expected_max() > 1;
  if (words.takes_value) words.values = values_of(option, words.names);
  return words;
}

void add(std::vector<CommandWords>& all, const CLI::App& command, const std::vector<std::string>& path) {
  const std::size_t place = all.size();
  all.push_back({&command, path, on_one_line(command.get_description()), {}, {}, {}});
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;  // hidden
    auto& list = option->nonpositional() ? all[place].options : all[place].arguments;
    list.push_back(words_of(*option));
  }
  for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; })) {
    all[place].commands.push_back(all.size());
    std::vector<std::string> longer = path;
    longer.push_back(below->get_name());
    add(all, *below, longer);
  }
}

}  // namespace

std::vector<CommandWords> command_tree(const CLI::App& program) {
  std::vector<CommandWords> all;
  add(all, program, {});
  std::vector<std::string> names;
  for (const std::size_t place : all.front().commands) names.push_back(all[place].path.back());
  for (CommandWords& command : all)
    for (OptionWords& argument : command.arguments)
      if (argument.names.front() == "command") argument.values = {names, "", false, false};  // of `help`
  return all;
}

}  // namespace cscd::bench
