#include "bench/cli/interface_commands.h"

#include <cstdio>
#include <filesystem>
#include <memory>

#include "bench/cli/interface/manual_page.h"
#include "bench/cli/interface/shell_completion.h"
#include "bench/command_line/add_options.h"
#include "bench/output/output.h"

namespace cscd::bench {

void add_completion(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "completion",
      "Print what a shell reads to complete commands, options and names of scenes and strategies.\n\n"
      "  source <(cscd completion bash)                           in ~/.bashrc\n"
      "  cscd completion zsh > ~/.zfunc/_cscd                     in a folder of zsh's $fpath\n\n"
      "An installed cscd has both where the shells look.");
  command->add_option("shell", *shell, "bash or zsh")->required()->check(CLI::IsMember({"bash", "zsh"}));
  command->callback([shell, &app] {
    const std::vector<CommandWords> tree = command_tree(app);
    std::fputs((*shell == "bash" ? bash_completion(tree) : zsh_completion(tree)).c_str(), stdout);
  });
}

void add_manual(CLI::App& app) {
  struct Options {
    std::string folder;
    bool force = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("manual",
                         "Write the manual page of the program and of each command, for man.\n\n"
                         "  cscd manual --out man && man man/cscd-query.1");
  using O = Options;
  static const OptionRow<O> rows[] = {
      required<O>({"--out", &O::folder, "the folder; made where it is missing"}),
      {"--force", &O::force, "replace files that exist"}};
  add_options<O>(*command, rows, *options);
  command->callback([options, &app] {
    make_folder(options->folder, "--out");
    const std::vector<CommandWords> tree = command_tree(app);
    for (const CommandWords& words : tree)
      OutputFile(std::filesystem::path(options->folder) / (manual_page_name(words) + ".1"), options->force,
                 ".1")
          .commit(manual_page(tree, words));
  });
}

}  // namespace cscd::bench
