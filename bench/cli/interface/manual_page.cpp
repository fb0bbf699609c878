#include "bench/cli/interface/manual_page.h"

#include <cctype>
#include <sstream>

#include "bench/command_line/usage.h"
#include "scenes/base/joined.h"

namespace cscd::bench {
namespace {

// A text that stands as it is: a backslash, a hyphen, and a point or a quote at the start of a line mean
// something.
std::string plain(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if ((c == '.' || c == '\'') && (i == 0 || text[i - 1] == '\n')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

std::string bold(const std::string& text) {
  return "\\fB" + plain(text) + "\\fR";
}

// Lines that are indented are commands, and stay as they are; others are filled.
std::string paragraphs(const std::string& text) {
  std::istringstream lines(text);
  std::string out;
  bool verbatim = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) {
      out += verbatim ? ".fi\n.PP\n" : ".PP\n";
      verbatim = false;
      continue;
    }
    if (line.starts_with("  ") != verbatim) {
      verbatim = !verbatim;
      out += verbatim ? ".nf\n" : ".fi\n";
    }
    out += plain(line) + "\n";
  }
  return out + (verbatim ? ".fi\n" : "");
}

std::string entry(const OptionWords& words) {
  std::vector<std::string> names;
  for (const std::string& name : words.names) names.push_back(bold(name));
  return ".TP\n" + joined(names, ", ") + plain(CLI::Formatter().make_option_opts(words.option)) + "\n" +
         plain(words.option->get_description()) + "\n";
}

// The groups in the order in which they come first.
std::vector<std::string> groups_of(const CommandWords& command) {
  std::vector<std::string> groups;
  for (const OptionWords& option : command.options)
    if (std::find(groups.begin(), groups.end(), option.option->get_group()) == groups.end())
      groups.push_back(option.option->get_group());
  return groups;
}

}  // namespace

std::string manual_page_name(const CommandWords& command) {
  return "cscd" + (command.path.empty() ? "" : "-" + joined(command.path, "-"));
}

std::string manual_page(const std::vector<CommandWords>& tree, const CommandWords& command) {
  const std::string name = manual_page_name(command), version = "cscd " + version_number();
  std::string title = name, meaning = command.path.empty()
                                          ? command.meaning.substr(command.meaning.find(": ") + 2)
                                          : command.meaning;
  for (char& c : title) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  if (meaning.ends_with('.')) meaning.pop_back();

  std::string out = ".TH " + title + " 1 \"\" \"" + version + "\" \"" + version + "\"\n.SH NAME\n" +
                    plain(name) + " \\- " + plain(meaning) + "\n.SH SYNOPSIS\n" +
                    bold("cscd" + (command.path.empty() ? "" : " " + joined(command.path, " "))) +
                    " [\\fIOPTIONS\\fR]";
  for (const OptionWords& argument : command.arguments) {
    const std::string word =
        "\\fI" + plain(argument.names.front()) + "\\fR" + (argument.may_repeat ? " ..." : "");
    out += argument.option->get_required() ? " " + word : " [" + word + "]";
  }
  if (!command.commands.empty()) out += " \\fICOMMAND\\fR ...";
  out += "\n.SH DESCRIPTION\n" + paragraphs(command.command->get_description());
  if (!command.arguments.empty()) out += ".SH ARGUMENTS\n";
  for (const OptionWords& argument : command.arguments) out += entry(argument);
  for (const std::string& group : groups_of(command)) {
    out += group == "Options" ? ".SH OPTIONS\n" : ".SS " + plain(group) + "\n";
    for (const OptionWords& option : command.options)
      if (option.option->get_group() == group) out += entry(option);
  }
  std::vector<std::string> others;
  if (!command.commands.empty()) out += ".SH COMMANDS\n";
  for (const std::size_t place : command.commands) {
    out += ".TP\n" + bold(tree[place].path.back()) + "\n" + plain(tree[place].meaning) + "\n";
    others.push_back(bold(manual_page_name(tree[place])) + "(1)");
  }
  if (!command.path.empty()) others.push_back(bold("cscd") + "(1)");
  return out + ".SH SEE ALSO\n" + joined(others, ",\n") + "\n";
}

}  // namespace cscd::bench
