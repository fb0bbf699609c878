#include "bench/answer/options/model_options.h"

#include <CLI/App.hpp>

namespace cscd::bench {

void add_model_options(CLI::App& command, ModelOptions& options) {
  CLI::OptionDefaults& defaults = *command.option_defaults();
  const std::string group_of_others = defaults.get_group();
  defaults.group("Model files");
  scenes::ImportOptions& import = options.import;
  command.add_option("--clip", import.clip,
                     "the clip, by name or by number from 0, or all (query and view); default all for query, "
                     "and else the "
                     "first\nthat moves the surface");
  command.add_option("--fps", import.fps,
                     "frames a second; default the file's own rate, or 30 where the file does not say");
  command.add_flag("--from-bind-pose", import.from_bind_pose,
                   "begin half a second earlier, in the bind pose");
  command
      .add_option(
          "--component", import.component,
          "all, largest, a number (see inspect), or auto: the largest that is closed and oriented, else the\n"
          "largest")
      ->capture_default_str();
  command.add_option("--fill-holes", import.fill_holes, "fill holes of up to so many edges")
      ->check(CLI::Range(0, 10'000))
      ->capture_default_str();
  command.add_flag("--flip-inward", import.flip_inward, "turn closed components that face inward");
  command.add_option(
      "--weld", import.weld,
      "vertices nearer than this share of the diagonal are one; default 1e-6, or less where detail "
      "would collapse");
  command.add_option("--import-memory", options.memory_mib, "MiB that reading the file may take")
      ->check(CLI::Range(16, 1 << 20))
      ->capture_default_str();
  command.add_option("--memory", options.answer_memory_mib, "MiB that everything after that may take")
      ->check(CLI::Range(64, 1 << 24))
      ->capture_default_str();
  command.add_option("--import-seconds", options.seconds, "seconds that reading the file may take")
      ->check(CLI::Range(0.01, 86400.0))
      ->capture_default_str();
  defaults.group(group_of_others);
}

void add_threads_option(CLI::App& command, int& threads) {
  command
      .add_option("--threads", threads,
                  "threads that answer an interval together, where the strategy can share its work\n"
                  "(drvbc_fast, drvbc_fast_all, drvbc_fast_complete); the others run on one. Answers are\n"
                  "the same on any number")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
}

}  // namespace cscd::bench
