#pragma once

#include <CLI/App.hpp>
#include <string>

namespace cscd::bench {

// As CLI11's own, but the list of commands has the first paragraph of each command's description alone; the
// rest is in the command's own help.
class HelpFormat : public CLI::Formatter {
 public:
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

}  // namespace cscd::bench
