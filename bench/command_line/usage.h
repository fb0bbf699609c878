#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>

namespace cscd::bench {

// The version that CMakeLists.txt gives the project, such as "1.2.3".
std::string version_number();

// Returns what this program was built from and with, one line each: version, commit, compiler, instruction
// set, libraries.
std::string version_text();

// As CLI11's own, but a command's help begins with the first paragraph of its description and the usage; the
// rest of the description follows. The list of commands has the first paragraphs alone, and the end names the
// words that `cscd list` explains.
class HelpFormat : public CLI::Formatter {
 public:
  std::string make_description(const CLI::App* command) const override {
    const std::string text = command->get_description();
    return text.substr(0, text.find("\n\n")) + "\n";
  }
  std::string make_usage(const CLI::App* command, std::string name) const override {
    const std::string text = command->get_description();
    const std::size_t rest = text.find("\n\n");
    return CLI::Formatter::make_usage(command, std::move(name)) +
           (rest == std::string::npos ? "" : text.substr(rest + 1) + "\n");
  }
  // Names the words of the help that the glossary explains.
  std::string make_footer(const CLI::App* command) const override;
  std::string make_subcommand(const CLI::App* command) const override {
    std::string text = command->get_description();
    text.erase(std::min(text.find("\n\n"), text.size()));
    for (char& c : text)
      if (c == '\n') c = ' ';
    std::stringstream out;
    CLI::detail::format_help(out, command->get_display_name(true), text, get_column_width());
    return out.str();
  }
};

// Has every option that takes a number, of the program and of all its commands, refuse a text that is no
// plain finite number in the range of its type. CLI11 alone takes "nan", which no comparison with a range
// refuses, and makes the largest number of one that is too large.
void require_plain_numbers(CLI::App& program);

// One line that says what is wrong with a command line. A misspelt command or option is named before anything
// that is missing, since what is missing is often what was misspelt.
std::string usage_error(const CLI::App& program, const CLI::ParseError& error);

// Throws InputError for a word that is not UTF-8, because it could stand in no answer, all of which are JSON,
// and for a word with characters that control a terminal or the direction of writing, because answers for
// people repeat it.
void require_text(int count, const char* const* words);

}  // namespace cscd::bench
