#include <CLI/CLI.hpp>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <unistd.h>

#include "bench/cli/interface_commands.h"
#include "bench/command_line/command.h"
#include "bench/command_line/standard_streams.h"
#include "bench/command_line/usage.h"
#include "bench/output/output.h"
#include "core/base/error.h"
#include "core/base/instruction_set.h"
#include "core/base/memory.h"
#include "scenes/base/temporaries.h"

namespace {

int complain(const std::string& text) {
  std::fprintf(stderr, "cscd: %s\n", text.c_str());
  return static_cast<int>(cscd::bench::ExitStatus::refused);
}

#ifdef CSCD_ALL_ISAS
// This program is compiled for plain x86-64, and programs beside it for wider instruction sets. Runs the
// widest that the machine has in the place of this process, and returns if that is this program.
void run_for_this_machine(char** argv) {
  using enum cscd::InstructionSet;
  const cscd::InstructionSet chosen = cscd::chosen_among(std::array{avx512, avx2, baseline});
  if (chosen == cscd::engine_set()) return;
  const std::string program =
      std::filesystem::read_symlink("/proc/self/exe").string() + "-" + std::string(to_string(chosen));
  execv(program.c_str(), argv);
  throw cscd::InputError(program + ": " + std::strerror(errno) +
                         "; install the whole program, or choose what is here with CSCD_ISA=baseline");
}
#else
// The engine is compiled for one instruction set: refuses to be asked for another, or to run without it.
void run_for_this_machine(char** /*argv*/) {
  cscd::chosen_among(std::array{cscd::engine_set()});
}
#endif

int run(int argc, char** argv) {
  CLI::App app(
      "cscd: continuous self-collision detection of animated triangle meshes.\n\n"
      "  cscd list                            what there is\n"
      "  cscd query rope                      where and when does it touch itself?\n"
      "  cscd view rope                       a page that shows it\n"
      "  cscd run --scene rope --json r.json  verify, then time, every strategy\n"
      "  cscd tables r.json --out .           the paper's tables, published beside measured\n"
      "  cscd compare before after            faster or slower, truer or less true?\n"
      "  cscd help query                      what a command does and takes\n\n"
      "Exit status: 0 done; 1 a verification failed, or compare found something worse; 2 bad usage or bad "
      "input; 3 query\n--fail-on-contact or --fail-deeper-than found what it fails on.",
      "cscd");
  app.formatter(std::make_shared<cscd::bench::HelpFormat>());  // commands that are added have it, too
  app.require_subcommand(1);
  app.set_version_flag("--version", cscd::bench::version_text,
                       "show the version, the build and the libraries");
  cscd::bench::add_list(app);
  cscd::bench::add_query(app);
  cscd::bench::add_view(app);
  cscd::bench::add_inspect(app);
  cscd::bench::add_elementary(app);
  cscd::bench::add_export(app);
  cscd::bench::add_clusters(app);
  cscd::bench::add_verify(app);
  cscd::bench::add_hardcases(app);
  cscd::bench::add_benchmark(app);
  cscd::bench::add_accuracy(app);
  cscd::bench::add_scale(app);
  cscd::bench::add_run(app);
  cscd::bench::add_tables(app);
  cscd::bench::add_report(app);
  cscd::bench::add_compare(app);
  cscd::bench::add_history(app);
  cscd::bench::add_scene(app);
  cscd::bench::add_help(app);
  cscd::bench::add_completion(app);
  cscd::bench::add_manual(app);
  cscd::bench::require_plain_numbers(app);

  try {
    run_for_this_machine(argv);
    cscd::bench::require_text(argc, argv);
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    return complain(cscd::bench::usage_error(app, error));
  } catch (const cscd::bench::ExitStatus& status) {
    return static_cast<int>(status);
  } catch (const cscd::bench::NobodyReads&) {
    cscd::bench::end_by_broken_pipe();
  } catch (const cscd::InputError& error) {
    return complain(error.what());
  } catch (const cscd::MemoryShortage& shortage) {
    return complain(std::string(shortage.finding()) + "; give a smaller --thickness or a smaller input");
  } catch (const std::bad_alloc&) {
    return complain(
        "out of memory; use a smaller input, a larger --memory for a model file, or a machine with more");
  } catch (const std::exception& error) {
    return complain(std::string("unexpected: ") + error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  cscd::bench::prepare_standard_streams();
  cscd::remove_temporaries_at_signals();
  return cscd::bench::finish_standard_output(run(argc, argv));
}
