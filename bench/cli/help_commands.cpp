// The commands that speak of the program itself: help, completion, man.
#include <CLI/App.hpp>
#include <cstdio>
#include <vector>

#include "bench/cli/command_line/command.h"
#include "bench/cli/command_line/command_tree.h"
#include "bench/cli/command_line/completion.h"
#include "bench/cli/command_line/man_page.h"
#include "bench/cli/command_line/version.h"
#include "core/base/error.h"
#include "scenes/base/closest_name.h"

namespace cscd::bench {
namespace {

void print(const std::string& text) {
  std::fputs(text.c_str(), stdout);
}

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
    print(command->get_formatter()->make_help(command, called, CLI::AppFormatMode::Normal));
  });

  CLI::App* completion =
      app.add_subcommand("completion",
                         "Print a script that lets the shell complete commands, options and names.\n\n"
                         "  source <(cscd completion bash)");
  const auto forget = [](const std::string&) {};  // there is one shell, and the check has seen its name
  completion->add_option_function<std::string>("shell", forget, "bash")
      ->required()
      ->check(CLI::IsMember({"bash"}));
  completion->callback([&app] { print(bash_completion(command_tree(app))); });

  CLI::App* man = app.add_subcommand("man",
                                     "Print the manual page.\n\n"
                                     "  cscd man | man -l -");
  man->callback([&app] { print(man_page(command_tree(app), version_number())); });
}

}  // namespace cscd::bench
