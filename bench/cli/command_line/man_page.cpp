#include "bench/cli/command_line/man_page.h"

#include <sstream>

#include "scenes/base/joined.h"

namespace cscd::bench {
namespace {

// A line of text in which nothing is a request or an escape of roff.
std::string escaped(const std::string& line) {
  std::string out;
  for (const char c : line) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return !out.empty() && (out[0] == '.' || out[0] == '\'') ? "\\&" + out : out;
}

// Lines that are indented stand as they are; the others are filled.
std::string paragraphs(const std::string& text) {
  std::istringstream lines(text);
  std::string out;
  bool as_it_is = false;
  for (std::string line; std::getline(lines, line);) {
    const bool indented = line.starts_with("  ");
    if (indented != as_it_is) out += indented ? ".PP\n.nf\n" : ".fi\n";
    as_it_is = indented;
    out += line.empty() ? ".PP\n" : escaped(line) + "\n";
  }
  if (as_it_is) out += ".fi\n";
  return out;
}

std::string option_text(const OptionRow& option) {
  std::string out = ".TP\n\\fB" + escaped(joined(option.names, ", ")) + "\\fR";
  if (!option.positional && !option.value.empty())
    out += " \\fI" + escaped(option.choices.empty() ? option.value : joined(option.choices, "|")) + "\\fR";
  out += "\n";
  std::string description = option.description;
  if (option.positional && !option.choices.empty()) description += " (" + joined(option.choices, ", ") + ")";
  if (!option.otherwise.empty()) description += " (default " + option.otherwise + ")";
  if (option.required) description += " (required)";
  std::istringstream lines(description.empty() ? "See above." : description);
  for (std::string line; std::getline(lines, line);) out += escaped(line) + "\n";
  return out;
}

std::string synopsis(const CommandRow& command) {
  std::string out = "cscd " + joined(command.words, " ");
  for (const OptionRow& option : command.options)
    if (option.positional)
      out += option.required ? " " + option.names[0] : " [" + option.names[0] + "]";
    else if (option.required)
      out += " " + option.names[0] + " " + option.value;
  return out + " [options]";
}

}  // namespace

std::string man_page(std::span<const CommandRow> commands, const std::string& version) {
  std::string out = ".TH CSCD 1 \"\" \"cscd " + escaped(version) + "\" \"User Commands\"\n.SH NAME\n" +
                    "cscd \\- continuous self\\-collision detection of animated triangle meshes\n" +
                    ".SH SYNOPSIS\n\\fBcscd\\fR \\fIcommand\\fR [\\fIoptions\\fR]\n";
  for (const CommandRow& command : commands) {
    if (command.words.empty())
      out += ".SH DESCRIPTION\n";
    else
      out += ".SH \"" + escaped(joined(command.words, " ")) + "\"\n\\fB" + escaped(synopsis(command)) +
             "\\fR\n.PP\n";
    out += paragraphs(command.description);
    for (const OptionRow& option : command.options) out += option_text(option);
  }
  return out;
}

}  // namespace cscd::bench
