#include <CLI/App.hpp>
#include <cstdio>
#include <vector>

#include "bench/command_line/command.h"
#include "core/base/error.h"
#include "scenes/base/closest_name.h"

namespace cscd::bench {
namespace {

const CLI::App& command_below(const CLI::App& app, const std::string& word) {
  std::vector<std::string_view> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == word) return *command;
    names.push_back(command->get_name());
  }
  throw InputError("unknown command " + word + did_you_mean(word, names) + "; see cscd help");
}

}  // namespace

void add_help(CLI::App& app) {
  auto words = std::make_shared<std::vector<std::string>>();
  CLI::App* help = app.add_subcommand("help", "Show what a command does and takes, as its --help does.");
  help->add_option("command", *words, "the command; default the program");
  help->callback([words, &app] {
    const CLI::App* command = &app;
    std::string called = app.get_name();
    for (const std::string& word : *words) {
      command = &command_below(*command, word);
      called += " " + word;
    }
    std::fputs(command->get_formatter()->make_help(command, called, CLI::AppFormatMode::Normal).c_str(),
               stdout);
  });
}

}  // namespace cscd::bench
